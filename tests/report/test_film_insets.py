"""What robots see, beside the scene of a film."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.games.duel import Duel
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.outcome import Outcome
from stepaside.games.run import Run
from stepaside.report import film
from stepaside.report import film_insets as film_split
from stepaside.report.film import FilmRenderer, FilmSettings
from stepaside.report.film_insets import WITH_WALLS, room_beside
from stepaside.report.scene import RunScene
from stepaside.sim.camera_settings import RoomObject, SceneSettings
from stepaside.sim.offscreen_rendering import PLAIN
from stepaside.sim.room_furnishing import SIDES

SEEN = 200  # brightness of all that a robot sees


class FakeScreen:
    """Draws one shade, and keeps by which camera."""

    def __init__(self, model: Any, width: int, height: int, *more: Any):
        """Note the size."""
        self.size = height, width, 3
        self.cameras: list[Any] = []

    def draw(self, data: Any, camera: Any, add: Any = None) -> Any:
        """Draw for the sensors alone."""
        self.cameras.append(camera)
        return np.full(self.size, SEEN if add is None else 0, dtype=np.uint8)

    def close(self) -> None:
        """Be closed."""


@cache
def short_run() -> Run:
    """Two robots that stand and face each other."""
    start = StartSettings(distance=1.0, pursuer_offset=0.0, evader_offset=0.0)
    duel = Duel(DuelSettings(start=start))
    for _ in range(25):
        duel.tick()
    run = duel.run(Outcome.INTERRUPTED, duel.world.time)
    duel.close()
    return run


def believing(bearing: float, *, since: float = 0.0) -> Run:
    """The run in which the pursuer takes the evader to be there."""
    run = short_run()
    pursuer = run.tracks["pursuer"]
    sight = np.array([[since, bearing, 1.0, 0.0, 1.0, 0.0]])
    tracks = {**run.tracks, "pursuer": replace(pursuer, sight=sight)}
    return replace(run, tracks=tracks)


@pytest.fixture
def screened(monkeypatch: pytest.MonkeyPatch) -> None:
    for place in (film, film_split):
        monkeypatch.setattr(place, "OffscreenRenderer", FakeScreen)


def insets_of(run: Run) -> Any:
    cinema = FilmRenderer(run, FilmSettings(camera="split"), "egl")
    cinema._stage.put(1)
    return cinema._insets


@pytest.mark.usefixtures("screened")
@pytest.mark.parametrize(("width", "height"), [(1280, 720), (480, 270)])
def test_a_split_picture_is_whole_and_half_of_it_is_what_both_see(
    width: int, height: int
) -> None:
    shot = FilmSettings(
        camera="split", width=width, height=height, words=False
    )
    cinema = FilmRenderer(short_run(), shot, "egl")
    picture = cinema.picture(0.05)
    assert picture.shape == (height, width, 3)
    beside = room_beside(width, height)
    assert (picture[:, :-beside] == 0).all()
    assert np.median(picture[: height // 2, -beside:]) == SEEN
    assert np.median(picture[height // 2 :, -beside:]) == SEEN
    insets: Any = cinema._insets
    one, other = insets._screen.cameras
    assert one != other
    cinema.close()


@pytest.mark.parametrize("height", [270, 720, 1080])
def test_what_is_seen_is_four_to_three_and_never_half_the_picture(
    height: int,
) -> None:
    assert room_beside(16 * height // 9, height) == 2 * round(height / 3)
    assert room_beside(height, height) <= height / 2


@pytest.mark.usefixtures("screened")
@pytest.mark.parametrize("bearing", [0.05, 0.2, 0.4])
def test_the_tick_is_where_a_robot_takes_the_other_to_be(
    bearing: float,
) -> None:
    columns = []
    for each in (bearing, 0.0, -bearing):
        insets = insets_of(believing(each))
        number = insets._cameras["pursuer"]
        columns.append(insets._believed("pursuer", 1, number))
    left, middle, right = columns
    assert left < middle < right
    assert left + right == pytest.approx(2.0 * middle, abs=5e-3)
    assert middle == pytest.approx(0.5, abs=5e-3)
    # Nearly as far aside as its tangent says: the camera is before the torso.
    half = 0.5 * insets._seen.width / insets._seen.focal_x
    aside = 0.5 + 0.5 * np.tan(bearing) / half
    assert right == pytest.approx(aside, abs=0.15 * bearing)


@pytest.mark.usefixtures("screened")
def test_there_is_no_tick_of_what_is_behind_or_not_known_yet() -> None:
    for run in (believing(3.0), believing(1.2), believing(0.0, since=9.0)):
        insets = insets_of(run)
        number = insets._cameras["pursuer"]
        assert insets._believed("pursuer", 1, number) is None


def cluttered() -> Run:
    """The run of robots that see boxes and walls."""
    room = SceneSettings(things=[RoomObject("red box", 1.0, 2.0)], walls=4.0)
    run = short_run()
    start = StartSettings(distance=1.0, pursuer_offset=0.0, evader_offset=0.0)
    settings = DuelSettings(start=start, sensing="cameras", room=room)
    return replace(run, settings=settings)


def test_things_stand_in_a_film_and_walls_in_what_is_seen_alone() -> None:
    model = RunScene(cluttered()).model
    assert model.body("thing 0").pos[:2].tolist() == [1.0, 2.0]
    box = model.body("thing 0").geomadr[0]
    assert model.geom_group[box] < PLAIN.groups
    for x, y in SIDES:
        wall = model.geom(f"wall {x} {y}")
        assert max(abs(wall.pos[:2])) == 4.0
        assert PLAIN.groups <= wall.group[0] < WITH_WALLS.groups
    bare = RunScene(short_run()).model
    assert bare.ngeom < model.ngeom and bare.nq == model.nq


@pytest.mark.usefixtures("screened")
def test_a_run_without_a_robot_s_camera_is_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    run = short_run()
    stage = RunScene(run)
    monkeypatch.setattr(film_split, "_cameras", lambda run: {})
    with pytest.raises(ConfigurationError, match="has none"):
        film_split.FilmInsets(run, stage, "egl", (480, 720))
