"""True state of players, known to the simulator only."""

from math import atan2, cos, hypot, radians, sin
from typing import NamedTuple

import mujoco
import numpy as np

from ..core.poses import Array, Pose
from ..core.rotations import angles_of
from ..robots.description_types import ReferencePoint

FALLEN = cos(radians(45.0))  # upward component of the torso's axis


class FloorTruth:
    """True state of a player that physics does not move."""

    has_fallen = False

    def __init__(self, pose: Pose, *, reach: float, height: float) -> None:
        self.pose, self.reach, self._height = pose, reach, height

    @property
    def position_com_in_world(self) -> Array:
        """Position at the height of the CoM, in [m]. Shape (3,)."""
        return np.array([*self.pose[:2], self._height])

    @property
    def position_torso_in_world(self) -> tuple[float, float]:
        """Position, in [m]."""
        return self.pose[:2]

    position_reference_in_world = position_torso_in_world

    @property
    def heading_in_world(self) -> float:
        """Heading, in [rad]."""
        return self.pose.theta


class TrueRobotState:
    """True state of one robot in its world; arrays are views.

    The reference point is midway between the feet of a standing robot, and
    moves with the CoM of a walking one. Around the torso, ``reach`` [m]
    contains the whole robot.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        torso: str,
        *,
        com_forward: float = 0.0,
        place: ReferencePoint | None = None,
    ) -> None:
        self._com_forward = com_forward
        place = place or ReferencePoint()
        self._hips_forward, self.reach = place.forward, place.reach
        root = model.body(torso).id
        self.origin_torso_in_world: Array = data.xpos[root]
        self.axes_torso_in_world: Array = data.xmat[root]
        self.position_com_in_world: Array = data.subtree_com[root]

    @property
    def position_torso_in_world(self) -> tuple[float, float]:
        """Point midway between the hips, in [m]."""
        origin, axes = self.origin_torso_in_world, self.axes_torso_in_world
        ahead = self._hips_forward
        return (
            origin.item(0) + ahead * axes.item(0),
            origin.item(1) + ahead * axes.item(3),
        )

    @property
    def position_reference_in_world(self) -> tuple[float, float]:
        """Reference point, in [m]."""
        x, y, _ = self.position_com_in_world.tolist()
        heading, ahead = self.heading_in_world, self._com_forward
        return x - ahead * cos(heading), y - ahead * sin(heading)

    @property
    def heading_in_world(self) -> float:
        """Heading of the torso, in [rad]."""
        axes = self.axes_torso_in_world
        return atan2(axes.item(3), axes.item(0))

    @property
    def has_fallen(self) -> bool:
        """Whether the torso leans by more than 45 degrees."""
        return self.axes_torso_in_world.item(8) < FALLEN

    def poses_at(
        self, com: Array, origin: Array, axes: Array
    ) -> tuple[Array, Array]:
        """Return rows (x, y, theta) of reference point and torso."""
        forward = axes[:, [0, 3]]
        heading = np.arctan2(forward[:, 1], forward[:, 0])
        turned = np.column_stack([np.cos(heading), np.sin(heading)])
        reference = com[:, :2] - self._com_forward * turned
        torso = origin[:, :2] + self._hips_forward * forward
        return (
            np.column_stack([reference, heading]),
            np.column_stack([torso, heading]),
        )


GroundTruth = FloorTruth | TrueRobotState
"""True state of a player: a robot, a person or a template."""


def torsos_apart(one: GroundTruth, other: GroundTruth) -> float:
    """Return the horizontal distance between two torsos, in [m]."""
    (x, y) = one.position_torso_in_world
    (u, v) = other.position_torso_in_world
    return hypot(u - x, v - y)


class TrueStance(NamedTuple):
    """Torso, feet and velocity of a robot in its world."""

    velocity: tuple[float, float]  # CoM velocity (x, y) [m/s]
    tilt: tuple[float, float]  # roll and pitch of the torso [rad]
    left_sole: Pose
    right_sole: Pose


def true_stance(
    model: mujoco.MjModel, data: mujoco.MjData, torso: int, soles: list[int]
) -> TrueStance:
    """Return the stance, by torso body and sites of left and right sole."""
    mujoco.mj_subtreeVel(model, data)
    vx, vy, _ = data.subtree_linvel[torso].tolist()
    roll, pitch, _ = angles_of(data.xmat[torso].reshape(3, 3))
    left, right = (_pose(data, sole) for sole in soles)
    return TrueStance((vx, vy), (roll, pitch), left, right)


def _pose(data: mujoco.MjData, site: int) -> Pose:
    x, y, _ = data.site_xpos[site].tolist()
    frame = data.site_xmat[site]
    return Pose(x, y, atan2(frame[3], frame[0]))
