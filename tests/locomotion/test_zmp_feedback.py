"""Test the rules for the ZMP shift."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.locomotion.control_settings import StabiliserSettings
from stepaside.locomotion.locomotion import CurrentStep, resting_step
from stepaside.locomotion.zmp.current_step import zmp_box
from stepaside.locomotion.zmp.mpc import IntrinsicallyStableMpc
from stepaside.planning import Direction, Foot, ManeuverPlanner
from synthetic_state import GAIT, SUPPORT, TICK, stabiliser

EDGE = 0.002
RULE = stabiliser()[0]


def walking(swing: Foot = Foot.LEFT) -> CurrentStep:
    plan = ManeuverPlanner(GAIT).plan(
        0.0, Direction.FORWARD, first_foot=swing, standing=True
    )
    return CurrentStep(SUPPORT, swing, SUPPORT, 0.2, 0.5, True, plan, 1.25)


class FakeMpc:
    """MPC that records its calls and returns a given velocity."""

    def __init__(self) -> None:
        self.asked: list[tuple[Any, ...]] = []

    def solve(self, plan: Any, passed: float, dcm: Array, zmp: Array) -> Any:
        """Return the given velocity."""
        self.asked.append((plan, passed, *dcm.tolist(), *zmp.tolist()))
        self.answer = SimpleNamespace(velocity=(0.5, -0.25))
        return self.answer


def test_a_small_shift_is_answered_by_its_multiple() -> None:
    """In any direction, and beyond it: only then does the DCM return."""
    for dcm in ((0.003, 0.0), (-0.002, 0.004), (0.0, -0.005)):
        p = RULE.zmp_response(walking(), dcm, (0.3, 0.3))
        assert p == pytest.approx((4.0 * dcm[0], 4.0 * dcm[1]))


@pytest.mark.parametrize("swing", Foot)
def test_the_sole_that_stands_limits_it(swing: Foot) -> None:
    made = walking(swing)
    low, high = zmp_box(swing, GAIT, EDGE)
    for far, corner in ((1.0, high), (-1.0, low)):
        p = RULE.zmp_response(made, made.from_support(far, far), (0.0, 0.0))
        assert made.to_support(*p) == pytest.approx(corner)


def test_the_mpc_is_solved_in_the_plan_frame() -> None:
    fake: Any = FakeMpc()
    rule = stabiliser()[0]
    rule.mpc = fake
    made = walking()
    dcm, zmp = made.from_support(0.01, 0.02), made.from_support(0.03, 0.04)
    p = rule.zmp_response(made, dcm, zmp)
    (plan, passed, *state) = fake.asked[0]
    assert plan is made.plan and passed == 1.25
    np.testing.assert_allclose(state, [0.01, 0.02, 0.03, 0.04])
    vx, vy = made.from_support(0.5, -0.25)
    assert p == pytest.approx((zmp[0] + TICK * vx, zmp[1] + TICK * vy))
    assert rule.solved is fake.answer


def test_the_mpc_method_asks_a_solver_while_walking() -> None:
    pytest.importorskip("daqp")
    gains = StabiliserSettings(feedback=3.0, edge=0.005)
    rule, _ = stabiliser("mpc", gains)
    assert isinstance(rule.mpc, IntrinsicallyStableMpc)
    made = walking()
    rest = resting_step(SUPPORT, Foot.LEFT)
    assert rule.zmp_response(rest, (0.001, 0.0), (0.0, 0.0)) == pytest.approx(
        (0.003, 0.0)
    )
    dcm = made.from_support(0.005, 0.0)
    p = rule.zmp_response(made, dcm, (0.0, 0.0))
    assert made.to_support(*p)[0] > 0.0
    assert rule.solved is not None and rule.solved.feasible
