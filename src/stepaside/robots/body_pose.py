"""Where the torso and the eyes are, from encoders and tilt."""

from dataclasses import dataclass
from math import atan2, cos, sin
from typing import NamedTuple

import numpy as np

from ..core.poses import Array, Pose
from .description import RobotDescription
from .forward_kinematics import ForwardKinematics, MeasuredPosture
from .head import HeadDescription, rotation


@dataclass(frozen=True, slots=True, eq=False)
class BodyPose:
    """A body in its odometry, as measured at one instant.

    Attributes:
        time: The instant, in [s].
        torso: Place and heading of the torso in the plane.
        torso_place: Place of the torso, in [m]. Shape (3,).
        torso_axes: Its axes as columns. Shape (3, 3).
        head_place: Place of the head, in [m]. Shape (3,).
        head_axes: Its axes as columns. Shape (3, 3).
        yaw: Measured yaw of the head, in [rad].
        pitch: Measured pitch of the head, in [rad].
    """

    time: float
    torso: Pose
    torso_place: Array
    torso_axes: Array
    head_place: Array
    head_axes: Array
    yaw: float
    pitch: float


class StandingBody(NamedTuple):
    """A torso in the odometry of the foot that it stands on.

    Attributes:
        place: Of the torso, in [m]. Shape (3,).
        axes: Its axes as columns. Shape (3, 3).
        heading: Of the torso, in [rad].
    """

    place: Array
    axes: Array
    heading: float


def stand_on(
    posture: MeasuredPosture,
    foot: int,
    support: Pose,
    tilt: tuple[float, float],
) -> StandingBody:
    """Place a posture on the foot that stands.

    Args:
        posture: By the measured joints.
        foot: That stands, 0 for the left one, 1 for the right one.
        support: Its pose in odometry.
        tilt: Roll and pitch of the torso, in [rad].
    """
    lean = rotation(*tilt, 0.0)
    # Heading: that of the foot, less its own in the levelled torso.
    ahead = lean @ posture.frames[foot, :, 0]
    heading = support.theta - atan2(ahead[1], ahead[0])
    c, s = cos(heading), sin(heading)
    axes = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ lean
    place = -(axes @ posture.feet[foot])
    place[0] += support.x
    place[1] += support.y
    return StandingBody(place, axes, heading)


class BodyKinematics:
    """Forward kinematics from the foot that stands to the head."""

    def __init__(
        self,
        description: RobotDescription,
        head: HeadDescription,
        kinematics: ForwardKinematics | None = None,
    ) -> None:
        """Find the head among the joints.

        Args:
            description: The robot.
            head: Its head.
            kinematics: Of the robot with this head, if it is open already.
        """
        if kinematics is None:
            kinematics = ForwardKinematics(description, head.body)
        self._kinematics = kinematics
        names = kinematics.tree.motors
        self.yaw, self.pitch = names.index(head.yaw), names.index(head.pitch)

    def pose(
        self,
        time: float,
        joints: Array,
        support: Pose,
        left_supports: bool,
        tilt: tuple[float, float],
    ) -> BodyPose:
        """Place the body on the foot that stands.

        Args:
            time: Time of the measurement, in [s].
            joints: Encoders, in [rad]. Shape (joints,).
            support: Pose of the standing foot in odometry.
            left_supports: Whether that is the left one.
            tilt: Roll and pitch of the torso, in [rad].
        """
        posture = self._kinematics.posture(joints)
        foot = 0 if left_supports else 1
        stood = stand_on(posture, foot, support, tilt)
        return self._placed(time, joints, posture, stood)

    def level(self, time: float, joints: Array, frame: Pose) -> BodyPose:
        """Place the body level on the floor, midway between its feet.

        That of a robot that walks by itself, and only tells where it is.

        Args:
            time: Time of the measurement, in [s].
            joints: Encoders, in [rad]. Shape (joints,).
            frame: Of the robot in its odometry.
        """
        posture = self._kinematics.posture(joints)
        x, y, _ = posture.feet.mean(axis=0).tolist()
        low = float(posture.feet[:, 2].min())
        c, s = cos(frame.theta), sin(frame.theta)
        axes = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        place = np.array([frame.x, frame.y, 0.0]) - axes @ [x, y, low]
        stood = StandingBody(place, axes, frame.theta)
        return self._placed(time, joints, posture, stood)

    def _placed(
        self,
        time: float,
        joints: Array,
        posture: MeasuredPosture,
        stood: StandingBody,
    ) -> BodyPose:
        """The head over a torso that stands somewhere."""
        place, axes, heading = stood
        return BodyPose(
            time,
            Pose(float(place[0]), float(place[1]), heading),
            place,
            axes,
            place + axes @ posture.head,
            axes @ posture.head_axes,
            float(joints[self.yaw]),
            float(joints[self.pitch]),
        )
