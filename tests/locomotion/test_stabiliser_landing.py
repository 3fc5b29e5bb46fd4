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
from stepaside.robots.forward_kinematics import MeasuredPosture
from synthetic_state import (
    ETA,
    GAINS,
    GAIT,
    SUPPORT,
    TICK,
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


def posture() -> MeasuredPosture:
    """Feet abreast, while the step of these tests went 4 cm ahead."""
    feet = np.array([[0.0, 0.1, 0.0], [0.0, 0.0, 0.0]])
    return MeasuredPosture(np.zeros(3), feet, np.array([np.eye(3)] * 2))


def test_steps_that_were_moved_are_counted_and_not_learned_from() -> None:
    feedback, fake = stabiliser()
    land(feedback)  # nothing was measured yet
    fake.posture = posture()
    feedback.step_shift = (0.0008, 0.0008)
    land(feedback)
    assert feedback.adapted == 1
    same(feedback.stride.aim[Foot.LEFT], 0.0)
    feedback.step_shift = (0.0006, 0.0006)
    land(feedback)
    assert feedback.adapted == 1
    same(feedback.stride.aim[Foot.LEFT], (0.3 * 0.04, 0.0, 0.0))
    same(feedback.stride.aim[Foot.RIGHT], 0.0)


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


def test_a_correction_inside_the_sole_is_left_alone() -> None:
    feedback, plan, state = fitted((0.05, -0.15))
    assert state == CenterState((0.0, 0.03), (0.05, -0.15))
    low, high = zmp_box(Foot.LEFT, GAIT, GAINS.edge)
    assert (low < plan.correction).all() and (plan.correction < high).all()
    assert feedback.dcm_shift == ZERO
    same(plan.start_velocity, (0.05, -0.15))


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


def test_joints_are_corrected_with_their_delay() -> None:
    feedback, _ = stabiliser(delay=3 * TICK)
    targets = np.array([0.1])
    added = [
        feedback.joints.update(targets - 0.001, targets)[0] - 0.1
        for _ in range(7)
    ]
    gain = 10.0 * TICK * 0.001
    same(added[:5], 0.0)
    same(added[5:], (gain, gain * (2.0 - TICK)))
    for _ in range(3000):
        added.append(feedback.joints.update(targets - 1.0, targets)[0] - 0.1)
    assert added[-1] == pytest.approx(0.03)
