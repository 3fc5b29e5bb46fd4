"""Test how documents are made, on small ones."""

from pathlib import Path
from typing import Any

import pytest
from PIL import Image
from result_files import header, write_result

from tools.documents.blocks import with_tables
from tools.documents.document import remade
from tools.documents.pictures import (
    PICTURES,
    Picture,
    draw_picture,
    drawn_from,
)
from tools.documents.store import ROOT, Store

FOUND: dict[str, Any] = {
    "ratio": 0.98765,
    "loss": -0.00456,
    "starts": 4000,
    "falls": 0,
    "by": {"0": {"falls": 9}, "0.8": {"falls": 2}},
    "list": [1.5, 2.5],
    "word": "none",
    "truth": True,
    "printed": "a  1\n",
}


@pytest.fixture
def store(tmp_path: Path) -> Store:
    write_result(tmp_path / "run.json", header({}, command="none"), **FOUND)
    return Store(tmp_path)


@pytest.mark.parametrize(
    ("old", "mark", "new"),
    [
        ("0.500", "ratio", "0.988"),
        ("1", "ratio * 100", "99"),
        ("1.0", "list.1 / 2", "1.2"),
        ("9,999", "starts", "4,000"),
        ("-1.0", "loss * 1000", "-4.6"),
        ("−1.0", "loss * 1000", "−4.6"),
        ("+1.00", "ratio", "+0.99"),
        ("no", "falls", "no"),
        ("No", "by.0.8.falls", "2"),
        ("3", "falls", "0"),
    ],
)
def test_a_marked_number_becomes_that_of_the_result(
    store: Store, old: str, mark: str, new: str
) -> None:
    text = f"| It is {old}<!--= run:{mark}--> m |"
    assert remade(text, store) == f"| It is {new}<!--= run:{mark}--> m |"


def test_a_picture_is_drawn_again_only_when_results_change(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def draw(_: Store, file: Path) -> None:
        Image.new("RGB", (2, 2)).save(file, format="PNG")

    name, head = "walk.png", header({}, command="none")
    monkeypatch.setitem(PICTURES, name, Picture(("walk",), draw))
    write_result(tmp_path / "walk.json", head, rows=[1.0])
    assert draw_picture(name, Store(tmp_path), tmp_path)
    assert not draw_picture(name, Store(tmp_path), tmp_path)
    assert drawn_from(tmp_path / name).startswith("walk.json ")
    write_result(tmp_path / "walk.json", head, rows=[1.5])
    store = Store(tmp_path)
    assert drawn_from(tmp_path / name) != PICTURES[name].source(store)
    assert draw_picture(name, store, tmp_path)
    assert drawn_from(tmp_path / name) == PICTURES[name].source(store)
    assert sorted(f.suffix for f in tmp_path.iterdir()) == [".json", ".png"]


def test_tables_of_settings_are_made_when_the_site_is_built(
    store: Store,
) -> None:
    page = (ROOT / "docs" / "settings.md").read_text(encoding="utf-8")
    shown = with_tables(page, store)
    assert "| `gait.stride` |  | Step size along the path [m] |" in shown
    assert "| `seed` | `--seed` |" in shown and "built:" not in shown
