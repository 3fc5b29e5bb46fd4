"""Films of rooms: near walls hide no player, and rings have labels."""

from math import cos, sin

import mujoco
import numpy as np
import pytest

from stepaside.arena import Door, Room
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.run import DuelRun
from stepaside.games.trajectory import Trajectory
from stepaside.report.film import hidden_walls, walls_before
from stepaside.report.film_camera import FilmCamera
from stepaside.report.film_captions import ring_labels
from stepaside.sim.camera_settings import SceneSettings
from stepaside.sim.obstacle_geoms import add_solids
from synthetic_run import run_of

SHAPES = [(3.0, 3.0), (2.0, 8.0), (9.0, 1.6)]


def model_of(room: Room) -> mujoco.MjModel:
    """Return a model of only a room."""
    spec = mujoco.MjSpec()
    add_solids(spec, room)
    return spec.compile()


@pytest.mark.parametrize("shape", SHAPES)
def test_walls_between_the_camera_and_the_room_are_hidden_for_one_image(
    shape: tuple[float, float],
) -> None:
    width, depth = shape
    room = Room(width=width, depth=depth, doors=(Door("east", 0.0, 0.5),))
    model = model_of(room)
    places = model.body_pos[model.geom_bodyid]
    sides = ((0, 1), (0, -1), (1, 1), (1, -1))  # axis and sign
    half = 0.5 * np.array(shape)
    for angle in np.linspace(0.0, 6.0, 13):
        eye = np.array([9.0 * cos(angle), 9.0 * sin(angle), 3.0])
        wanted = {
            geom
            for geom in range(model.ngeom)
            for axis, sign in sides
            if sign * places[geom][axis] > half[axis]
            and sign * eye[axis] > half[axis] + 0.05
        }
        assert set(walls_before(model, eye)) == wanted
        before = model.geom_rgba.copy()
        with hidden_walls(model, eye):
            hidden = np.flatnonzero(model.geom_rgba[:, 3] == 0.0)
            assert set(hidden.tolist()) == wanted
        np.testing.assert_array_equal(model.geom_rgba, before)
    assert walls_before(model, np.array([0.1, 0.2, 0.5])) == []
    assert model.ngeom == 5  # two of them beside the door


def still(plan: Room | None) -> DuelRun:
    """Return a run of two standing players near the center."""
    times = np.linspace(0.0, 2.0, 21)
    tracks = {}
    for name, x in (("pursuer", -0.3), ("evader", 0.4)):
        torso = np.tile([x, 0.1, 0.0], (21, 1))
        tracks[name] = Trajectory(com=torso.copy(), torso=torso)
    settings = DuelSettings(room=SceneSettings(plan=plan))
    return run_of(times, tracks, settings=settings)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("aspect", [0.6, 1.8])
def test_the_top_view_of_a_film_shows_the_whole_room(
    shape: tuple[float, float], aspect: float
) -> None:
    room = Room(width=shape[0], depth=shape[1])
    view = FilmCamera(still(room), "top", 45.0, aspect).view(0)
    for wall in room.walls:
        for x, y in wall.points.tolist():
            seen = view.project(np.array([x, y, 0.6]), 45.0)
            assert seen is not None
            assert abs(seen[0]) < aspect and abs(seen[1]) < 1.0


def test_the_label_of_a_ring_is_on_the_ring() -> None:
    run = still(None)
    ((text, place, _),) = ring_labels(run, 3)
    assert text == "safety radius 0.8 m"
    away = place[:2] - run.evader.torso[3, :2]
    assert np.hypot(*away) == pytest.approx(0.8, rel=1e-2)
