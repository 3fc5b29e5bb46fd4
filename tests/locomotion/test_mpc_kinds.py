"""Test the MPC in every kind of plan: convergence and ZMP constraints."""

from math import exp

import numpy as np
import pytest

from reference_plans import KINDS, plan_of
from stepaside.core.poses import Array
from stepaside.locomotion.control_settings import MpcSettings
from stepaside.locomotion.zmp.mpc import IntrinsicallyStableMpc
from stepaside.planning import GaitSettings, ManeuverPlan

GAIT = GaitSettings()
TICK = 0.004  # [s]
EDGE = 0.002  # [m]


def follow(
    plan: ManeuverPlan, dcm: Array, duration: float
) -> tuple[Array, Array, bool]:
    """Ideal pendulum under the MPC.

    Returns:
        DCM and ZMP less the plan's after each tick, in [m], shape (n, 2)
        each, and whether every tick was feasible.
    """
    mpc = IntrinsicallyStableMpc(GAIT, MpcSettings(), edge=EDGE)
    zmp, feasible = np.zeros(2), True
    shifts, zmps = [], []
    for k in range(round(duration / TICK)):
        answer = mpc.solve(plan, k * TICK, dcm, zmp)
        feasible &= answer.feasible
        zmp = zmp + TICK * np.array(answer.velocity)
        dcm = zmp + exp(GAIT.eta * TICK) * (dcm - zmp)
        shifts.append(dcm)
        zmps.append(zmp)
    return np.array(shifts), np.array(zmps), feasible


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("size", [1e-4, 5e-3])
@pytest.mark.parametrize("angle", [0.0, 1.6, 3.1, -1.6])
def test_a_shift_is_back_within_a_second(
    kind: str, size: float, angle: float
) -> None:
    """Feasible at every tick; the starting and halting feet are known."""
    plan = plan_of(kind)
    push = size * np.array([np.cos(angle), np.sin(angle)])
    shifts, _, feasible = follow(plan, push, 1.0)
    assert feasible
    assert np.hypot(*shifts[-1]) < 0.01 * size
    assert np.hypot(*shifts.T).max() < 1.5 * size


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_the_zmp_never_leaves_the_feet_however_hard_it_is_used(
    kind: str,
) -> None:
    """Also where a foot lands or leaves, and when all is lost."""
    plan, size, lost = plan_of(kind), 0.03, 0
    times = TICK * np.arange(1, 301)
    least = np.inf
    for angle in np.linspace(0.0, 5.5, 8):
        push = size * np.array([np.cos(angle), np.sin(angle)])
        shifts, zmps, feasible = follow(plan, push, 1.2)
        zmps += plan.sample(times).zmp
        for phase in plan.support():
            now = (times >= phase.start) & (times <= phase.end)
            room = phase.offsets - zmps[now] @ phase.normals.T
            least = min(least, float(room.min(initial=np.inf)))
        lost += not feasible
        assert np.hypot(*shifts[-1]) < 0.1 * size or not feasible
    assert least > EDGE - 1e-4  # the correction bends between two samples
    if kind != "start":
        assert least < EDGE + 1e-4 and lost == 1
