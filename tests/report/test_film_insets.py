"""Images of the robots' cameras beside the scene of a film."""

from dataclasses import replace
from functools import cache
from typing import Any, ClassVar

import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.games.duel import Duel
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.outcome import Outcome
from stepaside.games.run import Run
from stepaside.report import film, film_insets
from stepaside.report.film import FilmRenderer, FilmSettings
from stepaside.report.film_insets import (
    ESTIMATE_COLOUR,
    WITH_WALLS,
    FilmInsets,
    inset_width,
)
from stepaside.report.scene import RunScene
from stepaside.sim.camera_settings import (
    CameraSettings,
    RoomObject,
    SceneSettings,
)
from stepaside.sim.offscreen_rendering import PLAIN
from stepaside.sim.room_furnishing import SIDES

WIDTH, HEIGHT = 640, 480  # of an inset, in [pixels]
BRIGHTNESS = 200  # of every pixel of a robot's camera


class FakeRenderer:
    """Renderer that draws one shade and records the cameras."""

    made: "ClassVar[list[FakeRenderer]]" = []

    def __init__(self, model: Any, width: int, height: int, *more: Any):
        """Store the size."""
        self.size = height, width, 3
        self.cameras: list[Any] = []
        self.made.append(self)

    def draw(self, data: Any, camera: Any, add: Any = None) -> Any:
        """Return a bright image for a sensor, a black one for the scene."""
        self.cameras.append(camera)
        return np.full(
            self.size, BRIGHTNESS if add is None else 0, dtype=np.uint8
        )

    def close(self) -> None:
        """Do nothing."""


@cache
def short_run() -> Run:
    """Return a run of two standing robots that face each other."""
    start = StartSettings(distance=1.0, pursuer_offset=0.0, evader_offset=0.0)
    duel = Duel(DuelSettings(start=start))
    for _ in range(25):
        duel.tick()
    run = duel.run(Outcome.INTERRUPTED, duel.world.time)
    duel.close()
    return run


def with_sighting(bearing: float, *, since: float = 0.0) -> Run:
    """Return the run with a sighting by the pursuer from a time on."""
    run = short_run()
    pursuer = run.tracks["pursuer"]
    sight = np.array([[since, bearing, 1.0, 0.0, 1.0, 0.0]])
    tracks = {**run.tracks, "pursuer": replace(pursuer, sight=sight)}
    return replace(run, tracks=tracks)


@pytest.fixture
def fake_renderer(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (film, film_insets):
        monkeypatch.setattr(module, "OffscreenRenderer", FakeRenderer)


def tick_column(run: Run) -> float | None:
    """Return the middle of the pursuer's tick, 0 to 1 of the width."""
    scene = RunScene(run)
    scene.put(1)
    insets = FilmInsets(run, scene, "egl", (WIDTH, 2 * HEIGHT))
    bottom = insets.picture(1)[HEIGHT - 2]
    insets.close()
    columns = np.flatnonzero((bottom == ESTIMATE_COLOUR).all(axis=1))
    return float(columns.mean()) / WIDTH if len(columns) else None


@pytest.mark.usefixtures("fake_renderer")
@pytest.mark.parametrize(("width", "height"), [(1280, 720), (480, 270)])
def test_a_split_image_has_the_scene_beside_two_stacked_insets(
    width: int, height: int
) -> None:
    shot = FilmSettings(
        camera="split", width=width, height=height, captions=False
    )
    cinema = FilmRenderer(short_run(), shot, "egl")
    picture = cinema.picture(0.05)
    assert picture.shape == (height, width, 3)
    beside = inset_width(width, height)
    assert (picture[:, :-beside] == 0).all()
    assert np.median(picture[: height // 2, -beside:]) == BRIGHTNESS
    assert np.median(picture[height // 2 :, -beside:]) == BRIGHTNESS
    inset = FakeRenderer.made[-2]
    first, second = inset.cameras
    assert first != second
    cinema.close()


@pytest.mark.parametrize("height", [270, 720, 1080])
def test_insets_are_four_to_three_and_at_most_half_the_image(
    height: int,
) -> None:
    assert inset_width(16 * height // 9, height) == 2 * round(height / 3)
    assert inset_width(height, height) <= height / 2


@pytest.mark.usefixtures("fake_renderer")
@pytest.mark.parametrize("bearing", [0.05, 0.2, 0.4])
def test_the_tick_is_at_the_estimated_bearing(
    bearing: float,
) -> None:
    columns = []
    for each in (bearing, 0.0, -bearing):
        column = tick_column(with_sighting(each))
        assert column is not None
        columns.append(column)
    left, middle, right = columns
    assert left < middle < right
    assert left + right == pytest.approx(2.0 * middle, abs=8e-3)
    assert middle == pytest.approx(0.5, abs=5e-3)
    # Approximately: the camera is in front of the torso.
    camera = CameraSettings().colour.model()
    half = 0.5 * camera.width / camera.focal_x
    aside = 0.5 + 0.5 * np.tan(bearing) / half
    assert right == pytest.approx(aside, abs=0.15 * bearing + 5e-3)


@pytest.mark.usefixtures("fake_renderer")
def test_there_is_no_tick_outside_the_image_or_before_a_sighting() -> None:
    for run in (
        with_sighting(3.0),
        with_sighting(1.2),
        with_sighting(0.0, since=9.0),
    ):
        assert tick_column(run) is None


def cluttered() -> Run:
    """Return the run in a room with an object and walls."""
    room = SceneSettings(things=[RoomObject("red box", 1.0, 2.0)], walls=4.0)
    run = short_run()
    start = StartSettings(distance=1.0, pursuer_offset=0.0, evader_offset=0.0)
    settings = DuelSettings(start=start, sensing="cameras", room=room)
    return replace(run, settings=settings)


def test_objects_are_in_the_scene_and_walls_only_in_the_insets() -> None:
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


@pytest.mark.usefixtures("fake_renderer")
def test_a_run_without_a_robot_s_camera_is_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    run = short_run()
    stage = RunScene(run)
    monkeypatch.setattr(film_insets, "_cameras", lambda run: {})
    with pytest.raises(ConfigurationError, match="has none"):
        film_insets.FilmInsets(run, stage, "egl", (480, 720))
