"""Test servos on two hinges: limits, feedforward, delay, backlash."""

from typing import Any

import mujoco
import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.sim.body_settings import BodySettings
from stepaside.sim.servos import Servos
from stored_values import DATA

KP, KV, STALL = 20.0, 0.5, 1.5
STEP, CYCLE = 0.002, 0.012
# Offset of the command that cancels damping, by the change in one cycle.
LEAD = KV / np.array([KP, 2 * KP]) / CYCLE
SPEEDS = np.array([5.0, 2.0])
# Nothing here has the same number as qpos, as speed and as actuator.
MODEL = (DATA / "servos.xml").read_text("utf-8")
MODEL = MODEL.format(step=STEP, kp=KP, twice=2 * KP, kv=KV, stall=STALL)
ACTUATORS = np.array([1, 2])
QPOS, DOFS = slice(8, 10), slice(7, 9)


def bench() -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = mujoco.MjModel.from_xml_string(MODEL)
    data = mujoco.MjData(model)
    data.ctrl[0] = 0.123  # another robot's
    return model, data


def ideal() -> tuple[Servos, mujoco.MjModel, mujoco.MjData]:
    model, data = bench()
    servos = Servos(model, data, ACTUATORS, SPEEDS, CYCLE)
    return servos, model, data


def realistic(
    play: tuple[float, float] = (0.0, 0.0), **effects: Any
) -> tuple[Servos, mujoco.MjModel, mujoco.MjData]:
    model, data = bench()
    body = BodySettings(**effects)
    servos = Servos(
        model, data, ACTUATORS, SPEEDS, CYCLE, body, np.array(play)
    )
    servos.reset(np.zeros(2))
    return servos, model, data


def torques(model: mujoco.MjModel, data: mujoco.MjData) -> Array:
    """Torque of the two motors in the present state, in [N m]."""
    mujoco.mj_forward(model, data)
    found: Array = data.actuator_force[ACTUATORS].copy()
    return found


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_target_moves_no_faster_than_the_joint_can(side: float) -> None:
    """Step after step by speed times cycle, then it stays."""
    servos, _, data = ideal()
    servos.reset(np.zeros(2))
    wanted = side * np.array([0.1, 0.06])
    before = np.zeros(2)
    for count in range(1, 4):
        servos.write(wanted)
        target = np.minimum(np.abs(wanted), count * SPEEDS * CYCLE) * side
        expected = target + LEAD * (target - before)
        np.testing.assert_allclose(data.ctrl[1:], expected, atol=1e-12)
        before = target
    servos.write(wanted)
    np.testing.assert_allclose(data.ctrl[1:], wanted, atol=1e-12)


def test_a_joint_at_its_target_speed_needs_no_torque() -> None:
    """At the target and at its speed, damping gives no torque."""
    servos, model, data = ideal()
    servos.reset(np.zeros(2))
    targets = np.array([0.01, -0.02])
    servos.write(targets)
    data.qpos[QPOS], data.qvel[DOFS] = targets, targets / CYCLE
    np.testing.assert_allclose(torques(model, data), 0.0, atol=1e-12)
    data.qvel[DOFS] = 0.0
    np.testing.assert_allclose(torques(model, data), KV * targets / CYCLE)


def test_realistic_servos_ramp_over_one_cycle() -> None:
    servos, _, data = realistic(delay_cycles=0, efficiency=0.9)
    wanted = np.array([0.012, -0.006])
    servos.write(wanted)
    lead = LEAD * wanted
    for step in range(1, 9):
        servos.before_step(0.0)
        share = min(step / 6.0, 1.0)
        np.testing.assert_allclose(data.ctrl[1:], share * wanted + lead)
    assert data.ctrl[0] == 0.123
    servos.write(wanted)
    for _ in range(2):
        servos.before_step(0.0)
        np.testing.assert_allclose(data.ctrl[1:], wanted)


@pytest.mark.parametrize("delay", [0, 1, 3])
def test_targets_take_effect_in_order_after_the_delay(delay: int) -> None:
    servos, _, data = realistic(delay_cycles=delay, efficiency=0.9)
    sent = [np.array([0.001 * i, -0.002 * i]) for i in range(1, 8)]
    due = [np.zeros(2)] * (delay + 1) + sent
    for before, target, request in zip(due, due[1:], sent, strict=False):
        servos.write(request)
        for _ in range(6):
            servos.before_step(0.0)
        expected = target + LEAD * (target - before)
        np.testing.assert_allclose(data.ctrl[1:], expected, atol=1e-12)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_backlash_subtracts_half_its_width_from_the_error(side: float) -> None:
    """Within it no torque, beyond it the rest; a joint without has none."""
    servos, _, data = realistic(play=(0.04, 0.0), efficiency=0.9)
    data.qpos[QPOS] = [0.5, -0.5]
    for off, seen in ((0.019, 0.0), (0.021, 0.001), (0.05, 0.03)):
        servos.reset(data.qpos[QPOS] + side * off)
        servos.before_step(0.0)
        error = data.ctrl[1:] - data.qpos[QPOS]
        np.testing.assert_allclose(error, side * np.array([seen, off]))


def limits_at(share: float, **effects: Any) -> tuple[Array, Array]:
    """Return torque limits at a fraction of the no-load speeds."""
    servos, model, data = realistic(**effects)
    data.qvel[DOFS] = share * SPEEDS
    servos.before_step(0.0)
    low, high = model.actuator_forcerange[ACTUATORS].T
    np.testing.assert_array_equal(model.actuator_forcerange[0], [-9.0, 9.0])
    return low / STALL, high / STALL


@pytest.mark.parametrize(
    ("share", "low", "high"),
    [
        (0.0, -1.0, 1.0),
        (0.25, -1.0, 0.75),
        (0.5, -1.0, 0.5),
        (1.0, -1.0, 0.0),
        (1.5, -1.0, 0.0),
        (-0.25, -0.75, 1.0),
        (-0.5, -0.5, 1.0),
        (-1.0, 0.0, 1.0),
        (-1.5, 0.0, 1.0),
    ],
)
def test_the_torque_limit_falls_in_the_direction_of_motion(
    share: float, low: float, high: float
) -> None:
    """A motor driven backward brakes with the stall torque at most."""
    found = limits_at(share, torque_speed=True)
    np.testing.assert_allclose(found[0], low, atol=1e-12)
    np.testing.assert_allclose(found[1], high, atol=1e-12)
