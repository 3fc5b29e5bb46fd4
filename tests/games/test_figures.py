"""Test figures of duels, plans and comparisons by their axes."""

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from math import cos, pi, sin
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from stepaside.core.poses import Array
from stepaside.games.duel_circle import circle_of_theory
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.duel_summary import TheorySummary
from stepaside.games.run import DuelRun
from stepaside.games.trajectory import Trajectory
from stepaside.report import compare_figure, duel_figure
from stepaside.report.cycle_means import whole_cycles
from stepaside.report.figure_style import COLOURS, plt
from synthetic_run import run_of

TIMES = np.linspace(0.0, 18.0, 901)
SETTINGS = DuelSettings(seed=7)
FIELDS = ("com", "torso", "com_reference", "zmp_reference", "zmp")
CYCLE = 2.0 * SETTINGS.gait.step_duration


@cache
def record() -> dict[str, Trajectory]:
    """Return robots that walk one behind the other, with some sway."""
    sway = 0.02 * np.sin(2.0 * pi * TIMES / CYCLE)
    tracks = {}
    for name, ahead, heading in (("pursuer", 0.0, 0.4), ("evader", 1.0, 1.4)):
        c, s = cos(heading), sin(heading)
        x, y = ahead + 0.1 * TIMES - s * sway, 0.2 * ahead + c * sway
        turn = np.full_like(TIMES, heading)
        tracks[name] = Trajectory(
            com=np.column_stack([x + 0.01, y, 0.27 + 0 * x]),
            torso=np.column_stack([x, y, turn]),
            com_reference=np.column_stack([x - 3.0, y + 1.0]),
            zmp_reference=np.column_stack([x - 3.0, y + 1.0]),
            zmp=np.column_stack([x, y]),
            landings=np.array(
                [
                    [1.0, 1.0, ahead, 0.05, 0.2],
                    [1.5, -1.0, ahead, -0.05, 0.0],
                ]
            ),
        )
    return tracks


@pytest.fixture
def kept(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> Iterator[list[Figure]]:
    """Collect figures instead of writing files."""
    figures: list[Figure] = []
    monkeypatch.chdir(tmp_path)

    def save(figure: Figure, file: Any, *, format: str, metadata: Any) -> None:
        assert (format, metadata) == ("png", None)
        figures.append(figure)

    closed: list[Figure] = []
    monkeypatch.setattr(Figure, "savefig", save)
    real = plt.close
    monkeypatch.setattr(plt, "close", closed.append)
    yield figures
    assert [file.name for file in tmp_path.iterdir()] == ["figure.png"]
    assert closed == figures
    for figure in figures:
        real(figure)


def line(axes: Any, label: str) -> Array:
    """Return the points of the line with a label. Shape (n, 2)."""
    (found,) = [one for one in axes.lines if one.get_label() == label]
    return points_of(found)


def points_of(drawn: Any) -> Array:
    """Return the points of a line. Shape (n, 2)."""
    points: Array = np.column_stack(drawn.get_data())
    return points


def levels(axes: Any) -> dict[float, str]:
    """Return the heights of horizontal lines."""
    return {
        float(one.get_ydata()[0]): to_hex(one.get_color())
        for one in axes.lines
        if len(one.get_ydata()) == 2
    }


THEORY_OF_IT = TheorySummary(None, True, 0.64, 0.9, 90.0)


def duel(kept: list[Figure], **theory: Any) -> Figure:
    told = replace(THEORY_OF_IT, **theory)
    made = run_of(TIMES, record(), settings=SETTINGS, theory=told)
    duel_figure.draw_duel(made, Path("figure.png"))
    return kept[-1]


def test_every_line_over_time_has_a_name(kept: list[Figure]) -> None:
    figure = duel(kept)
    legend = figure.axes[5].get_legend()
    assert legend is not None
    names = [text.get_text() for text in legend.get_texts()]
    assert names == ["every sample", "mean over a gait cycle"]


def test_a_duel_that_ended_at_once_is_drawn(
    kept: list[Figure],
) -> None:
    """Interrupted before the first tick: one sample, no footstep."""
    first = {
        name: Trajectory(
            **{field: getattr(track, field)[:1] for field in FIELDS},
            **{"landings": np.zeros((0, 5))},
        )
        for name, track in record().items()
    }
    made = run_of(TIMES[:1], first, settings=SETTINGS, theory=THEORY_OF_IT)
    duel_figure.draw_duel(made, Path("figure.png"))
    axes = kept[0].axes
    assert [one.get_title() for one in axes[:4]] == 4 * ["0.0 s"]
    assert len(line(axes[4], "evader, CoM")) == 1
    assert points_of(axes[5].lines[0]).tolist() == [
        [0.0, pytest.approx(made.distance[0])]
    ]


def run(name: str, settings: DuelSettings = SETTINGS) -> DuelRun:
    return run_of(TIMES, record(), settings=settings, name=name)


def test_a_comparison_has_every_run_and_their_common_theory(
    kept: list[Figure],
) -> None:
    runs = [run(f"run {i}") for i in range(5)]
    compare_figure.draw_comparison(runs, Path("figure.png"))
    path, distance, angle = kept[-1].axes
    assert len(path.lines) == 10
    for number, drawn in enumerate(path.lines):
        name = ("pursuer", "evader")[number % 2]
        way = points_of(drawn)
        np.testing.assert_allclose(way, record()[name].torso[:, :2])
        assert to_hex(drawn.get_color()) == COLOURS[name]
        styles = compare_figure.LINES
        assert drawn.get_linestyle() == styles[number // 2 % 4]
    shades = [drawn.get_alpha() for drawn in path.lines[::2]]
    assert shades == [1.0] * 4 + [pytest.approx(1.0 - 0.6 / 5)]
    circle = circle_of_theory(SETTINGS)
    for axes, values, level in (
        (distance, runs[0].distance, circle.distance_m),
        (angle, runs[0].orientation, 90.0),
    ):
        for number, drawn in enumerate(axes.lines[:5]):
            assert drawn.get_label() == f"run {number}"
            smooth = whole_cycles(values, TIMES, CYCLE)
            np.testing.assert_allclose(
                points_of(drawn), np.column_stack([TIMES, smooth])
            )
            style = compare_figure.LINES[number % 4]
            assert drawn.get_linestyle() == style
            colour = compare_figure.RUNS[number % 4]
            assert to_hex(drawn.get_color()) == colour
        (height,) = levels(axes)
        assert height == pytest.approx(level)
    strategy = replace(SETTINGS.strategy, angle=0.0)
    back = run("back", replace(SETTINGS, strategy=strategy))
    compare_figure.draw_comparison([back], Path("figure.png"))
    assert levels(kept[-1].axes[1]) == {} == levels(kept[-1].axes[2])


def test_figures_are_drawn_without_a_screen() -> None:
    assert matplotlib.get_backend().lower() == "agg"
