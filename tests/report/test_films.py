"""Films: cameras, captions, lines, walls, and the files."""

from collections.abc import Iterator
from functools import cache
from math import cos, sin
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from stepaside.arena import Door, Room
from stepaside.core.poses import Array
from stepaside.games.game_settings import duel
from stepaside.games.player_settings import PLAYERS
from stepaside.games.run import Run
from stepaside.games.trajectory import Trajectory
from stepaside.report import film
from stepaside.report.film import hidden_walls
from stepaside.report.film_camera import (
    MARGIN,
    CameraView,
    FilmCamera,
    framing,
)
from stepaside.report.film_settings import VIEWS, FilmSettings
from stepaside.sim.room_furnishing import add_solids
from synthetic_run import run_of

FOVY, ASPECT = 45.0, 16.0 / 9.0
TIMES = np.linspace(0.0, 30.0, 301)


@cache
def run() -> Run:
    """Return a run: one player on a wide circle, one on a straight line."""
    angle = 0.1 * TIMES
    ways = {
        "pursuer": (3.0 * np.cos(angle), 3.0 * np.sin(angle)),
        "evader": (4.0 + 0.2 * TIMES, 0.3 * TIMES),
    }
    tracks = {
        name: Trajectory(
            com=np.column_stack([*way, 0.27 + 0.0 * TIMES]),
            torso=np.column_stack([*way, angle]),
        )
        for name, way in ways.items()
    }
    return run_of(TIMES, tracks, settings=duel(seed=7))


def projected(camera: FilmCamera, index: int, height: float) -> Array:
    """Return both players' positions in the image. Shape (2, 2)."""
    view = camera.view(index)
    found = []
    for name in PLAYERS:
        place = [*run().tracks[name].torso[index, :2], height]
        at = view.project(np.array(place), FOVY)
        assert at is not None
        found.append(at)
    return np.array(found)


@pytest.mark.parametrize("name", ["fixed", "follow", "top"])
@pytest.mark.parametrize("index", [0, 77, 150, 300])
def test_both_players_are_in_the_image_from_foot_to_head(
    name: str, index: int
) -> None:
    camera = FilmCamera(run(), name, FOVY, ASPECT)
    for height in (0.0, 0.6):
        positions = np.abs(projected(camera, index, height))
        assert (positions <= [0.97 * ASPECT, 0.97]).all()


@pytest.mark.parametrize(
    "direction", [(0.0, -20.0), (60.0, -32.0), (90.0, -89.9)]
)
def test_a_view_frames_its_points_tightly(
    direction: tuple[float, float],
) -> None:
    points = np.random.default_rng(3).uniform(-2.0, 3.0, (50, 3))
    begin = CameraView(np.zeros(3), 0.0, *direction)
    view = framing(points, begin, FOVY, ASPECT)
    image = np.array([view.project(p, FOVY) for p in points])
    fractions = np.abs(image) / [ASPECT, 1.0]
    assert fractions.max() == pytest.approx(MARGIN)


@pytest.mark.parametrize("name", VIEWS)
def test_a_view_has_the_axes_of_mujoco_s_camera(name: str) -> None:
    view = FilmCamera(run(), name, FOVY, ASPECT).view(50)
    model = mujoco.MjModel.from_xml_string("<mujoco><worldbody/></mujoco>")
    data = mujoco.MjData(model)
    scene = mujoco.MjvScene(model, 10)
    every = mujoco.mjtCatBit.mjCAT_ALL
    option = mujoco.MjvOption()
    mujoco.mjv_updateScene(
        model, data, option, None, view.camera(), every, scene
    )
    eye = scene.camera[0]
    np.testing.assert_allclose(eye.forward, view.axes[2], atol=1e-6)
    np.testing.assert_allclose(eye.up, view.axes[1], atol=1e-6)


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
        before = model.geom_rgba.copy()
        with hidden_walls(model, eye):
            hidden = np.flatnonzero(model.geom_rgba[:, 3] == 0.0)
            assert set(hidden.tolist()) == wanted
        np.testing.assert_array_equal(model.geom_rgba, before)
    with hidden_walls(model, np.array([0.1, 0.2, 0.5])) as walls:
        assert walls == []
    assert model.ngeom == 5  # two of them beside the door


def shades(count: int) -> Iterator[Any]:
    for number in range(count):
        yield np.full((48, 64, 3), 40 * number, dtype=np.uint8)


def test_a_film_that_fails_leaves_nothing_behind(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("av")

    def failing(*_: object) -> Iterator[Any]:
        yield from shades(2)
        raise RuntimeError("the light went out")

    monkeypatch.setattr(film, "load_run", lambda folder: run())
    monkeypatch.setattr(film, "render_images", failing)
    with pytest.raises(RuntimeError, match="light"):
        film.write_film(
            tmp_path,
            tmp_path / "run.mp4",
            FilmSettings(64, 48),
            lambda *_: None,
        )
    assert list(tmp_path.iterdir()) == []


def test_a_film_shows_its_duration_from_where_it_begins() -> None:
    for begin, last in (0.0, 60.0), (20.0, 60.0), (20.0, 23.0), (20.0, 19.0):
        film = FilmSettings(begin=begin, duration=4.0, rate=10.0, speed=2.0)
        times = film.frame_times(last)
        assert np.allclose(times[:1], begin) and np.allclose(
            np.diff(times), 0.2
        )
        shown = max(0.0, min(4.0, last - begin))
        assert len(times) == (round(shown / 0.2) + 1 if last >= begin else 0)
