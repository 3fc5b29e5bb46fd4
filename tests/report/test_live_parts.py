"""Parts of the live page: settings panel, cameras, history, session."""

from collections.abc import Iterator
from math import inf, pi, radians
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("viser", reason="viser is not installed")

from stepaside.arena import Room  # noqa: E402
from stepaside.core.errors import (  # noqa: E402
    ConfigurationError,
    StepAsideError,
)
from stepaside.core.poses import Array  # noqa: E402
from stepaside.games.game_settings import (  # noqa: E402
    GameSettings,
    StartSettings,
    duel,
)
from stepaside.games.player_settings import PlayerSettings  # noqa: E402
from stepaside.games.run_archive import load_run  # noqa: E402
from stepaside.perception.images import ColourImage  # noqa: E402
from stepaside.report.overlays import footsteps_in  # noqa: E402
from stepaside.report.scene import wall_corners  # noqa: E402
from stepaside.report.viewer.live_overlays import (  # noqa: E402
    live_overlays,
    places_of,
)
from stepaside.report.viewer.live_session import LiveSession  # noqa: E402
from stepaside.report.viewer.settings_panel import (  # noqa: E402
    leaves_of,
    with_values,
)
from stepaside.report.viewer.status_panel import (  # noqa: E402
    FOUND,
    camera_picture,
    page_text,
)
from stepaside.report.viewer.viewer_cameras import overview  # noqa: E402

FOV = 1.309  # [rad]
GAME = GameSettings(
    players=(
        PlayerSettings("ruby", role="pursuer", team="reds"),
        PlayerSettings("blue", role="evader", team="blues"),
    )
)


@pytest.mark.parametrize("settings", [duel(), GAME])
def test_controls_give_back_the_settings_that_they_show(
    settings: GameSettings,
) -> None:
    leaves = list(leaves_of(settings))
    assert len(leaves) > 80
    shown = {leaf.path: leaf.read(leaf.shown) for leaf in leaves}
    assert with_values(settings, shown) == settings


def test_a_value_is_set_by_its_path() -> None:
    changed = with_values(duel(), {"players.1.evasion.angle": 1.0, "seed": 9})
    assert changed.evader.evasion.angle == 1.0 and changed.seed == 9
    players = with_values(GAME, {"players.1.gait.stride": 0.02}).players
    assert players[1].gait.stride == 0.02
    assert players[0] == GAME.players[0]
    with pytest.raises(StepAsideError, match="stride"):
        with_values(duel(), {"players.0.gait.stride": -1.0})


def test_angles_are_shown_in_degrees_and_what_is_drawn_is_empty() -> None:
    leaves = {leaf.path: leaf for leaf in leaves_of(duel())}
    angle, distance = (
        leaves["players.1.evasion.angle"],
        leaves["start.distance"],
    )
    assert angle.shown == 90.0
    assert angle.read(70.0) == pytest.approx(radians(70.0))
    assert distance.shown == "" and distance.read("") is None
    assert distance.read("1.2") == 1.2
    with pytest.raises(ValueError, match="far"):
        distance.read("far")


def test_settings_without_effect_have_no_control() -> None:
    paths = {leaf.path for leaf in leaves_of(duel())}
    person = {
        leaf.path for leaf in leaves_of(duel(pursuer={"body": "person"}))
    }
    assert "players.0.person.speed" in person - paths
    # What is needed may stand in another section, or in the section itself.
    assert "players.1.evasion.safety_radius" in paths
    safe = with_values(GAME, {"players.1.shield.enabled": True})
    shields = {leaf.path for leaf in leaves_of(safe) if "shield" in leaf.path}
    assert "players.1.shield.speed" in shields
    assert "players.0.shield.speed" not in shields


def seen(eye: Array, target: Array, point: Array, aspect: float) -> Array:
    """Place of a point in an image, from -1 to 1, rightward and upward."""
    ahead = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(ahead, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    off = point - eye
    scale = float(off @ ahead) * np.tan(0.5 * FOV)
    up = np.cross(right, ahead)
    image: Array = np.array([off @ right / aspect, off @ up]) / scale
    return image


@pytest.mark.parametrize("apart", [0.3, 1.0, 12.0])
@pytest.mark.parametrize("bearing", [0.0, 1.0, -1.2])
@pytest.mark.parametrize("aspect", [0.46, 0.6, 1.3, 1.8])
@pytest.mark.parametrize("top", [False, True])
def test_both_robots_are_in_the_image_over_the_panel_of_a_phone(
    apart: float, bearing: float, aspect: float, top: bool
) -> None:
    """A panel covers the lower 45 % where the page is held upright."""
    way = apart * np.array([np.cos(bearing), np.sin(bearing)])
    places = [np.array([1.0, 2.0]), np.array([1.0, 2.0]) + way]
    walls = wall_corners(None)
    eye, target = overview(aspect, FOV, places, walls, top=top)
    for place in places:
        for height in (0.0, 0.6):
            point = np.array([*place, height])
            x, y = seen(eye, target, point, aspect)
            assert abs(x) < 1.0
            assert (-0.1 if aspect < 0.8 else -1.0) < y < 1.0


@pytest.mark.parametrize("shape", [(3.0, 3.0), (2.0, 9.0), (9.0, 2.0)])
@pytest.mark.parametrize("aspect", [0.46, 0.9, 1.8])
def test_all_of_a_room_is_seen_from_above(
    shape: tuple[float, float], aspect: float
) -> None:
    room = Room(width=shape[0], depth=shape[1])
    corners = wall_corners(room)
    places = [np.array([0.4, 0.3]), np.array([-0.2, 0.1])]
    eye, target = overview(aspect, FOV, places, corners, top=True)
    for corner in corners:
        x, y = seen(eye, target, np.array([*corner, 0.6]), aspect)
        assert abs(x) < 1.0
        assert (-0.1 if aspect < 0.8 else -1.0) < y < 1.0


@pytest.fixture
def session() -> Iterator[LiveSession]:
    start = StartSettings(1.0, 0.4, 0.0)
    made = LiveSession(duel(seed=3, start=start))
    made.speed = inf
    yield made
    made.close()


def passed(session: LiveSession, duration: float) -> None:
    """Let simulated time pass."""
    session.step(duration)
    session.call(lambda: None)


def test_a_saved_game_has_its_footsteps_where_the_page_drew_them(
    session: LiveSession, tmp_path: Path
) -> None:
    passed(session, 6.0)
    run = load_run(session.save(tmp_path))
    assert run.times[-1] == pytest.approx(6.0, abs=0.03)
    landed = footsteps_in(run, "pursuer")
    drawn = np.array(session.history.steps["pursuer"])[: len(landed)]
    assert len(landed) > 4
    np.testing.assert_array_equal(drawn[:, 0], landed[:, 1])
    away = np.hypot(*(drawn[:, 1:3] - landed[:, 2:4]).T)
    assert away.max() < 0.015


def test_the_circle_of_theory_goes_through_both_players(
    session: LiveSession,
) -> None:
    passed(session, 0.1)
    assert "**standing**: evader" in page_text(session)
    drawn = {own.layer for own in live_overlays(session)}
    assert "theoretical circle" not in drawn  # the evader stands
    passed(session, 6.0)
    overlays = {own.layer: own for own in live_overlays(session)}
    places, theory = places_of(session), session.theory
    assert theory is not None
    assert f"a circle with distance {theory[1]:.2f} m" in page_text(session)
    session.driven = "pursuer"
    assert "no theory applies" in page_text(session)
    session.driven = ""
    ring = overlays["theoretical circle"].segments[:, 0]
    middle = ring.mean(axis=0)
    for place in places.values():
        away = np.hypot(*(place - middle))
        assert away == pytest.approx(theory[0], rel=1e-3)


def test_an_invalid_reset_leaves_the_game_alone(session: LiveSession) -> None:
    passed(session, 0.5)
    game, settings = session.game, session.settings
    with pytest.raises(ConfigurationError):
        session.reset(duel(room=Room(width=0.6, depth=0.6)))
    assert session.game is game and session.settings is settings
    session.reset()
    assert session.world.time == 0.0 and session.generation == 2


def test_a_game_of_players_is_pushed_reset_and_saved(tmp_path: Path) -> None:
    session = LiveSession(GAME)
    try:
        passed(session, 0.5)
        session.push("blue", 0.3, 0.0)
        passed(session, 0.5)
        layers = {own.layer for own in live_overlays(session)}
        assert {"footsteps", "line of sight", "pushes"} <= layers
        run = load_run(session.save(tmp_path))
        assert run.tracks["ruby"].pushes is None
        pushes = run.tracks["blue"].pushes
        assert pushes is not None and len(pushes) == 1
        values = {"seed": 5, "players.0.gait.stride": 0.02}
        session.reset(with_values(GAME, values))
        assert session.world.time == 0.0
        assert session.played.players[0].gait.stride == 0.02
    finally:
        session.close()


def image(azimuths: tuple[float, ...], *, depth: bool = False) -> Any:
    camera = SimpleNamespace(width=80, height=60, focal_x=60.0)
    if depth:
        depths = np.zeros((60, 80))
        depths[:, 20:40], depths[:, 40:60], depths[:, 60:] = 1.0, 2.0, 9.0
        shown: Any = SimpleNamespace(camera=camera, depths=depths, far=4.0)
    else:
        pixels = np.full((60, 80, 3), 7, dtype=np.uint8)
        shown = ColourImage(0.0, camera, pixels)  # type: ignore[arg-type]
    return SimpleNamespace(image=shown, azimuths=azimuths)


@pytest.mark.parametrize(
    ("azimuth", "column"),
    [(0.0, 40.0), (0.3, 40.0 - 60.0 * np.tan(0.3)), (-0.3, 58.56)],
)
def test_a_line_stands_where_something_was_found(
    azimuth: float, column: float
) -> None:
    """Three times as large; what is to the left is left in the picture."""
    large = camera_picture(image((azimuth,)))
    assert large.shape == (180, 240, 3)
    marked = np.flatnonzero((large[0] == FOUND).all(axis=1))
    at = int(3 * column)
    np.testing.assert_array_equal(marked, [at - 1, at, at + 1])
    assert (large[:, marked] == FOUND).all()
    assert (np.delete(large, marked, axis=1) == 7).all()


def test_what_is_out_of_the_picture_gets_no_line() -> None:
    for azimuth in (0.6, -0.6, 1.5, pi / 2):
        assert (camera_picture(image((azimuth,))) == 7).all()


def test_depth_is_darker_the_farther_and_black_where_nothing_is() -> None:
    shades = camera_picture(image((), depth=True))[0, ::60]
    np.testing.assert_array_equal(shades[:, 0], shades[:, 2])
    nothing, near, far, beyond = shades[:, 0].tolist()
    assert nothing == 0
    assert near == int(255.0 * (1.0 - 0.85 * 0.25))
    assert far == int(255.0 * (1.0 - 0.85 * 0.5))
    assert beyond == int(255.0 * 0.15)
