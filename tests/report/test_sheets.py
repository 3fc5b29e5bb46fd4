"""Figures on sheets: sizes, fonts and kinds of files."""

import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from matplotlib import rcParams
from PIL import Image

from stepaside.cli.main import main
from stepaside.core.errors import ConfigurationError
from stepaside.planning import Direction, Foot, GaitSettings, ManeuverPlanner
from stepaside.report.figure_sizes import SHEETS, figures_on, sheet
from stepaside.report.plan_figure import draw_plan

PLAN = ManeuverPlanner(GaitSettings()).plan(
    0.5, Direction.BACKWARD, first_foot=Foot.LEFT, standing=True
)


@pytest.mark.parametrize("name", ["page", "column"])
def test_a_sheet_has_the_width_that_a_paper_asks_for(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(rcParams, "savefig.dpi", 150)
    file = tmp_path / "plan.png"
    with figures_on(name) as chosen:
        draw_plan(PLAN, "evader", file)
    assert chosen.width is not None
    with Image.open(file) as picture:
        dots = np.array(picture.info["dpi"])
        assert picture.width / dots[0] == pytest.approx(chosen.width, abs=0.02)
    assert sheet() is SHEETS["screen"]


def test_a_sheet_that_does_not_exist_is_refused() -> None:
    with pytest.raises(ConfigurationError, match="figure width .*'wide'"):
        with figures_on("wide"):
            pass


@pytest.mark.parametrize("kind", ["svg", "PDF"])
def test_a_figure_of_lines_is_the_same_file_each_time(
    kind: str, tmp_path: Path
) -> None:
    files = [tmp_path / f"{name}.{kind}" for name in ("one", "two")]
    for file in files:
        draw_plan(PLAN, "evader", file)
    first, second = (file.read_bytes() for file in files)
    assert first == second
    assert first[:4] == (b"<?xm" if kind == "svg" else b"%PDF")


def test_words_of_a_figure_of_lines_stay_words(tmp_path: Path) -> None:
    file = tmp_path / "plan.svg"
    draw_plan(PLAN, "evader", file)
    words = re.findall(r"<text[^>]*>([^<]+)</text>", file.read_text())
    assert "time [s]" in words and "ZMP" in words


def test_a_command_draws_on_the_sheet_that_is_asked_for(
    tmp_path: Path,
) -> None:
    file = tmp_path / "plan.png"
    arguments = ["plan", "--role", "evader", "--bearing", "40deg"]
    asked = [*arguments, "--figure", str(file), "--figure-width", "column"]
    assert CliRunner().invoke(main, asked).exit_code == 0
    with Image.open(file) as picture:
        assert picture.width == pytest.approx(3.5 * 30, abs=2)
    assert sheet() is SHEETS["screen"]
