"""Cameras, slow motion and captions of films."""

from dataclasses import replace
from functools import cache

import mujoco
import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.games.duel_settings import PLAYERS, DuelSettings
from stepaside.games.run import Run
from stepaside.games.trajectory import Trajectory
from stepaside.report import film_layers
from stepaside.report.film import FilmSettings
from stepaside.report.film_camera import MARGIN, FilmCamera, framing
from stepaside.report.film_captions import caption
from stepaside.report.film_settings import VIEWS
from stepaside.report.palette import PALETTES
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
    return run_of(TIMES, tracks, settings=DuelSettings(seed=7))


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


def test_the_following_camera_is_nearer_and_moves_smoothly() -> None:
    fixed, follow = (
        FilmCamera(run(), name, FOVY, ASPECT) for name in ("fixed", "follow")
    )
    views = [follow.view(i) for i in range(len(TIMES))]
    assert views[0].distance < 0.6 * fixed.view(0).distance
    rows = np.array([[*view.target, view.distance] for view in views])
    accelerations = np.diff(rows, 2, axis=0) / 0.1**2
    assert np.abs(accelerations).max() < 0.5  # [m/s2]
    assert follow.reach > views[0].distance


@pytest.mark.parametrize(
    "direction", [(0.0, -20.0), (60.0, -32.0), (90.0, -89.9)]
)
def test_a_view_frames_its_points_tightly(
    direction: tuple[float, float],
) -> None:
    points = np.random.default_rng(3).uniform(-2.0, 3.0, (50, 3))
    view = framing(points, *direction, FOVY, ASPECT)
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


@pytest.mark.parametrize(
    "way", [(1.0, 0.0, 0.0), (0.6, -0.8, 0.0), (0.1, 0.2, 0.97), (0, 0, -1)]
)
def test_a_line_has_its_direction_and_a_horizontal_side(
    way: tuple[float, float, float],
) -> None:
    ahead = np.array(way) / np.linalg.norm(way)
    turn = film_layers.rotation_along(*ahead.tolist()).reshape(3, 3)
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(turn) == pytest.approx(1.0)
    np.testing.assert_allclose(turn[:, 2], ahead)
    if abs(ahead[2]) < 0.9:
        assert turn[2, 0] == 0.0


def test_the_light_shines_on_the_target() -> None:
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><light dir='0.3 0 -1' castshadow='true'/>"
        "</worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    scene = mujoco.MjvScene(model, 10)
    every, camera = mujoco.mjtCatBit.mjCAT_ALL, mujoco.MjvCamera()
    mujoco.mjv_updateScene(
        model, data, mujoco.MjvOption(), None, camera, every, scene
    )
    target = np.array([5.0, -2.0, 0.3])
    film_layers.aim_light(scene, target)
    (light,) = [x for x in scene.lights[: scene.nlight] if x.castshadow]
    away = target - light.pos
    np.testing.assert_allclose(np.cross(away, light.dir), 0.0, atol=1e-5)
    assert away @ light.dir > 1.0


def test_a_film_has_images_at_its_rate_and_speed() -> None:
    shot = FilmSettings(speed=2.0, rate=10.0, begin=1.0, duration=3.0)
    np.testing.assert_allclose(shot.frame_times(30.0), np.arange(16) / 5 + 1)
    assert shot.frame_times(0.5) == []


def test_names_are_written_above_the_players_and_values_below() -> None:
    grey = np.full((360, 640, 3), 128, dtype=np.uint8)
    view = FilmCamera(run(), "fixed", FOVY, ASPECT).view(0)
    told = caption(grey, run(), 0, view=view, fovy=FOVY, speed=1.0)
    assert told.shape == grey.shape and (grey == 128).all()
    assert told[-5, 300].min() > 180  # the band
    for name in PLAYERS:
        place = np.array([*run().tracks[name].torso[0, :2], 0.62])
        at = view.project(place, FOVY)
        assert at is not None
        x, y = 320 + 180 * at[0], 180 * (1.0 - at[1])
        chip = told[int(y) - 12 : int(y), int(x) - 12 : int(x) + 12]
        ink = np.array(
            list(bytes.fromhex(getattr(PALETTES["light"], name)[1:]))
        )
        assert np.abs(chip.astype(int) - ink).sum(axis=2).min() < 60
    fast = caption(grey, run(), 0, view=view, fovy=FOVY, speed=2.0)
    assert (fast != told).any()
    small = np.full((90, 160, 3), 128, dtype=np.uint8)
    assert caption(small, run(), 0, view=view, fovy=FOVY, speed=1.0) is small


def test_untrusted_text_of_any_length_is_written() -> None:
    long = replace(run(), message="x" * 500 + "\x1b\n")
    grey = np.full((360, 640, 3), 128, dtype=np.uint8)
    view = FilmCamera(run(), "top", FOVY, ASPECT).view(0)
    last = len(TIMES) - 1
    caption(grey, long, last, view=view, fovy=FOVY, speed=1.0)
