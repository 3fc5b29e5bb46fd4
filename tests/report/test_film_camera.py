"""Where a film's camera stands, when it is slow, and what it says."""

from dataclasses import replace
from functools import cache

import mujoco
import numpy as np
import pytest

from invented_run import run_of
from stepaside.core.poses import Array
from stepaside.games.duel_settings import PLAYERS, DuelSettings
from stepaside.games.run import Run
from stepaside.games.trajectory import Trajectory
from stepaside.report import film_layers
from stepaside.report.film import FilmSettings, closest_time
from stepaside.report.film_camera import MARGIN, VIEWS, FilmCamera, framing
from stepaside.report.film_captions import caption, title_of
from stepaside.report.film_shot import AROUND, SLOWEST
from stepaside.report.palette import PALETTES

FOVY, ASPECT = 45.0, 16.0 / 9.0
TIMES = np.linspace(0.0, 30.0, 301)


@cache
def run() -> Run:
    """One walks round a wide circle, the other away from it."""
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


def seen_at(man: FilmCamera, index: int, height: float) -> Array:
    """Places of both players in the picture. Shape (2, 2)."""
    view = man.view(index)
    found = []
    for name in PLAYERS:
        place = [*run().tracks[name].torso[index, :2], height]
        at = view.project(np.array(place), FOVY)
        assert at is not None
        found.append(at)
    return np.array(found)


@pytest.mark.parametrize("name", ["fixed", "follow", "top"])
@pytest.mark.parametrize("index", [0, 77, 150, 300])
def test_both_players_are_in_the_picture_from_foot_to_head(
    name: str, index: int
) -> None:
    man = FilmCamera(run(), name, FOVY, ASPECT)
    for height in (0.0, 0.6):
        places = np.abs(seen_at(man, index, height))
        assert (places <= [0.97 * ASPECT, 0.97]).all()


def test_who_follows_comes_nearer_and_moves_calmly() -> None:
    fixed, follow = (
        FilmCamera(run(), name, FOVY, ASPECT) for name in ("fixed", "follow")
    )
    views = [follow.view(i) for i in range(len(TIMES))]
    assert views[0].distance < 0.6 * fixed.view(0).distance
    places = np.array([[*view.target, view.distance] for view in views])
    jerks = np.diff(places, 2, axis=0) / 0.1**2
    assert np.abs(jerks).max() < 0.5  # [m/s2]
    assert follow.reach > views[0].distance


@pytest.mark.parametrize("turn", [(0.0, -20.0), (60.0, -32.0), (90.0, -89.9)])
def test_a_view_frames_its_points_and_wastes_no_room(
    turn: tuple[float, float],
) -> None:
    points = np.random.default_rng(3).uniform(-2.0, 3.0, (50, 3))
    view = framing(points, *turn, FOVY, ASPECT)
    seen = np.array([view.project(p, FOVY) for p in points])
    share = np.abs(seen) / [ASPECT, 1.0]
    assert share.max() == pytest.approx(MARGIN)


def test_the_evader_s_eyes_see_the_pursuer_in_the_middle() -> None:
    man = FilmCamera(run(), "eyes", FOVY, ASPECT)
    view = man.view(100)
    pursuer, evader = (run().tracks[n].com[100] for n in PLAYERS)
    assert view.project(pursuer, FOVY) == pytest.approx((0.0, 0.0), abs=1e-9)
    eye = view.target - view.distance * view.axes[2]
    assert np.hypot(*(eye - evader)[:2]) < 0.1 and eye[2] > evader[2]
    behind = evader + (evader - pursuer)
    assert view.project(behind, FOVY) is None


@pytest.mark.parametrize("name", VIEWS)
def test_a_view_is_that_of_mujoco_s_camera(name: str) -> None:
    """Their axes: what is projected lies where it is drawn."""
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
def test_a_bar_lies_along_its_way_and_flat_on_the_floor(
    way: tuple[float, float, float],
) -> None:
    ahead = np.array(way) / np.linalg.norm(way)
    turn = film_layers.turn_along(*ahead.tolist()).reshape(3, 3)
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(turn) == pytest.approx(1.0)
    np.testing.assert_allclose(turn[:, 2], ahead)
    if abs(ahead[2]) < 0.9:
        assert turn[2, 0] == 0.0


def test_the_light_shines_on_what_is_looked_at() -> None:
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
    film_layers.light_up(scene, target)
    (light,) = [x for x in scene.lights[: scene.nlight] if x.castshadow]
    away = target - light.pos
    np.testing.assert_allclose(np.cross(away, light.dir), 0.0, atol=1e-5)
    assert away @ light.dir > 1.0


def test_time_is_slow_about_the_closest_approach_alone() -> None:
    closest = 12.0
    shot = FilmSettings(slow=True, speed=2.0, rate=10.0)
    times = np.array(shot.instants(30.0, closest))
    paces = np.diff(times) * 10.0
    near = np.abs(times[:-1] - closest)
    np.testing.assert_allclose(paces[near > AROUND], 2.0)
    assert paces.min() == pytest.approx(2.0 * SLOWEST)
    assert near[paces.argmin()] <= 0.5 * AROUND + 0.2
    assert np.abs(np.diff(paces)).max() < 0.5
    plain = FilmSettings(speed=2.0, rate=10.0)
    assert plain.instants(30.0, closest) == plain.instants(30.0)


def test_the_closest_approach_is_that_of_the_run() -> None:
    at = closest_time(run())
    distance = run().distance
    assert distance is not None and TIMES[int(np.argmin(distance))] == at


def test_words_are_written_over_the_players_and_below() -> None:
    grey = np.full((360, 640, 3), 128, dtype=np.uint8)
    view = FilmCamera(run(), "fixed", FOVY, ASPECT).view(0)
    told = caption(grey, run(), 0, view=view, fovy=FOVY, pace=1.0)
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
    fast = caption(grey, run(), 0, view=view, fovy=FOVY, pace=2.0)
    assert (fast != told).any()
    small = np.full((90, 160, 3), 128, dtype=np.uint8)
    assert caption(small, run(), 0, view=view, fovy=FOVY, pace=1.0) is small


def test_words_of_anybody_are_written_however_long_they_are() -> None:
    long = replace(run(), message="x" * 500 + "\x1b\n")
    grey = np.full((360, 640, 3), 128, dtype=np.uint8)
    view = FilmCamera(run(), "top", FOVY, ASPECT).view(0)
    last = len(TIMES) - 1
    caption(grey, long, last, view=view, fovy=FOVY, pace=1.0)
    titled = title_of(grey, "a\x1b[2J title")
    assert (titled[:40, :40] != 128).any() and (titled[100:] == 128).all()
    assert title_of(grey, "") is grey
