"""Test how documents are made, on small ones."""

from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from stepaside.studies.result_files import header, write_result
from tools.documents.__main__ import old_results
from tools.documents.blocks import with_tables
from tools.documents.document import complaints, remade
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


def test_what_is_not_marked_stays(store: Store) -> None:
    text = "A <!-- note --> 0.5 of 3\n\n| 1 |\n|---|\n"
    assert remade(text, store) == text


def test_remaking_twice_changes_nothing_more(store: Store) -> None:
    text = "1.0<!--= run:ratio-->\n<!-- made: run.printed -->\nold\n"
    once = remade(f"{text}<!-- /made -->\n", store)
    assert "```\na  1\n```" in once and "old" not in once
    assert remade(once, store) == once


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        ("0.98<!--= run:ratio-->", "2: wanted '0.99', got '0.98' (run:ratio)"),
        ("1<!--= run:raito-->", "2: run:raito: no 'raito' among command"),
        ("1<!--= run:list.2-->", "2: run:list.2: no '2' among 2 entries"),
        ("1<!--= run:word-->", "2: run:word is no number, got 'none'"),
        ("1<!--= run:truth-->", "2: run:truth is no number, got True"),
        ("1<!--= other:ratio-->", "2: no result other.json"),
        ("one<!--= run:ratio-->", "2: a mark must follow a number"),
        ("1<!--= run:ratio +-->", "2: a mark must read <!--= name:path"),
        (
            "<!-- made: run.nothing -->\n<!-- /made -->",
            "3: no table 'nothing'",
        ),
        ("<!-- made: run.rooms -->\n<!-- /made -->", "3: run does not hold"),
        ("<!-- made: run.printed -->\n", "2: a block must read"),
        ("<!-- /made -->", "2: a block must read"),
        (
            "<!-- made: run.printed -->\n\n```\na  2\n```\n\n<!-- /made -->",
            "5: wanted 'a  1', got 'a  2' (run.printed)",
        ),
    ],
)
def test_a_complaint_names_line_wanted_and_got(
    store: Store, tmp_path: Path, line: str, complaint: str
) -> None:
    file = tmp_path / "page.md"
    file.write_text(f"# Page\n{line}\n", encoding="utf-8")
    found = complaints(file, store)
    assert len(found) == 1
    assert found[0].startswith(f"page.md:{complaint}")


def test_a_page_that_is_right_has_no_complaints(
    store: Store, tmp_path: Path
) -> None:
    file = tmp_path / "page.md"
    file.write_text("0.99<!--= run:ratio-->\n", encoding="utf-8")
    assert complaints(file, store) == []


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


def test_results_of_another_version_are_told_with_what_renews_them(
    tmp_path: Path,
) -> None:
    now = header({}, command="make now")
    old = now | {"results": "old", "command": "make old"}
    write_result(tmp_path / "now.json", now)
    write_result(tmp_path / "old.json", old)
    assert old_results(Store(tmp_path)) == [
        "old: made with another version; again by: make old"
    ]
