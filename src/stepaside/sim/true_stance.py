"""True stance of a robot: velocity, tilt and sole poses."""

from math import atan2
from typing import NamedTuple

import mujoco

from ..core.poses import Pose
from ..core.rotations import angles_of
from ..robots.description import RobotDescription


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


class StanceWatch:
    """Reader of the true stance of one robot."""

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        name: str,
        description: RobotDescription,
    ) -> None:
        """Read the robot with a name."""
        self._model, self._data = model, data
        self._torso = model.body(f"{name}/{description.torso}").id
        feet = description.left_foot, description.right_foot
        self._soles = [model.site(f"{name}/{foot}").id for foot in feet]

    def read(self) -> TrueStance:
        """Return the stance at this instant."""
        data, torso = self._data, self._torso
        mujoco.mj_subtreeVel(self._model, data)
        vx, vy, _ = data.subtree_linvel[torso].tolist()
        left, right = (self._pose(sole) for sole in self._soles)
        roll, pitch, _ = angles_of(data.xmat[torso].reshape(3, 3))
        return TrueStance((vx, vy), (roll, pitch), left, right)

    def _pose(self, site: int) -> Pose:
        x, y, _ = self._data.site_xpos[site].tolist()
        frame = self._data.site_xmat[site]
        return Pose(x, y, atan2(frame[3], frame[0]))
