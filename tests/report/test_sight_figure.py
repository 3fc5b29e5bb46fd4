"""The film strip of what robots saw, read back from its pixels and axes."""

from math import cos, radians, sin, tan
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from stepaside.core.poses import Array
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.run import DuelRun
from stepaside.games.sight_evaluation import EvaluatedImage
from stepaside.games.trajectory import Trajectory
from stepaside.perception.camera_model import CameraModel
from stepaside.perception.images import ColourImage, DepthImage
from stepaside.report.figure_style import COLOURS, THEORY, plt
from stepaside.report.sight_figure import FOUND, TRUE, draw_sight, picture
from stepaside.sim.camera_settings import RoomObject, SceneSettings
from synthetic_run import run_of

CAMERA = CameraModel(160, 120, 140.0, 140.0)


def colour(
    azimuth: float, box: Any = None, time: float = 0.0
) -> EvaluatedImage:
    pixels = np.full((120, 160, 3), 9, dtype=np.uint8)
    report: Any = SimpleNamespace(
        image=ColourImage(time, CAMERA, pixels), colour=box, depth=None
    )
    return EvaluatedImage(report, azimuth)


def marked(canvas: Any, shade: tuple[int, int, int]) -> Array:
    """Rows and columns of the pixels of a colour. Shape (n, 2)."""
    found = np.argwhere((canvas == shade).all(axis=2))
    return found.astype(np.float64)


@pytest.mark.parametrize("azimuth", [0.0, 0.3, -0.4])
def test_the_true_direction_is_a_tick_at_the_bottom(azimuth: float) -> None:
    tick = marked(picture(colour(azimuth)), TRUE)
    column = 80.0 - 140.0 * tan(azimuth)
    assert tick[:, 1].mean() == pytest.approx(column, abs=1.0)
    assert tick[:, 0].max() == 119 and 103 <= tick[:, 0].min() <= 106
    assert np.ptp(tick[:, 1]) <= 2


def test_what_is_behind_has_no_tick() -> None:
    for azimuth in (radians(81.0), radians(-100.0), 3.0):
        assert len(marked(picture(colour(azimuth)), TRUE)) == 0
    assert not np.any(picture(colour(radians(79.0))) != 9)  # out of view


def test_a_detection_is_a_box_with_its_axis() -> None:
    box = SimpleNamespace(left=30, right=90, top=20, bottom=80, column=50)
    still = colour(1.5, box)
    green = marked(picture(still), FOUND)
    np.testing.assert_allclose(green.min(axis=0), [20, 30], atol=1)
    np.testing.assert_allclose(green.max(axis=0), [80, 90], atol=1)
    inside = green[(green[:, 1] > 35) & (green[:, 1] < 85)]
    inside = inside[(inside[:, 0] > 25) & (inside[:, 0] < 75)]
    assert inside[:, 1].mean() == pytest.approx(50.0, abs=1.0)
    # The image itself stays as it was.
    image: Any = still.report.image
    assert (image.pixels == 9).all()


def depth(scene: Any, azimuth: float = 3.0) -> Any:
    return picture(depth_still(scene, azimuth))


def depth_still(
    scene: Any, azimuth: float = 3.0, time: float = 0.0
) -> EvaluatedImage:
    camera = CameraModel(80, 60, 70.0, 70.0)
    depths = np.zeros((60, 80), dtype=np.float32)
    depths[:, 20:40], depths[:, 40:60], depths[:, 60:] = 1.0, 2.0, 9.0
    report: Any = SimpleNamespace(
        image=DepthImage(time, camera, depths, 0.4, 4.0),
        colour=None,
        depth=scene,
    )
    return EvaluatedImage(report, azimuth)


def test_depth_is_brightness_three_times_as_large() -> None:
    canvas = depth(None)
    assert canvas.shape == (180, 240, 3)
    shades = canvas[90, [30, 90, 150, 210], 0].tolist()
    assert shades == [0, int(255 - 190 / 4), int(255 - 190 / 2), 65]
    assert (canvas[..., 0] == canvas[..., 2]).all()
    tick = marked(depth(None, 0.2), TRUE)
    column = 3.0 * (40.0 - 70.0 * tan(0.2))
    assert tick[:, 1].mean() == pytest.approx(column, abs=1.0)
    assert tick[:, 0].max() == 179


def test_obstacles_are_boxes_and_shadows_are_brackets() -> None:
    thing = SimpleNamespace(azimuth=0.2, width=0.3, nearest=1.5)
    scene = SimpleNamespace(obstacles=[thing], shadows=[])
    green = marked(depth(scene), FOUND)
    sides = [3.0 * (40.0 - 70.0 * tan(0.2 + s)) for s in (0.1, -0.1)]
    assert green[:, 1].min() == pytest.approx(sides[0], abs=3.0)
    assert green[:, 1].max() == pytest.approx(sides[1], abs=3.0)
    assert green[:, 0].min() == pytest.approx(4, abs=1)
    assert green[:, 0].max() == pytest.approx(175, abs=1)
    shadow = SimpleNamespace(azimuth=-0.1, width=0.4)
    scene = SimpleNamespace(obstacles=[], shadows=[shadow])
    green = marked(depth(scene), FOUND)
    sides = [3.0 * (40.0 - 70.0 * tan(-0.1 + s)) for s in (0.2, -0.2)]
    assert green[:, 1].min() == pytest.approx(sides[0], abs=3.0)
    assert green[:, 1].max() == pytest.approx(sides[1], abs=3.0)
    assert green[:, 0].min() == pytest.approx(8, abs=2)
    assert green[:, 0].max() == pytest.approx(26, abs=1)
    ends = green[green[:, 0] > 15]
    for side in sides:
        assert np.abs(ends[:, 1] - side).min() <= 2.0
    assert np.all(np.abs(ends[:, 1:] - sides).min(axis=1) <= 3.0)


TIMES: Array = 0.1 * np.arange(101, dtype=float)


SETTINGS = DuelSettings(
    seed=7, room=SceneSettings(things=[RoomObject("red box", 3.0, -1.0)])
)


def result(**changes: Any) -> DuelRun:
    """A duel with three_js moments of which pictures were kept."""
    tracks = {}
    for name, x, heading in (("pursuer", 0.0, 0.3), ("evader", 2.0, 2.0)):
        turn = np.full_like(TIMES, heading)
        belief = np.full_like(TIMES, 0.5)
        belief[TIMES < 2.0] = np.nan
        zero = 0.0 * TIMES
        tracks[name] = Trajectory(
            com=np.zeros((len(TIMES), 3)),
            torso=np.column_stack([x + 0.05 * TIMES, 0.1 * TIMES, turn]),
            sight=np.column_stack(
                [TIMES, belief, 1.5 + zero, belief - 6.2, 1.4 + zero, zero]
            ),
        )
    values: dict[str, Any] = {
        "tracks": tracks,
        "stills": {name: seen() for name in COLOURS},
        "settings": SETTINGS,
        "triggered_at_s": 4.0,
        **changes,
    }
    return run_of(TIMES, **values)


def seen(*, depths: int = 0) -> dict[str, list[EvaluatedImage]]:
    """Images of one robot, by camera."""
    deep = [depth_still(None, time=time) for time in (1.0, 5.0, 10.0)[:depths]]
    shown = [colour(0.1, time=time) for time in (1.0, 5.0, 10.0)]
    return {"colour": shown, "depth": deep}


@pytest.fixture
def kept(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[Figure]:
    monkeypatch.chdir(tmp_path)
    figures: list[Figure] = []
    monkeypatch.setattr(
        Figure, "savefig", lambda f, *_, **__: figures.append(f)
    )
    monkeypatch.setattr(plt, "close", lambda figure: None)
    return figures


def test_a_film_strip_has_its_pictures_top_views_and_errors(
    kept: list[Figure],
) -> None:
    draw_sight(result(), Path("sight.png"))
    figure: Any = kept[0]
    assert len(kept) == 1
    assert "seed 7" in figure.get_suptitle()
    shown = [axes for axes in figure.axes if axes.images]
    assert len(shown) == 6
    assert [a.get_title() for a in shown[:3]] == ["1.0 s", "5.0 s", "10.0 s"]
    labels = [axes.get_ylabel() for axes in shown]
    assert labels == ["pursuer's camera", "", "", "evader's camera", "", ""]
    tops = figure.axes[6:9]
    tracks = result().tracks
    for axes, time, index in zip(
        tops, (1.0, 5.0, 10.0), (10, 50, 100), strict=True
    ):
        ways = [line for line in axes.lines if len(line.get_xdata()) > 2]
        for way, name in zip(ways, COLOURS, strict=True):
            torso = tracks[name].torso[: index + 1]
            np.testing.assert_allclose(way.get_data(), torso[:, :2].T)
        beliefs = [line for line in axes.lines if line.get_linestyle() == "--"]
        assert len(beliefs) == (0 if time < 2.0 else 2)
        for line, name in zip(beliefs, COLOURS, strict=False):
            x, y, heading = tracks[name].torso[index]
            angle = heading + 0.5
            np.testing.assert_allclose(
                line.get_data(),
                [[x, x + 1.5 * cos(angle)], [y, y + 1.5 * sin(angle)]],
            )
            assert to_hex(line.get_color()) == COLOURS[name]
        things = [line for line in axes.lines if line.get_marker() == "s"]
        assert [tuple(np.ravel(t.get_data())) for t in things] == [(3.0, -1.0)]
        np.testing.assert_allclose(axes.get_xlim(), (-0.3, 2.8))
        np.testing.assert_allclose(axes.get_ylim(), (-0.3, 1.3))
        assert len(axes.patches) == 2
    plt.close(figure)


def test_errors_are_wrapped_and_beside_the_trigger(
    kept: list[Figure],
) -> None:
    draw_sight(result(), Path("sight.png"))
    axes_of: Any = kept[0].axes
    upper, lower = axes_of[-2:]
    off = np.degrees(6.2 - 2.0 * np.pi)
    for name in COLOURS:
        (line,) = [one for one in upper.lines if one.get_label() == name]
        np.testing.assert_allclose(line.get_xdata(), TIMES)
        np.testing.assert_allclose(line.get_ydata()[20:], off)
        (line,) = [one for one in lower.lines if one.get_label() == name]
        np.testing.assert_allclose(line.get_ydata(), 0.1)
    trigger = [one for one in upper.lines if one.get_linestyle() == ":"]
    assert [one.get_xdata()[0] for one in trigger] == [4.0]
    for axes, limit in ((upper, 8.0), (lower, 0.2)):
        assert axes.get_ylim() == (-limit, limit)
        zeros: Any = [
            one for one in axes.lines if to_hex(one.get_color()) == THEORY
        ]
        assert zeros[0].get_ydata()[0] == 0.0
    assert lower.get_xlabel() == "time [s]"
    draw_sight(result(triggered_at_s=None), Path("sight.png"))
    upper = kept[1].axes[-2]
    assert not [one for one in upper.lines if one.get_linestyle() == ":"]


def test_a_duel_without_pictures_still_has_its_errors(
    kept: list[Figure],
) -> None:
    empty: dict[str, Any] = {
        name: {"colour": [], "depth": []} for name in COLOURS
    }
    draw_sight(result(stills=empty), Path("sight.png"))
    assert len(kept[0].axes) == 2


def test_of_a_duel_with_a_person_the_robots_sight_is_shown(
    kept: list[Figure],
) -> None:
    """Both are seen from above, but only the robot believes something."""
    both = result().tracks
    person = Trajectory(both["pursuer"].com, both["pursuer"].torso)
    duel = result(
        tracks={**both, "pursuer": person}, stills={"evader": seen(depths=2)}
    )
    draw_sight(duel, Path("sight.png"))
    figure: Any = kept[0]
    shown = [axes for axes in figure.axes if axes.images]
    assert [axes.get_ylabel() for axes in shown] == [
        *("evader's camera", "", "", "evader's depth", "")
    ]
    assert [a.get_title() for a in shown[:3]] == ["1.0 s", "5.0 s", "10.0 s"]
    tops = figure.axes[5:8]
    for axes, index in zip(tops, (10, 50, 100), strict=True):
        ways = [line for line in axes.lines if len(line.get_xdata()) > 2]
        for way, name in zip(ways, COLOURS, strict=True):
            torso = both[name].torso[: index + 1]
            np.testing.assert_allclose(way.get_data(), torso[:, :2].T)
        beliefs = [line for line in axes.lines if line.get_linestyle() == "--"]
        colours = [to_hex(line.get_color()) for line in beliefs]
        assert colours == ([] if index == 10 else [COLOURS["evader"]])
    for axes in figure.axes[-2:]:
        labels = {line.get_label() for line in axes.lines}
        assert "evader" in labels and "pursuer" not in labels
