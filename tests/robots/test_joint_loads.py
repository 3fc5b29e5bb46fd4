"""Test what leg joints bear, against MuJoCo and by laws."""

from math import cos, sin

import mujoco
import numpy as np

from stepaside.core.poses import Array
from stepaside.locomotion.zmp.open_loop import LoadFeedforward
from stepaside.planning import GaitSettings
from stepaside.robots.description import load_robot
from stepaside.robots.joint_loads import LegLoads
from stepaside.robots.leg_kinematics import BodyReference, LegKinematics
from stepaside.robots.tree_cache import load_tree
from stepaside.robots.tree_compiler import coupled_joints

NAO = load_robot("nao")
GAIT = GaitSettings()
TICK = 0.004
AHEAD = GAIT.zmp_forward


def standing(sway: float = 0.0, lift: float = 0.0) -> BodyReference:
    """NAO over its feet, the CoM to one side, the right foot lifted."""
    return BodyReference(
        (AHEAD + 0.003, sway, GAIT.com_height),
        (0.0, 0.05, 0.0, 0.1),
        (-0.03, -0.05, lift, 0.04),
    )


STILL = BodyReference(
    (AHEAD, 0.0, 0.26), (0.0, 0.05, 0.0, 0.0), (0.0, -0.05, 0.0, 0.0)
)


def loads_of(reference: BodyReference) -> tuple[LegKinematics, LegLoads]:
    """Joint motion that stands, and what it bears."""
    kinematics = LegKinematics(NAO, tick=TICK)
    kinematics.stand(reference)
    return kinematics, LegLoads(kinematics, zmp_forward=AHEAD, tick=TICK)


def by_mujoco(
    postures: list[Array], reference: BodyReference, share: float
) -> Array:
    """Return torques by inverse dynamics, of links that are point masses.

    Args:
        postures: Posture a tick before, the one in question, a tick after.
        reference: Its reference.
        share: Share of the force at the anchor of the left foot.
    """
    model = NAO.compile()
    model.body_inertia[:], model.dof_damping[:] = 0.0, 0.0
    model.dof_armature[:], model.dof_frictionloss[:] = 0.0, 0.0
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    data = mujoco.MjData(model)
    before, data.qpos[:], after = postures
    speeds = np.zeros((2, model.nv))
    mujoco.mj_differentiatePos(model, speeds[0], TICK, before, data.qpos)
    mujoco.mj_differentiatePos(model, speeds[1], TICK, data.qpos, after)
    data.qvel[:] = speeds.mean(axis=0)
    data.qacc[:] = (speeds[1] - speeds[0]) / TICK
    mujoco.mj_inverse(model, data)
    torques = data.qfrc_inverse
    weight = torques[:3].copy()  # and what accelerates the body
    jacobian, turning = np.zeros((3, model.nv)), np.zeros((3, model.nv))
    pressed = np.zeros(model.nv)
    rows = []
    for name, foot, part in (
        (NAO.left_foot, reference.left_foot, share),
        (NAO.right_foot, reference.right_foot, 1.0 - share),
    ):
        x, y, z, yaw = foot
        anchor = np.array([x + AHEAD * cos(yaw), y + AHEAD * sin(yaw), z])
        body = model.site_bodyid[model.site(name).id]
        mujoco.mj_jac(model, data, jacobian, turning, anchor, body)
        pressed += part * jacobian.T @ weight
        rows.append((part, turning.copy()))
    # The torso rests: what moment is missing, the feet bear by their share.
    missed = (
        data.xmat[model.body("torso").id].reshape(3, 3)
        @ (torques - pressed)[3:6]
    )
    for part, turning in rows:
        pressed += part * turning.T @ missed
    borne = torques - pressed
    np.testing.assert_allclose(borne[:6], 0.0, atol=1e-9)
    found = []
    for name in load_tree(NAO).motors:
        total = borne[model.joint(name).dofadr[0]]
        for follower, leader in coupled_joints(model, "nao").items():
            if leader == name:
                total += borne[model.joint(follower).dofadr[0]]
        found.append(total if name in NAO.legs else 0.0)
    return np.array(found)


def test_at_rest_the_torques_are_those_of_mujoco() -> None:
    """Whatever the stance and the ZMP: on one foot, on the other, between."""
    for lift, sway in ((0.0, 0.0), (0.0, 0.02), (0.01, 0.05), (0.02, 0.04)):
        reference = standing(sway, lift)
        kinematics, loads = loads_of(reference)
        zmp = (reference.com[0], reference.com[1])
        found = loads.torques(reference, zmp)
        left, right = (
            np.array([x + AHEAD * cos(yaw), y + AHEAD * sin(yaw)])
            for x, y, _, yaw in (reference.left_foot, reference.right_foot)
        )
        line = left - right
        share = (zmp - right) @ line / (line @ line) if lift == 0.0 else 1.0
        wanted = by_mujoco(3 * [kinematics.posture], reference, share)
        np.testing.assert_allclose(found, wanted, atol=2e-4)
        assert 0.5 < np.abs(found).max() < 6.0


def test_in_motion_the_torques_are_those_of_mujoco() -> None:
    """While the CoM sways by 0.5 m/s^2 and rises: links as point masses."""
    kinematics, loads = loads_of(STILL)
    zmp, share = (AHEAD, 0.01), 0.6
    postures, torques, at_rest = [], [], np.zeros(0)
    for i in range(200):
        phase = 8.0 * TICK * i
        x, _, z = STILL.com
        com = (x, 0.008 * np.sin(phase), z - 0.005 * (1.0 - np.cos(phase)))
        reference = STILL._replace(com=com)
        kinematics.track(reference)
        postures.append(kinematics.posture)
        torques.append(loads.torques(reference, zmp))
        if i == 150:
            wanted_of = reference
            rest = LegLoads(kinematics, zmp_forward=AHEAD, tick=TICK)
            at_rest = rest.torques(reference, zmp)
    wanted = by_mujoco(postures[149:152], wanted_of, share)
    # Accelerations are those of a tick before.
    gap = np.abs(torques[151] - wanted).max()
    assert gap < 0.02
    assert np.abs(at_rest - wanted).max() > 10.0 * gap


def test_servos_with_load_feedforward_reach_their_targets() -> None:
    """The law of a servo: k (sent - q) - d q' with sent led by d / k."""
    reference = standing()
    kinematics, loads = loads_of(reference)
    feedforward = LoadFeedforward(kinematics, zmp_forward=AHEAD, tick=TICK)
    servos = np.array(kinematics.tree.servos)
    stiffness, damping = servos.T
    legs = np.array([name in NAO.legs for name in kinematics.joint_names])
    np.testing.assert_array_equal(servos[legs], [(200.0, 10.0)] * legs.sum())
    last = np.zeros(legs.size)
    before = loads.torques(reference, (AHEAD, -0.03))
    for share in np.linspace(-0.03, 0.03, 7):
        zmp = (AHEAD, float(share))
        added = feedforward.added(reference, zmp)
        led = added + damping / stiffness * (added - last) / TICK
        torques = loads.torques(reference, zmp)
        soon = torques + (torques - before)
        np.testing.assert_allclose(stiffness * led, soon, atol=1e-9)
        last, before = added, torques
    for _ in range(500):
        last = feedforward.added(reference, zmp)
    np.testing.assert_allclose(stiffness * last, torques, atol=1e-6)
    assert not last[~legs].any()
