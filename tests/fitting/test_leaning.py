"""Test a torso that leans over the foot that stands."""

from dataclasses import replace
from math import atan2

import mujoco
import numpy as np
import pytest

from stepaside.core.poses import Pose
from stepaside.fitting import derivation as leaning
from stepaside.fitting.derivation import LEAN_CANDIDATES, least_lean
from stepaside.fitting.gait_feasibility import JointLoads
from stepaside.fitting.robot_verification import WalkTrialResult
from stepaside.games.player_settings import settings_from_description
from stepaside.robots.description import RobotDescription, load_robot
from stepaside.robots.leg_kinematics import BodyReference, LegKinematics

NAO = load_robot("nao")
TICK = 0.004
LEAN = 0.1
HEADING = 0.4


def standing(sway: float, lift: float = 0.0) -> BodyReference:
    """NAO that heads somewhere, the CoM to one side, a foot lifted."""
    c, s = np.cos(HEADING), np.sin(HEADING)
    rows = np.array([(0.02, sway), (0.0, 0.05), (0.0, -0.05)])
    com, left, right = (rows @ np.array([[c, s], [-s, c]])).tolist()
    return BodyReference(
        (com[0], com[1], 0.26),
        (left[0], left[1], 0.0, HEADING),
        (right[0], right[1], lift, HEADING),
    )


def leans(robot: RobotDescription, lean: float) -> RobotDescription:
    """The same robot with a torso that leans."""
    return replace(robot, lean=lean)


def test_a_torso_leans_where_the_com_is() -> None:
    """To the left over the left foot: that is a negative roll."""
    assert standing(0.0).roll(LEAN) == pytest.approx(0.0, abs=1e-12)
    assert standing(0.05).roll(LEAN) == pytest.approx(-LEAN)
    assert standing(-0.025).roll(LEAN) == pytest.approx(0.5 * LEAN)
    assert standing(0.05).roll(0.0) == 0.0


def test_a_lean_is_that_of_the_frame_of_the_feet() -> None:
    """Wherever they stand and head, and whatever their own headings are."""
    random = np.random.default_rng(3)
    for _ in range(10):
        x, y, yaw, ahead, sway = random.uniform(-1.0, 1.0, 5).tolist()
        middle, half = Pose(x, y, 3.0 * yaw), 0.05
        com = middle.compose(Pose(ahead, sway * half, 0.0))
        left, right = (
            middle.compose(Pose(0.3 * ahead * side, side * half, side * 0.2))
            for side in (1.0, -1.0)
        )
        asked = BodyReference(
            (com.x, com.y, 0.26),
            (left.x, left.y, 0.0, left.theta),
            (right.x, right.y, 0.01, right.theta),
        )
        assert asked.roll(LEAN) == pytest.approx(-LEAN * sway)


@pytest.mark.parametrize("sway", [0.03, -0.03])
def test_legs_reach_the_same_under_a_torso_that_leans(sway: float) -> None:
    """By MuJoCo: feet and CoM are where they are asked, the torso rolled."""
    robot, asked = leans(NAO, LEAN), standing(sway, 0.01)
    legs = LegKinematics(robot, tick=TICK)
    legs.stand(asked)
    model = robot.compile()
    data = mujoco.MjData(model)
    data.qpos[:] = legs.posture
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    np.testing.assert_allclose(data.subtree_com[0], asked.com, atol=2e-4)
    for name, foot in (
        (robot.left_foot, asked.left_foot),
        (robot.right_foot, asked.right_foot),
    ):
        site = data.site(name)
        np.testing.assert_allclose(site.xpos, foot[:3], atol=2e-4)
        assert site.xmat[8] == pytest.approx(1.0, abs=1e-6)
    torso = data.body(robot.torso).xmat
    roll = atan2(torso[7], torso[8])
    assert roll == pytest.approx(asked.roll(LEAN), abs=1e-9)
    assert roll * sway < 0.0


@pytest.mark.parametrize(
    ("shares", "lean"),
    [
        ((0.9, 0.8), 0.06),
        ((1.0, 0.94, 0.84), 0.12),
        ((1.3, 1.2, 1.1, 1.0), 0.24),
        ((1.0, 1.0, 1.01, 1.02), 0.06),
    ],
)
def test_the_least_sufficient_lean_is_chosen(
    shares: tuple[float, ...], lean: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By what a step asks for at each lean that is tried."""

    def borne(robot: RobotDescription, *_: object) -> JointLoads:
        return JointLoads(
            0.5, "hip", shares[LEAN_CANDIDATES.index(robot.lean)]
        )

    monkeypatch.setattr(leaning, "step_loads", borne)
    found, kept = least_lean(NAO, settings_from_description(NAO).gait, {})
    assert found == lean
    assert kept.most == shares[LEAN_CANDIDATES.index(lean)]


def test_a_walk_that_leans_on_purpose_may_tilt_by_that_too() -> None:
    def unsteadiness(tilt: float, lean: float) -> float:
        nothing = (0.0, 1.0, None)
        return WalkTrialResult(
            *("forward", True, "walked", True, 1.0, tilt), *nothing, lean
        ).unsteadiness

    assert unsteadiness(8.0, 0.0) == pytest.approx(1.0)
    assert unsteadiness(8.0, 8.0) == pytest.approx(0.5)
