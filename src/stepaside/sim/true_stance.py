"""True stance of a robot: velocity, tilt and sole poses."""

from collections.abc import Sequence
from math import asin, atan2
from typing import NamedTuple

import mujoco

from ..core.poses import Pose


class TrueStance(NamedTuple):
    """Torso, feet and velocity of a robot in its world.

    Attributes:
        velocity: CoM velocity (x, y) in the world, in [m/s].
        tilt: Roll and pitch of the torso, in [rad].
        left_sole: Pose of the left sole in the world.
        right_sole: Pose of the right sole in the world.
    """

    velocity: tuple[float, float]
    tilt: tuple[float, float]
    left_sole: Pose
    right_sole: Pose


def true_stance(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    torso: int,
    soles: Sequence[int],
) -> TrueStance:
    """Return the stance of a robot at this instant.

    Args:
        model: Model of the world.
        data: Its state.
        torso: Body of the torso.
        soles: Sites at the left and the right sole.
    """
    mujoco.mj_subtreeVel(model, data)
    vx, vy, _ = data.subtree_linvel[torso].tolist()
    frame = data.xmat[torso].tolist()
    tilt = atan2(frame[7], frame[8]), -asin(max(-1.0, min(1.0, frame[6])))
    left, right = (_pose(data, sole) for sole in soles)
    return TrueStance((vx, vy), tilt, left, right)


def _pose(data: mujoco.MjData, site: int) -> Pose:
    x, y, _ = data.site_xpos[site].tolist()
    frame = data.site_xmat[site]
    return Pose(x, y, atan2(frame[3], frame[0]))
