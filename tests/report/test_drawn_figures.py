"""Every figure names its axes with units, and its curves in a legend."""

import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pytest
from click.testing import CliRunner
from matplotlib.figure import Figure

from stepaside import load_run
from stepaside.cli.main import main
from stepaside.report.figure_style import plt

EXAMPLES = Path(__file__).parents[2] / "examples"
COMMANDS = {
    "duel": "duel --duration 3",
    "duel in a room": "duel --room 3 --duration 1",
    "duel with cameras": "duel --sensing cameras --duration 0.4",
    "duel with a person": "duel --pursuer person --duration 2",
    "walk": "run walk --duration 3 --push 0.5@1:90deg",
    "game": f"run {EXAMPLES}/two-pursuers.toml --duration 1",
    "plan": "theory plan --role evader --bearing 40deg",
    "unicycles": "run unicycles --speed 0.1 --gain 0.2",
    "circle": "theory circle --starts 0",
    "map": "theory map --grid 3 --set distances=2 --set duration=5",
    "bound": "theory bound --grid 16 --games 0 --set horizon=0.1",
    "chauffeur": "theory bound --against person --evader-speed 0.6 --grid 16",
    "room": "run room --discs 2 --doors 1",
    "study": "study tournament --set seed=0:2 --set game.duration=1 "
    "--set evader=evasion,optimal --workers 1",
}

pytestmark = pytest.mark.usefixtures("inline_workers")


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Figure]]:
    """Figures that were written, still open."""
    figures: list[Figure] = []

    def save(figure: Figure, file: Any, **_: Any) -> None:
        figure.canvas.draw()
        figures.append(figure)
        file.write(b"\x89PNG" + bytes(10_000) + b"IEND....")

    close = plt.close
    with monkeypatch.context() as patch:
        patch.setattr(Figure, "savefig", save)
        patch.setattr(plt, "close", lambda _: None)
        yield figures
    for figure in figures:
        close(figure)


def draw(words: str, file: Path) -> None:
    """Run a command that writes a figure; a warning is an error."""
    option = ["--figure"]
    if words.startswith(("duel", "run walk", f"run {EXAMPLES}")):
        option, file = ["--output"], file.with_suffix("")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        result = CliRunner().invoke(main, [*words.split(), *option, str(file)])
    assert result.exit_code == 0, result.output


def named(figure: Figure) -> str:
    """All that legends, titles and labels of a figure say."""
    legends = [*figure.legends, *(axes.get_legend() for axes in figure.axes)]
    texts = [t for each in legends if each for t in each.get_texts()]
    texts += [t for axes in figure.axes for t in axes.texts]
    return "; ".join(text.get_text() for text in texts)


@pytest.mark.parametrize("name", COMMANDS)
def test_a_figure_has_units_and_names(
    name: str, drawn: list[Figure], tmp_path: Path
) -> None:
    draw(COMMANDS[name], tmp_path / "a.png")
    assert drawn
    for figure in drawn:
        check(figure)


def check(figure: Figure) -> None:
    """Check that axes have units, and curves names."""
    told = named(figure)
    panels = [axes for axes in figure.axes if axes.has_data()]
    assert panels
    for axes in panels:
        labels = axes.get_xlabel(), axes.get_ylabel()
        shared = [x for x in figure.axes if x.get_xlabel() or x.get_ylabel()]
        assert any(labels) or shared or axes.get_title()
        for curve in axes.lines:
            label = str(curve.get_label())
            assert label.startswith("_") or label in told, label
    text = "; ".join(
        part
        for axes in figure.axes
        for part in (axes.get_xlabel(), axes.get_ylabel(), axes.get_title())
    )
    assert "[" in text or "%" in text, text


def test_a_duel_s_figure_shows_its_distance_beside_theory(
    drawn: list[Figure], tmp_path: Path
) -> None:
    folder = tmp_path / "run"
    draw("duel --duration 3", folder)
    run, axes = load_run(folder, "duel"), drawn[-1].axes
    (panel,) = [each for each in axes if each.get_ylabel() == "distance [m]"]
    curves = [np.column_stack(line.get_data()) for line in panel.lines]
    found = next(c for c in curves if len(c) == len(run.times))
    np.testing.assert_allclose(found[:, 1], run.distance)
    assert run.theory is not None
    levels = [c[0, 1] for c in curves if len(c) == 2]
    assert run.theory[1] in levels


def test_figures_are_drawn_without_a_screen() -> None:
    assert matplotlib.get_backend().lower() == "agg"
