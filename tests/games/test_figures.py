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
from matplotlib.text import Annotation

from stepaside.arena import BODY_RADIUS, Disc, MovingBox, Room
from stepaside.core.poses import Array
from stepaside.games.duel_circle import circle_of_theory
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.duel_summary import TheorySummary
from stepaside.games.run import DuelRun
from stepaside.games.trajectory import Trajectory
from stepaside.planning import (
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlanner,
    SoleRectangle,
)
from stepaside.planning.support_polygon import sole_corners
from stepaside.report import compare_figure, duel_figure, plan_figure
from stepaside.report.cycle_means import whole_cycles
from stepaside.report.figure_style import COLOURS, EVADER, PURSUER, THEORY, plt
from stepaside.report.sole_outlines import draw_heading, draw_soles
from stepaside.sim.camera_settings import SceneSettings
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


def corners_of(patch: Any) -> Array:
    """Return the corners of a polygon. Shape (n, 2)."""
    corners: Array = np.asarray(patch.get_path().vertices)[:4]
    return corners


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


def test_a_duel_is_shown_at_four_times_with_the_paths_so_far(
    kept: list[Figure],
) -> None:
    figure = duel(kept)
    assert "seed 7: played 18.00 s" in figure.get_suptitle()
    for axes, time in zip(figure.axes[:4], (0.0, 2.0, 8.0, 18.0), strict=True):
        assert axes.get_title() == f"{time:.1f} s"
        count = round(50 * time) + 1
        for drawn, name in zip(axes.lines, COLOURS, strict=True):
            way = points_of(drawn)
            np.testing.assert_allclose(way, record()[name].com[:count, :2])
            assert to_hex(drawn.get_color()) == COLOURS[name]
        for wedge, name in zip(axes.patches, COLOURS, strict=True):
            place = record()[name].torso[count - 1, :2]
            off = np.hypot(*(corners_of(wedge) - place).T)
            assert off.max() < 0.2
        every = np.concatenate(
            [track.com[:, :2] for track in record().values()]
        )
        for axis, limits in enumerate((axes.get_xlim(), axes.get_ylim())):
            low, high = every[:, axis].min(), every[:, axis].max()
            np.testing.assert_allclose(np.mean(limits), 0.5 * (low + high))
            assert limits[0] <= low - 0.199 and limits[1] >= high + 0.199
            sides = np.ptp(every, axis=0) + 0.4
            side = max(sides[axis], 0.5 * sides.max())
            assert np.ptp(limits) == pytest.approx(side)
    assert [bool(axes.get_ylabel()) for axes in figure.axes[:4]] == [
        *(True, False, False, False)
    ]


def test_no_side_of_a_snapshot_is_less_than_half_the_other(
    kept: list[Figure],
) -> None:
    far = dict(record())
    com = far["evader"].com * [30.0, 1.0, 1.0]
    far["evader"] = replace(far["evader"], com=com)
    made = run_of(TIMES, far, settings=SETTINGS, theory=THEORY_OF_IT)
    duel_figure.draw_duel(made, Path("figure.png"))
    axes = kept[-1].axes[0]
    x, y = np.ptp(axes.get_xlim()), np.ptp(axes.get_ylim())
    assert x > 40.0 and y == pytest.approx(0.5 * x)


def test_paths_have_their_starts_ends_and_footsteps(
    kept: list[Figure],
) -> None:
    axes = duel(kept).axes[4]
    for name in COLOURS:
        com = record()[name].com
        np.testing.assert_allclose(line(axes, f"{name}, CoM"), com[:, :2])
        starts = [
            points_of(one)[0] for one in axes.lines if one.get_marker() == "o"
        ]
        assert any(np.allclose(one, com[0, :2]) for one in starts)
    # Two soles and a wedge for each.
    assert len(axes.patches) == 6
    wedge = corners_of(axes.patches[2])
    end = record()["pursuer"].torso[-1, :2]
    assert np.hypot(*(wedge - end).T).max() < 0.2


def test_distance_and_angle_are_drawn_with_theory(
    kept: list[Figure],
) -> None:
    figure = duel(kept)
    distance, angle = figure.axes[5:7]
    tracks = record()
    apart = tracks["evader"].torso - tracks["pursuer"].torso
    raw = np.hypot(apart[:, 0], apart[:, 1])
    for axes, values in (
        (distance, raw),
        (angle, np.full(len(TIMES), 180.0 / pi)),
    ):
        plain, mean = axes.lines[:2]
        np.testing.assert_allclose(
            points_of(plain), np.column_stack([TIMES, values])
        )
        smooth = whole_cycles(values, TIMES, CYCLE)
        np.testing.assert_allclose(
            points_of(mean), np.column_stack([TIMES, smooth])
        )
    assert levels(distance) == {0.9: THEORY, 0.8: EVADER}
    assert levels(angle) == {90.0: THEORY}
    for text, name in zip(
        distance.texts, ("theory 0.9 m", "safety radius\n0.8 m"), strict=True
    ):
        assert text.get_text() == name
        # To the right of the axes, where no curve is.
        assert isinstance(text, Annotation)
        assert text.xy[0] == 1.0 and text.get_position()[0] > 0.0
    assert distance.get_ylabel() == "distance [m]"
    assert angle.get_ylabel() == "angle [deg]"
    assert (distance.get_xlabel(), angle.get_xlabel()) == ("", "time [s]")
    none = duel(kept, distance_m=None, relative_orientation_deg=None)
    assert levels(none.axes[5]) == {0.8: EVADER}
    assert levels(none.axes[6]) == {}


def test_balance_is_leftward_of_each_robot_over_six_steps(
    kept: list[Figure],
) -> None:
    """For any heading, the lateral sway is that of the record."""
    figure = duel(kept)
    begin = TIMES[-1] - 6.0 * SETTINGS.gait.step_duration
    shown = TIMES[begin <= TIMES]
    for axes, name, heading in zip(
        figure.axes[7:], COLOURS, (0.4, 1.4), strict=True
    ):
        assert axes.get_title() == f"{name}: lateral balance, last steps"
        # Along the way it drifts by what its heading is off the x axis.
        drift = -0.1 * sin(heading) * (shown - shown.mean())
        sway = 0.02 * np.sin(2.0 * pi * shown / CYCLE)
        expected = 1e3 * (drift + sway - sway.mean())
        for label in ("ZMP", "ZMP reference", "CoM reference", "CoM"):
            found = line(axes, label)
            np.testing.assert_allclose(found[:, 0], shown)
            shift = 1e3 * 0.01 * -sin(heading) if label == "ZMP" else 0.0
            np.testing.assert_allclose(
                found[:, 1], expected - shift, atol=1e-6
            )


MOVING = MovingBox(0.5, -3.0, 0.3, 0.3, to=(0.5, 3.0), speed=0.2)


@pytest.mark.parametrize("moving", [(), (MOVING,)])
def test_a_room_shows_clearance_instead_of_balance(
    kept: list[Figure], moving: tuple[MovingBox, ...]
) -> None:
    room = Room(20.0, 16.0, (Disc(2.0, 5.0, 0.5),), moving=moving)
    settings = replace(SETTINGS, room=SceneSettings(plan=room))
    made = run_of(TIMES, record(), settings=settings, theory=THEORY_OF_IT)
    duel_figure.draw_duel(made, Path("figure.png"))
    figure = kept[-1]
    assert len(figure.axes) == 8
    axes = figure.axes[-1]
    assert "nearest wall or obstacle" in axes.get_title()
    assert axes.get_ylabel() == "clearance [m]"
    for name in COLOURS:
        found = line(axes, name)
        places = record()[name].unicycle[:, :2]
        for time, value in found[:: len(found) // 9].tolist():
            place = places[int(np.argmin(np.abs(TIMES - time)))]
            near = [room.clearance([place])[0]]
            near += [b.at(time).clearance([place])[0] for b in moving]
            assert value == pytest.approx(float(min(near)))
    assert levels(axes) == {BODY_RADIUS: THEORY}


def test_every_line_over_time_has_a_name(kept: list[Figure]) -> None:
    figure = duel(kept)
    legend = figure.axes[5].get_legend()
    assert legend is not None
    names = [text.get_text() for text in legend.get_texts()]
    assert names == ["every sample", "mean over a gait cycle"]


def test_a_person_has_a_path_but_neither_footsteps_nor_balance(
    kept: list[Figure],
) -> None:
    """The panel of the robot fills the row."""
    walked = record()["pursuer"]
    tracks = record() | {"pursuer": Trajectory(walked.com, walked.torso)}
    made = run_of(TIMES, tracks, settings=SETTINGS, theory=THEORY_OF_IT)
    duel_figure.draw_duel(made, Path("figure.png"))
    both, figure = duel(kept), kept[0]
    assert (len(figure.axes), len(both.axes)) == (8, 9)
    balance = figure.axes[-1]
    assert balance.get_title().startswith("evader: ")
    assert len(balance.lines) == 4
    spans = [axes.get_subplotspec() for axes in (balance, both.axes[-1])]
    columns = [spec.get_gridspec().ncols for spec in spans if spec is not None]
    assert columns == [1, 2]
    for ours, theirs in zip(balance.lines, both.axes[-1].lines, strict=True):
        np.testing.assert_array_equal(points_of(ours), points_of(theirs))
    paths = figure.axes[4]
    np.testing.assert_allclose(line(paths, "pursuer, CoM"), walked.com[:, :2])
    # Two soles of the evader, and the wedges of both.
    assert len(paths.patches) == 4


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


@pytest.mark.parametrize("pose", [(1.0, 2.0, 0.5), (-1.0, 0.0, -2.0)])
def test_a_wedge_points_along_the_heading(
    pose: tuple[float, float, float],
) -> None:
    axes = Figure().add_subplot()
    draw_heading(axes, np.array(pose), PURSUER, 0.5)
    x, y, theta = pose
    (wedge,) = axes.patches
    tip, left, notch, right = corners_of(wedge)
    ahead, aside = (
        np.array([cos(theta), sin(theta)]),
        [-sin(theta), cos(theta)],
    )
    place = np.array([x, y])
    np.testing.assert_allclose(tip, place + 0.3 * ahead)
    np.testing.assert_allclose(notch, place - 0.1 * ahead)
    np.testing.assert_allclose((left - place) @ aside, 0.175)
    np.testing.assert_allclose((right - place) @ aside, -0.175)
    np.testing.assert_allclose((left - place) @ ahead, -0.2)
    np.testing.assert_allclose((right - place) @ ahead, -0.2)
    assert to_hex(wedge.get_facecolor()) == PURSUER


def test_soles_are_drawn_at_their_landings_with_their_side() -> None:
    axes = Figure().add_subplot()
    sole = SoleRectangle()
    rows = np.array([[0.0, 1.0, 0.3, 0.1, 0.4], [0.5, -1.0, 0.4, -0.1, 0.2]])
    draw_soles(axes, rows, sole, EVADER, alpha=0.5)
    for patch, row, foot in zip(axes.patches, rows, Foot, strict=True):
        corners = sole_corners(row[2:], foot, sole)
        np.testing.assert_allclose(corners_of(patch), corners)
        assert not patch.get_fill() and patch.get_alpha() == 0.5
        assert to_hex(patch.get_edgecolor()) == EVADER
    # A left sole reaches farther to the left, a right one to the right.
    left, right = (corners_of(p) for p in axes.patches)
    turn = np.array([-sin(0.4), cos(0.4)])
    assert ((left - [0.3, 0.1]) @ turn).max() == pytest.approx(0.042)
    turn = np.array([-sin(0.2), cos(0.2)])
    assert ((right - [0.4, -0.1]) @ turn).min() == pytest.approx(-0.042)


def test_a_plan_is_drawn_from_above_and_over_time(kept: list[Figure]) -> None:
    gait = GaitSettings()
    plan = ManeuverPlanner(gait).plan(
        0.5,
        Direction.BACKWARD,
        first_foot=Foot.RIGHT,
        standing=True,
        count=7,
    )
    plan_figure.draw_plan(plan, "evader", Path("figure.png"))
    above, x, y = kept[-1].axes
    degrees = np.degrees(plan.bearing)
    assert above.get_title() == f"evader: desired heading {degrees:.1f}°"
    samples = plan.sample(np.arange(0.0, plan.schedule.duration, 0.01))
    np.testing.assert_allclose(line(above, "CoM"), samples.com)
    np.testing.assert_allclose(line(above, "ZMP"), samples.zmp)
    for index, axes in enumerate((x, y)):
        for label, values in (
            ("ZMP", samples.zmp),
            ("DCM", samples.dcm),
            ("CoM", samples.com),
        ):
            np.testing.assert_allclose(
                line(axes, label),
                np.column_stack([samples.times, values[:, index]]),
            )
    assert [x.get_xlabel(), y.get_xlabel()] == ["", "time [s]"]
    assert (x.get_legend() is None, y.get_legend() is None) == (False, True)
    assert len(above.patches) == len(plan.placements)
    foot = plan.first_foot
    for number, patch in enumerate(above.patches):
        pose = plan.placements[number]
        corners = sole_corners(pose, foot, gait.sole)
        np.testing.assert_allclose(corners_of(patch), corners)
        colour = THEORY if number < 2 else EVADER
        assert to_hex(patch.get_edgecolor()) == colour
        foot = foot.other


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


def test_a_comparison_has_the_theory_of_every_run(
    kept: list[Figure],
) -> None:
    faster = replace(SETTINGS, gait=replace(SETTINGS.gait, speed=0.12))
    runs = [run("a"), run("b", faster), run("c")]
    compare_figure.draw_comparison(runs, Path("figure.png"))
    _, distance, angle = kept[-1].axes
    found = levels(distance)
    wanted = [circle_of_theory(each).distance_m for each in (SETTINGS, faster)]
    np.testing.assert_allclose(list(found), wanted, atol=1e-5)
    assert list(found.values()) == list(compare_figure.RUNS[:2])
    ((height, colour),) = levels(angle).items()
    assert height == pytest.approx(90.0) and colour == THEORY


@pytest.mark.parametrize("count", [1, 2, 20, 41, 300])
def test_a_mean_is_undistorted_at_its_ends(count: int) -> None:
    """On a slope the mean of whole cycles is the slope itself."""
    times: Array = 0.02 * np.arange(count, dtype=float)
    values: Array = 0.3 * times + 1.0
    mean = whole_cycles(values, times, 0.8)
    known = np.isfinite(mean)
    assert known.sum() == max(0, count - 40) * (count > 40)
    # An even number of samples lies half a sample to one side.
    np.testing.assert_allclose(mean[known], values[known], atol=0.0031)


def test_figures_are_drawn_without_a_screen() -> None:
    assert matplotlib.get_backend().lower() == "agg"
