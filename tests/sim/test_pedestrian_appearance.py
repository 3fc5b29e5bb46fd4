"""Test the body of a person: size, gait and role in a duel."""

from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Array, Pose
from stepaside.games.floor_world import FloorPerson
from stepaside.games.player import FloorPlayer
from stepaside.sim.person_body import (
    PARTS,
    STEP,
    PersonBody,
    add_person,
    mocap_indices,
    set_person_pose,
)
from stepaside.sim.person_motion import PersonMotion
from stepaside.sim.person_settings import PersonSettings
from stepaside.sim.push import Push

TICK = 0.05


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


def test_a_person_cannot_be_pushed() -> None:
    model, data = figure()
    motion = PersonMotion(PersonSettings("steer"), STANDING, (4.0, 2.0))
    player, _ = walker(world_of(model, data), motion, (4.0, 2.0))
    with pytest.raises(ConfigurationError, match="a robot .* got her"):
        player.push(Push(1.0, 0.0, 0.0))
