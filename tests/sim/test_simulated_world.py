"""Test a world of robots: contacts, time and placement."""

import mujoco
import numpy as np
import pytest

from stepaside.robots.description import load_robot
from stepaside.sim.physics_settings import PhysicsSettings
from stepaside.sim.world import World, build_model

NAO = load_robot("nao")
TWO = dict.fromkeys(("pursuer", "evader"), NAO)
SOLE = 0.3  # height of a torso at which soles are in the floor, in [m]


def furnish(spec: mujoco.MjSpec) -> None:
    """A box that stands in the room, and one that is part of the floor."""
    body = spec.worldbody.add_body(name="box", pos=[5.0, 0.0, 0.5])
    kind = mujoco.mjtGeom.mjGEOM_BOX
    body.add_geom(
        type=kind, size=[0.2, 0.2, 0.5], contype=128, conaffinity=255
    )
    spec.worldbody.add_geom(
        type=kind,
        size=[0.2, 0.2, 0.5],
        pos=[-5.0, 0.0, 0.5],
        contype=1,
        conaffinity=255,
    )


def placed(world: World, first: float, second: float, height: float) -> None:
    data = world.data
    size = world.model.nq // 2
    for index, x in enumerate((first, second)):
        at = index * size
        data.qpos[at : at + 7] = (x, 0, height, 1, 0, 0, 0)
    mujoco.mj_forward(world.model, data)


def test_contacts_are_with_robots_and_objects_not_the_floor() -> None:
    world = World(TWO, PhysicsSettings(), furnish=furnish)
    placed(world, 0.0, 2.0, 2.0)
    assert world.data.ncon == 0 and not world.robots_touch()
    placed(world, 0.0, 2.0, SOLE)  # both on the floor
    assert world.data.ncon > 0 and not world.robots_touch()
    placed(world, -5.0, 2.0, SOLE)  # one in a wall
    assert world.data.ncon > 0 and not world.robots_touch()
    for first, second in ((0.0, 0.12), (5.0, 0.0), (0.0, 5.0)):
        placed(world, first, second, 2.0 if second == 0.12 else 0.6)
        assert world.data.ncon > 0 and world.robots_touch()


@pytest.mark.parametrize("number", [1, 2, 3, 8, 10, 17])
def test_every_pair_of_robots_collides_once(number: int) -> None:
    """Each collides with the floor and the others, not with itself."""
    robots = dict.fromkeys([f"robot {i}" for i in range(number)], NAO)
    model = build_model(robots, PhysicsSettings())
    types, affinities = model.geom_contype, model.geom_conaffinity
    solid = np.flatnonzero((types > 0) | (affinities > 0))
    roots = model.body_rootid[model.geom_bodyid[solid]]
    meets = (types[solid, None] & affinities[solid]) != 0
    np.testing.assert_array_equal(meets | meets.T, roots[:, None] != roots)


def test_steps_are_the_same_one_by_one_and_together() -> None:
    states = []
    for calls in ([], [lambda time: None]):
        world = World({"evader": NAO}, PhysicsSettings(tick=0.006))
        world.data.qpos[2] = 0.4
        world.before_step += calls
        assert world.time == 0.0
        for _ in range(5):
            world.advance()
        assert world.time == pytest.approx(0.03)
        states.append(world.data.qpos.copy())
    np.testing.assert_array_equal(*states)


def fallen() -> World:
    """A robot that drops to the floor."""
    world = World({"evader": NAO}, PhysicsSettings(tick=0.006))
    world.data.qpos[2] = 0.34
    world.data.qvel[:] = np.linspace(-0.5, 0.5, world.model.nv)
    mujoco.mj_forward(world.model, world.data)
    return world


@pytest.mark.parametrize("ticks", [1, 3, 20])
def test_sensors_are_those_of_the_last_physics_step(ticks: int) -> None:
    world, reference = fallen(), fallen()
    for _ in range(ticks):
        world.advance()
    mujoco.mj_step(reference.model, reference.data, nstep=3 * ticks)
    found, expected = world, reference.data
    np.testing.assert_array_equal(found.sensordata, expected.sensordata)
    assert np.abs(expected.sensordata).max() > 1.0
    world.advance()
    mujoco.mj_step(reference.model, reference.data, nstep=3)
    np.testing.assert_array_equal(found.data.qpos, expected.qpos)
    np.testing.assert_array_equal(found.sensordata, expected.sensordata)
