"""Test the laws of one step of the legs: rows, limits and refusals."""

from functools import cache

import mujoco
import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.core.rotations import rotation
from stepaside.robots.com_heights import search_heights
from stepaside.robots.description import load_robot
from stepaside.robots.leg_kinematics import ROWS, BodyReference, LegKinematics

NAO = load_robot("nao")
TICK = 0.004
STANCE = BodyReference(
    (0.015, 0.005, 0.26), (0.01, 0.05, 0.0, 0.1), (-0.01, -0.05, 0.0, -0.05)
)


@cache
def stood() -> LegKinematics:
    return LegKinematics(NAO, tick=TICK)


def state(kinematics: LegKinematics) -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = NAO.compile()
    data = mujoco.MjData(model)
    data.qpos[:] = kinematics.posture
    mujoco.mj_forward(model, data)
    return model, data


def reached(kinematics: LegKinematics) -> Array:
    """The 17 task coordinates by MuJoCo; rotations as vectors."""
    _, data = state(kinematics)
    rows: list[float] = []
    for name in (NAO.left_foot, NAO.right_foot):
        rows += data.site(name).xpos.tolist()
        quaternion, turn = np.zeros(4), np.zeros(3)
        mujoco.mju_mat2Quat(quaternion, data.site(name).xmat)
        mujoco.mju_quat2Vel(turn, quaternion, 1.0)
        rows += turn.tolist()
    rows += data.subtree_com[1].tolist()
    up = data.body("torso").xmat.reshape(3, 3)[:, 2]
    return np.array([*rows, -up[1], up[0]])


def asked(reference: BodyReference) -> Array:
    rows: list[float] = []
    for foot, tilt in (
        (reference.left_foot, reference.left_tilt),
        (reference.right_foot, reference.right_tilt),
    ):
        quaternion, turn = np.zeros(4), np.zeros(3)
        frame = rotation(tilt[0], tilt[1], foot[3])
        mujoco.mju_mat2Quat(quaternion, frame.reshape(-1))
        mujoco.mju_quat2Vel(turn, quaternion, 1.0)
        rows += [*foot[:3], *turn.tolist()]
    return np.array([*rows, *reference.com, 0.0, 0.0])


@pytest.mark.parametrize("x", [-0.02, 0.03])
@pytest.mark.parametrize("y", [-0.03, 0.02])
@pytest.mark.parametrize("z", [0.24, 0.26])
def test_a_stance_with_turned_feet_is_taken_in_every_row(
    x: float, y: float, z: float
) -> None:
    stance = STANCE._replace(com=(x, y, z))
    kinematics = stood()
    kinematics.stand(stance)
    np.testing.assert_allclose(reached(kinematics), asked(stance), atol=1e-4)


def moved(row: int, size: float) -> BodyReference:
    """The stance with one of its numbers changed."""
    left, right = list(STANCE.left_foot), list(STANCE.right_foot)
    com, tilts = list(STANCE.com), [[0.0, 0.0], [0.0, 0.0]]
    if row >= 12:
        com[row - 12] += size
    else:
        foot, number = divmod(row, 6)
        if number in (3, 4):
            tilts[foot][number - 3] += size
        else:
            (left, right)[foot][number - 2 * (number > 3)] += size
    return BodyReference(
        (com[0], com[1], com[2]),
        (left[0], left[1], left[2], left[3]),
        (right[0], right[1], right[2], right[3]),
        (tilts[0][0], tilts[0][1]),
        (tilts[1][0], tilts[1][1]),
    )


@pytest.mark.parametrize("row", range(15), ids=ROWS[:15])
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_one_step_closes_a_small_gap_in_every_row(
    row: int, sign: float
) -> None:
    """Newton's step leaves what is quadratic: the Jacobian is right."""
    kinematics = stood()
    kinematics.stand(STANCE)
    kinematics.track(STANCE)
    reference = moved(row, sign * 3e-4)
    gap = np.abs(asked(reference) - reached(kinematics)).max()
    assert gap == pytest.approx(3e-4, rel=0.2)
    kinematics.track(reference)
    gap = np.abs(asked(reference) - reached(kinematics)).max()
    assert gap < 6e-6


def test_no_joint_moves_faster_than_its_motor() -> None:
    kinematics = stood()
    before = kinematics.stand(STANCE)
    x, y, z = STANCE.com
    after = kinematics.track(STANCE._replace(com=(x, y + 0.03, z - 0.04)))
    limits = [NAO.speed_limits[n] * TICK for n in kinematics.joint_names]
    legs = [name in NAO.legs for name in kinematics.joint_names]
    share = np.abs(after - before) / limits
    assert share.max() == pytest.approx(1.0)
    assert (share[legs] > 1.0 - 1e-9).sum() > 5
    assert share[np.logical_not(legs)].max() == 0.0
    moves = (after - before)[legs]
    assert moves.min() < -0.01 and moves.max() > 0.01


def limited(kinematics: LegKinematics, joint: str) -> list[float]:
    """How far a joint is from either end of its range; all keep to it."""
    model, data = state(kinematics)
    ends = {}
    for name in NAO.legs:
        low, high = NAO.working_limits.get(name, model.joint(name).range)
        angle = float(data.joint(name).qpos[0])
        ends[name] = [angle - low, high - angle]
        assert min(ends[name]) > -1e-9, name
    return ends[joint]


def test_a_com_out_of_reach_leaves_a_residual_and_lifts_no_heel() -> None:
    """The first knee at its limit stops the rise; feet stay where they are."""
    kinematics = stood()
    kinematics.stand(STANCE)
    request = STANCE._replace(com=(*STANCE.com[:2], 0.28))
    for _ in range(100):
        kinematics.track(request)
    knees = [limited(kinematics, f"{side}KneePitch")[0] for side in "LR"]
    assert min(knees) == pytest.approx(0.0)
    assert max(knees) < 0.05
    off = np.abs(asked(request) - reached(kinematics))
    assert 1e-3 < off.max() < 3e-3
    turned = off[[3, 4, 5, 9, 10, 11]]
    assert turned.max() < 1e-3


def test_joint_limits_hold_in_every_stance() -> None:
    """Room to a limit in one posture is none in the next."""
    kinematics = LegKinematics(NAO, tick=TICK)
    x, y, _ = STANCE.com
    _, high = kinematics.com_heights(STANCE)
    kinematics.stand(STANCE)
    for _ in range(5):
        kinematics.track(STANCE)
    kinematics.stand(STANCE._replace(com=(x, y, high - 1e-3)))
    for z in np.linspace(high - 1e-3, high + 1e-3, 100).tolist():
        kinematics.track(STANCE._replace(com=(x, y, z)))
        limited(kinematics, "LKneePitch")


def test_the_range_of_heights_moves_nothing() -> None:
    kinematics = LegKinematics(NAO, tick=TICK)
    before = kinematics.stand(STANCE)
    lowest, highest = kinematics.com_heights(STANCE)
    assert lowest < STANCE.com[2] < highest
    np.testing.assert_array_equal(kinematics.joint_targets, before)
    np.testing.assert_allclose(kinematics.track(STANCE), before, atol=1e-5)


def test_the_range_of_heights_is_found_within_a_quarter_of_a_millimetre() -> (
    None
):
    for low, high in ((0.2, 0.3), (0.1, 0.2), (0.05, 0.24)):
        found = search_heights(lambda z, a=low, b=high: a < z < b, 0.25)  # type: ignore[misc]
        assert found == pytest.approx((low, high), abs=2.5e-4)
        assert low < found[0] and found[1] < high
    assert search_heights(lambda z: False, 0.25) == (0.0, 0.0)


@pytest.mark.parametrize("yaw", [0.0, 0.7, -2.0])
def test_foot_tilts_are_about_the_heading_of_the_foot(yaw: float) -> None:
    """However the feet are turned in odometry."""
    c, s = np.cos(yaw), np.sin(yaw)
    stance = BodyReference(
        (0.01 * c, 0.01 * s, 0.26),
        (-0.05 * s, 0.05 * c, 0.0, yaw),
        (0.05 * s, -0.05 * c, 0.0, yaw),
    )
    kinematics = stood()
    kinematics.stand(stance)
    kinematics.track(stance)
    leaning = stance._replace(left_tilt=(3e-4, -5e-4), right_tilt=(2e-4, 4e-4))
    kinematics.track(leaning)
    np.testing.assert_allclose(reached(kinematics), asked(leaning), atol=2e-6)
