"""Test pushes of one free body: time, direction and impulse."""

from math import cos, pi, sin

import mujoco
import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.sim.push import Push, PushApplier, pushes_by_robot

STEP = 0.002
MODEL = f"""
<mujoco><option timestep="{STEP}" gravity="0 0 0"/><worldbody>
<body name="other"><freejoint/><geom size="0.1" mass="1"/></body>
<body name="torso" pos="5 0 0"><freejoint/><geom size="0.1" mass="2"/></body>
</worldbody></mujoco>
"""


class Bench:
    """One free body with pushes."""

    def __init__(self, quaternion: Array, *pushes: Push) -> None:
        """Turn the body, and take the pushes."""
        self.model = mujoco.MjModel.from_xml_string(MODEL)
        self.data = mujoco.MjData(self.model)
        self.data.qpos[10:14] = quaternion
        mujoco.mj_forward(self.model, self.data)
        self.pusher = PushApplier(self.model, self.data, 2)
        for push in pushes:
            self.pusher.add(push)

    def forces(self, count: int) -> Array:
        """Force in every step. Shape (count, 3)."""
        found = []
        for step in range(count):
            self.pusher.before_step(step * STEP)
            found.append(self.data.xfrc_applied[2, :3].copy())
            np.testing.assert_array_equal(self.data.xfrc_applied[1], 0.0)
            np.testing.assert_array_equal(self.data.xfrc_applied[2, 3:], 0.0)
            mujoco.mj_step(self.model, self.data)
        return np.array(found)


def turned(heading: float, pitch: float = 0.0) -> Array:
    """Quaternion of a body that heads somewhere and leans forward."""
    yaw = np.array([cos(heading / 2), 0.0, 0.0, sin(heading / 2)])
    lean = np.array([cos(pitch / 2), 0.0, sin(pitch / 2), 0.0])
    out = np.zeros(4)
    mujoco.mju_mulQuat(out, yaw, lean)
    return out


@pytest.mark.parametrize("heading", [0.0, 0.7, -2.5])
@pytest.mark.parametrize("direction", [0.0, pi / 2, -0.4, pi])
@pytest.mark.parametrize("pitch", [0.0, 0.6])
def test_a_push_is_relative_to_the_heading(
    heading: float, direction: float, pitch: float
) -> None:
    bench = Bench(turned(heading, pitch), Push(1.5, 0.0, direction))
    force = bench.forces(1)[0]
    angle = heading + direction
    np.testing.assert_allclose(
        force, [15.0 * cos(angle), 15.0 * sin(angle), 0.0], atol=1e-9
    )


def test_a_push_starts_and_ends_on_time() -> None:
    bench = Bench(turned(0.0), Push(1.2, 0.02, 0.0, 0.04))
    pushed = bench.forces(60)[:, 0]
    np.testing.assert_allclose(pushed[10:30], 30.0)
    np.testing.assert_array_equal(pushed[:10], 0.0)
    np.testing.assert_array_equal(pushed[30:], 0.0)


def test_the_impulse_changes_the_momentum() -> None:
    bench = Bench(turned(0.5), Push(0.8, 0.01, 1.0))
    bench.forces(100)
    expected = 0.8 * np.array([cos(1.5), sin(1.5)])
    np.testing.assert_allclose(bench.pusher.impulse, expected)
    np.testing.assert_allclose(2.0 * bench.data.qvel[6:8], expected)


def test_pushes_without_a_name_are_of_the_last_robot() -> None:
    push, other = Push(1.0, 0.0, 0.0), Push(1.0, 0.0, 0.0, player="a")
    found = pushes_by_robot([push, other], ["a", "b"])
    assert found == {"a": (other,), "b": (push,)}
