"""Test the body of a person: size, gait and role in a duel."""

from math import pi, sin
from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Array, Pose
from stepaside.core.rotations import rotation
from stepaside.games.duel import Duel
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.floor_player import FloorPlayer
from stepaside.games.floor_world import FloorPerson
from stepaside.games.walker import SimulatedPlayer
from stepaside.sim.pedestrian_appearance import FIGURES, HIP
from stepaside.sim.person_body import (
    PARTS,
    PersonBody,
    add_person,
    mocap_indices,
    set_person_pose,
)
from stepaside.sim.person_motion import PersonMotion
from stepaside.sim.person_settings import PersonSettings
from stepaside.sim.push import Push

TICK = 0.05
STEP = FIGURES["adult"].step


def figure() -> tuple[mujoco.MjModel, mujoco.MjData]:
    spec = mujoco.MjSpec()
    add_person(spec, "her")
    model = spec.compile()
    return model, mujoco.MjData(model)


def posed(frame: Pose, way: float) -> tuple[mujoco.MjModel, mujoco.MjData]:
    model, data = figure()
    set_person_pose(data, mocap_indices(model, "her"), frame, way)
    mujoco.mj_kinematics(model, data)
    return model, data


def box(model: mujoco.MjModel, data: mujoco.MjData, *names: str) -> Array:
    """Least and greatest corner of parts. Shape (2, 3)."""
    ends = []
    for name in names:
        body = model.body(f"her/{name}").id
        for geom in np.flatnonzero(model.geom_bodyid == body):
            radius, half = model.geom_size[geom, :2]
            axis = half * data.geom_xmat[geom].reshape(3, 3)[:, 2]
            for end in (-axis, axis):
                place = data.geom_xpos[geom] + end
                ends += [place - radius, place + radius]
    return np.array([np.min(ends, axis=0), np.max(ends, axis=0)])


STANDING = Pose(0.0, 0.0, 0.0)


def test_a_person_has_human_size() -> None:
    model, data = posed(STANDING, 0.0)
    low, high = box(model, data, *PARTS)
    assert low[2] == pytest.approx(0.0, abs=0.01)
    assert high[2] == pytest.approx(1.74, abs=0.01)
    np.testing.assert_allclose((low[1], high[1]), (-0.295, 0.295), atol=5e-3)
    low, high = box(model, data, "trunk")
    np.testing.assert_allclose((low[1], high[1]), (-0.23, 0.23), atol=1e-9)
    np.testing.assert_allclose((low[0], high[0]), (-0.15, 0.15), atol=1e-9)
    assert low[2] == pytest.approx(0.8)  # hips overlap with the legs
    low, high = box(model, data, "left leg")
    np.testing.assert_allclose((low[0], high[0]), (-0.085, 0.185), atol=1e-9)
    np.testing.assert_allclose((low[1], high[1]), (0.025, 0.155), atol=1e-9)
    assert high[2] == pytest.approx(0.965)
    low, high = box(model, data, "left arm")
    assert low[2] == pytest.approx(1.42 - 0.55 - 0.045)
    assert high[2] == pytest.approx(1.465)
    assert low[1] == pytest.approx(0.195)
    assert high[0] == pytest.approx(0.075)


@pytest.mark.parametrize("way", [0.0, 0.1, 0.125, 0.3])
def test_left_and_right_are_mirror_images_half_a_walk_apart(
    way: float,
) -> None:
    now, later = posed(STANDING, way), posed(STANDING, way + STEP)
    for part in ("leg", "arm"):
        left = box(*now, f"left {part}") * (1, -1, 1)
        right = box(*later, f"right {part}")
        np.testing.assert_allclose(np.sort(left, axis=0), right, atol=1e-12)


def feet(way: float) -> Array:
    """How far each leg's ankle is ahead, left and right. Shape (2,)."""
    _, data = posed(STANDING, way)
    ahead = []
    for side in ("left", "right"):
        leg = data.body(f"her/{side} leg")
        hip = leg.xpos + leg.xmat.reshape(3, 3) @ (0.0, 0.0, -HIP)
        ahead.append(float(hip[0]))
    return np.array(ahead)


@pytest.mark.parametrize("name", FIGURES)
def test_pedestrians_are_scaled_and_step_as_far_as_legs_swing(
    name: str,
) -> None:
    """A child is smaller in all, dressed otherwise, and steps farther."""
    figure = FIGURES[name]
    spec = mujoco.MjSpec()
    add_person(spec, "her", figure)
    model = spec.compile()
    data = mujoco.MjData(model)
    parts = mocap_indices(model, "her")
    set_person_pose(data, parts, STANDING, 0.0, figure)
    mujoco.mj_kinematics(model, data)
    adult = posed(STANDING, 0.0)
    for part in PARTS:
        own, theirs = box(model, data, part), box(*adult, part)
        np.testing.assert_allclose(own, figure.size * theirs, atol=1e-9)
    reach = 2.0 * HIP * figure.size * sin(figure.swing)
    assert reach == pytest.approx(figure.step, rel=0.02)
    shirts = {each.shirt for each in FIGURES.values()}
    assert len(shirts) == len(FIGURES)


def test_a_child_can_be_the_pursuer() -> None:
    person = PersonSettings(figure="child")
    start = StartSettings(2.0, 0.0, 0.0)
    settings = DuelSettings(pursuer="person", person=person, start=start)
    duel = Duel(settings)
    assert duel.players[0].truth.position_com_in_world[2] == pytest.approx(0.7)
    duel.close()
    with pytest.raises(ConfigurationError, match="adult, child, got 'dog'"):
        PersonSettings(figure="dog")


def test_feet_are_a_step_apart_in_the_middle_of_a_step() -> None:
    """Of 0.25 m. Rigid legs would slide over the floor."""
    left, right = feet(0.5 * STEP)
    assert abs(left - right) == pytest.approx(0.25, rel=0.02)
    assert left == pytest.approx(-right)
    np.testing.assert_allclose(feet(0.0), 0.0, atol=1e-12)
    np.testing.assert_allclose(feet(STEP), 0.0, atol=1e-12)
    np.testing.assert_allclose(feet(1.5 * STEP), [right, left])
    ways = np.linspace(0.0, 2.0 * STEP, 9)
    swing = np.array([feet(way)[0] for way in ways])
    expected = left * np.sin(pi * ways / STEP)
    np.testing.assert_allclose(swing, expected, atol=1e-3)


@pytest.mark.parametrize("theta", [0.0, 1.0, -2.5])
def test_a_figure_turns_and_moves_as_one(theta: float) -> None:
    frame = Pose(1.0, -2.0, theta)
    model, data = posed(frame, 0.4 * STEP)
    still = posed(STANDING, 0.4 * STEP)[1]
    turn = rotation(0.0, 0.0, theta)
    for geom in range(model.ngeom):
        place = turn @ still.geom_xpos[geom] + (1.0, -2.0, 0.0)
        np.testing.assert_allclose(data.geom_xpos[geom], place, atol=1e-12)
        frames = turn @ still.geom_xmat[geom].reshape(3, 3)
        np.testing.assert_allclose(
            data.geom_xmat[geom], frames.reshape(-1), atol=1e-12
        )


def world_of(model: mujoco.MjModel, data: mujoco.MjData) -> Any:
    physics = SimpleNamespace(tick=TICK)
    return SimpleNamespace(model=model, data=data, physics=physics, time=0.0)


def walker(
    world: Any, motion: PersonMotion, evader: tuple[float, float]
) -> tuple[FloorPlayer, Any]:
    """A person, and the position of the evader, which may be changed."""
    other: Any = SimpleNamespace(position_torso_in_world=evader)
    body = PersonBody(world, "her", motion.pose)
    walk = FloorPerson("her", motion, {}, "evader", TICK)

    def seen() -> dict[str, Pose]:
        x, y = other.position_torso_in_world
        return {"evader": Pose(x, y, 0.0)}

    return FloorPlayer(body, walk, seen), other


def test_a_person_walks_leg_by_leg_towards_the_evader() -> None:
    model, data = figure()
    world = world_of(model, data)
    motion = PersonMotion(
        PersonSettings("steer", 0.5), Pose(1.03, 2, 0), (4, 2)
    )
    person, _ = walker(world, motion, (4.0, 2.0))
    assert person.name == "her"
    trunk = int(model.body("her/trunk").mocapid[0])
    leg = int(model.body("her/left leg").mocapid[0])
    assert data.mocap_pos[trunk, :2].tolist() == [1.03, 2.0]
    for i in range(5):
        world.time = i * TICK
        person.tick()
    way = 5 * TICK * 0.5
    assert way == pytest.approx(0.5 * STEP)
    assert data.mocap_pos[trunk, :2] == pytest.approx((1.03 + way, 2.0))
    assert data.mocap_quat[leg, 2] == pytest.approx(sin(0.07))
    assert person.truth.position_torso_in_world == pytest.approx(
        (1.03 + way, 2.0)
    )


def test_a_recorded_person_is_where_the_end_of_the_tick_says(
    tmp_path: Any,
) -> None:
    file = tmp_path / "walk.csv"
    file.write_text("time,x,y\n0,0,0\n10,10,0\n")
    model, data = figure()
    world = world_of(model, data)
    motion = PersonMotion(PersonSettings(str(file)), STANDING, (4.0, 0.0))
    person, _ = walker(world, motion, (4.0, 0.0))
    world.time = 2.0
    person.tick()
    assert person.truth.position_torso_in_world == pytest.approx(
        (2.0 + TICK, 0.0)
    )


def test_a_person_cannot_be_pushed() -> None:
    model, data = figure()
    motion = PersonMotion(PersonSettings("steer"), STANDING, (4.0, 2.0))
    player, _ = walker(world_of(model, data), motion, (4.0, 2.0))
    with pytest.raises(ConfigurationError, match="a robot .* got her"):
        player.push(Push(1.0, 0.0, 0.0))


def test_a_person_steers_at_the_current_evader_position() -> None:
    model, data = figure()
    world = world_of(model, data)
    motion = PersonMotion(
        PersonSettings("steer", 0.5, 2.0), STANDING, (4.0, 0.0)
    )
    player, other = walker(world, motion, (0.0, 4.0))
    for side in (1.0, -1.0):
        other.position_torso_in_world = (0.0, 4.0 * side)
        before = player.truth.heading_in_world
        player.tick()
        world.time += TICK
        assert side * (player.truth.heading_in_world - before) > 0.01


def test_a_person_starts_at_the_pursuer_pose() -> None:
    """A straight walk looks once, at the middle or beside it."""
    start = StartSettings(2.0, 0.5, -0.3)
    for miss in (0.0, -0.5):
        settings = DuelSettings(
            pursuer="person",
            start=start,
            person=PersonSettings("straight", miss=miss),
        )
        duel = Duel(settings)
        person, evader = duel.players
        assert isinstance(person, FloorPlayer) and isinstance(
            evader, SimulatedPlayer
        )
        assert (person.name, evader.name) == ("pursuer", "evader")
        assert person.truth.position_torso_in_world == (0.0, 0.0)
        aside = np.arctan2(miss, 2.0)
        assert person.truth.heading_in_world == pytest.approx(aside, abs=1e-6)
        sighting = evader.robot.read().sighting
        assert sighting is not None  # and the evader knows the person
        assert sighting.distance == pytest.approx(duel.distance)
        assert duel.tick() is None
        assert person.truth.position_torso_in_world[0] > 0.0
