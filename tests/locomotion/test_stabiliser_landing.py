"""Test the state that the stabiliser passes to the next step."""

from math import pi

import numpy as np
import pytest

from stepaside.core.poses import Pose
from stepaside.locomotion.zmp.current_step import zmp_box
from stepaside.locomotion.zmp.stabiliser import Stabiliser
from stepaside.planning import (
    CenterState,
    Direction,
    Foot,
    ManeuverPlan,
    ManeuverPlanner,
)
from synthetic_state import (
    ETA,
    GAINS,
    GAIT,
    SUPPORT,
    ZERO,
    same,
    stabiliser,
    step,
)


def land(
    feedback: Stabiliser,
) -> tuple[Pose, tuple[float, float], tuple[float, float]]:
    landed = Pose(2.0, 3.0, 0.5 * pi)
    return feedback.land(landed, (0.1, 0.2), (0.3, 0.4), step())


def test_a_step_hands_its_shifts_to_the_next_plan() -> None:
    """In the frame of the foot that landed, here a quarter turn."""
    feedback, _ = stabiliser("closed-form")
    feedback.step_shift = (0.01, 0.02)
    feedback.com_shift, feedback.dcm_shift = (0.03, 0.05), (0.04, 0.08)
    feedback.error, feedback.com_error = (9.0, 9.0), (9.0, 9.0)
    landed, position, velocity = land(feedback)
    same(landed, (2.01, 3.02, 0.5 * pi))
    # Shift of the CoM less that of the foot: (0.02, 0.03) in odometry.
    same(position, (0.1 + 0.03, 0.2 - 0.02))
    same(velocity, (0.3 + ETA * 0.03, 0.4 - ETA * 0.01))
    assert feedback.com_shift == feedback.dcm_shift == ZERO
    assert feedback.step_shift == ZERO


@pytest.mark.parametrize("method", ["measured", "mpc"])
def test_a_measured_method_hands_over_errors_too(method: str) -> None:
    if method == "mpc":
        pytest.importorskip("daqp")
    feedback, _ = stabiliser(method)
    feedback.com_shift, feedback.dcm_shift = (0.01, 0.0), (0.02, 0.0)
    feedback.com_error, feedback.error = (0.03, 0.01), (0.06, 0.03)
    _, position, velocity = land(feedback)
    same(position, (0.1 + 0.01, 0.2 - 0.04))
    same(velocity, (0.3 + ETA * 0.02, 0.4 - ETA * 0.04))


def fitted(
    velocity: tuple[float, float], foot: Foot = Foot.LEFT
) -> tuple[Stabiliser, ManeuverPlan, CenterState]:
    planner = ManeuverPlanner(GAIT)

    def plan_from(state: CenterState) -> ManeuverPlan:
        return planner.plan(
            0.3, Direction.FORWARD, first_foot=foot, state=state
        )

    feedback, _ = stabiliser()
    side = foot.value
    calm = CenterState((0.0, side * 0.03), velocity)
    plan, state = feedback.fit(plan_from, calm, SUPPORT)
    return feedback, plan, state


@pytest.mark.parametrize("foot", Foot)
@pytest.mark.parametrize("velocity", [(0.9, 0.0), (-0.9, 0.9), (0.1, -0.9)])
def test_a_correction_stays_in_the_sole_and_the_rest_is_a_shift(
    velocity: tuple[float, float], foot: Foot
) -> None:
    """Plan and shift together still have the DCM that was measured."""
    feedback, plan, state = fitted(velocity, foot)
    low, high = zmp_box(foot, GAIT, GAINS.edge)
    assert (plan.correction > np.array(low) - 1e-9).all()
    assert (plan.correction < np.array(high) + 1e-9).all()
    assert feedback.dcm_shift != ZERO
    x, y = step().to_support(*feedback.dcm_shift)
    same(state.position, (0.0, foot.value * 0.03))
    together = np.array(state.velocity) / ETA + (x, y)
    same(together, np.array(velocity) / ETA)
