"""What a new user tries first, in processes of their own."""

from pathlib import Path

import pytest
from PIL import Image

from flows.calls import stepaside


def test_version_is_printed() -> None:
    assert stepaside("--version", anew=True).out.split()[-1].count(".") == 2


def test_a_duel_is_played_and_drawn(tmp_path: Path) -> None:
    words = ("duel", "--duration", 1, "--output", "run", "--json")
    said = stepaside(*words, cwd=tmp_path, anew=True)
    assert said.json["duration_s"] == pytest.approx(1.0)
    assert said.json["outcome"] == "completed"
    with Image.open(tmp_path / "run" / "duel.png") as figure:
        assert figure.width == 1650  # 11 inches with 150 dots each
        assert len(figure.convert("RGB").getcolors(2**20) or ()) > 100
