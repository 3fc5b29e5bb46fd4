"""Test joint motion generation by damped pseudo-inverse."""

import mujoco
import numpy as np
import pytest

from stepaside.core.errors import ReachError
from stepaside.planning import Direction, Foot, GaitSettings, ManeuverPlanner
from stepaside.robots.description import load_robot
from stepaside.robots.leg_kinematics import BodyReference, LegKinematics

STANCE = BodyReference(
    (0.02, 0.0, 0.268), (0.0, 0.05, 0.0, 0.0), (0.0, -0.05, 0.0, 0.0)
)


def state_of(posture: np.ndarray) -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = load_robot("nao").compile()
    data = mujoco.MjData(model)
    data.qpos[:] = posture
    mujoco.mj_forward(model, data)
    return model, data


def test_walk_is_tracked_within_a_tenth_of_a_millimeter() -> None:
    """One damped step a tick, at the bearing of the circle, 45 degrees."""
    from stepaside.core.poses import Pose
    from stepaside.locomotion.zmp.reference_table import ReferenceTable

    gait = GaitSettings()
    plan = ManeuverPlanner(gait).plan(
        0.8, Direction.BACKWARD, first_foot=Foot.LEFT, standing=True, count=8
    )
    kinematics = LegKinematics(load_robot("nao"), tick=0.004)
    table = ReferenceTable(0.004)
    duration = plan.schedule.duration - 2.0  # without coming to a halt
    table.load(plan, Pose(0.0, -0.05, 0.0), 0.0, duration)
    kinematics.stand(table.at(0.0)[0])
    worst = 0.0
    fastest = 0.0
    before = kinematics.joint_targets
    for tick in range(round(duration / 0.004)):
        reference = table.at(tick * 0.004).body
        targets = kinematics.track(reference)
        fastest = max(fastest, float(np.abs(targets - before).max()) / 0.004)
        before = targets
        if tick % 10 == 0:
            _, data = state_of(kinematics.posture)
            off = [
                data.subtree_com[1] - reference.com,
                data.site("l_sole_center").xpos - reference.left_foot[:3],
                data.site("r_sole_center").xpos - reference.right_foot[:3],
            ]
            worst = max(worst, float(np.abs(off).max()))
    assert worst < 1e-4
    assert 1.0 < fastest < 6.5  # below the speed limit of the pitch joints


def test_height_out_of_reach_is_refused_with_the_height_in_reach() -> None:
    """At 0.28 m the straight legs are too short."""
    kinematics = LegKinematics(load_robot("nao"), tick=0.004)
    with pytest.raises(ReachError, match=r"0\.28 m; it reaches at most 0\.2"):
        kinematics.stand(STANCE._replace(com=(0.02, 0.0, 0.28)))


def test_reference_that_jumps_is_refused_by_name() -> None:
    kinematics = LegKinematics(load_robot("nao"), tick=0.004)
    kinematics.stand(STANCE)
    jumped = STANCE._replace(left_foot=(0.6, 0.05, 0.0, 0.0))
    with pytest.raises(ReachError, match="cannot follow: left foot x"):
        kinematics.track(jumped)
