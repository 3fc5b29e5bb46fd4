"""Parts of the live page: settings panel, cameras, history, session."""

from collections.abc import Iterator
from math import inf

import numpy as np
import pytest

pytest.importorskip("viser", reason="viser is not installed")

from flows.running import until  # noqa: E402
from stepaside.arena import Room  # noqa: E402
from stepaside.core.errors import (  # noqa: E402
    ConfigurationError,
)
from stepaside.core.poses import Array  # noqa: E402
from stepaside.games.game_settings import (  # noqa: E402
    StartSettings,
    duel,
)
from stepaside.report.scene import wall_corners  # noqa: E402
from stepaside.report.viewer.live_session import LiveSession  # noqa: E402
from stepaside.report.viewer.viewer_cameras import overview  # noqa: E402

FOV = 1.309  # [rad]


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
    assert eye[2] > 0.6
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


def test_an_invalid_reset_leaves_the_game_alone(session: LiveSession) -> None:
    passed(session, 0.5)
    game, settings = session.game, session.settings
    with pytest.raises(ConfigurationError):
        session.reset(duel(room=Room(width=0.6, depth=0.6)))
    assert session.game is game and session.settings is settings
    session.reset()
    assert session.world.time == 0.0 and session.generation == 2


def test_a_game_that_fails_stops_until_it_is_reset(
    session: LiveSession, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(_: object) -> None:
        raise ConfigurationError("the motor burnt")

    with monkeypatch.context() as patch:
        patch.setattr("stepaside.games.recorded_game.RecordedGame.tick", fail)
        session.running = True
        until(lambda: session.error)
        assert session.error == "the motor burnt" and not session.running
    session.reset()
    assert session.error is None and not session.running
