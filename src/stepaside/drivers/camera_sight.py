"""Sight by the camera of a robot that is driven by velocity commands."""

from concurrent.futures import Future
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.history import History
from ..core.poses import Pose, wrap_angle
from ..core.rotations import rotation
from ..perception.measurement import RobotState
from ..robots.body_pose import BodyPose
from .robot_camera import CameraMount, PosedCamera, colour_image
from .robot_session import RobotSession

if TYPE_CHECKING:
    from ..perception.pipeline import Perception

MEMORY = 1.0  # how long poses are stored, to place images in time, in [s]


class PosedSight:
    """Sightings of the opponent by a camera, which the head may turn."""

    def __init__(
        self,
        session: RobotSession,
        camera: PosedCamera,
        perception: "Perception",
        *,
        turns_head: bool,
    ) -> None:
        """Begin without an image.

        Args:
            session: Session with the robot.
            camera: Its camera; closed with this object.
            perception: Perception that detects the opponent.
            turns_head: Whether the head follows the opponent.
        """
        self._session, self._camera = session, camera
        self._perception, self._turns_head = perception, turns_head
        self._mount: CameraMount | None = None  # at the newest image
        self._looking: Future[Any] | None = None
        self._last: RobotState | None = None
        self._poses: History[Pose] = History(MEMORY)

    def see(self, report: RobotState) -> RobotState:
        """Return a report with the newest sighting.

        Raises:
            SessionLost: If image() or look() failed.
        """
        if report.hindrance:
            return report
        if self._last is not None and report.time == self._last.time:
            return report._replace(sighting=self._last.sighting)
        self._poses.note(report.time, report.pose)
        percepts = []
        image = self._camera.take(report.time)
        if image is not None:
            assert image.mount is not None  # as the camera has checked
            self._mount = image.mount
            pose = self._poses.at(image.time, between)
            self._perception.note_pose(
                pose_of_camera(image.time, pose, image.mount)
            )
            percepts.append(colour_image(image, image.time))
        hindrance, sighting = self._camera.hindrance, None
        if self._mount is not None:
            now = pose_of_camera(report.time, report.pose, self._mount)
            sighting = self._perception.see_from(now, percepts)
            if self._turns_head:
                self._look()
        self._last = report._replace(sighting=sighting, hindrance=hindrance)
        return self._last

    def close(self) -> None:
        """Close the camera."""
        self._camera.close()

    def _look(self) -> None:
        """Turn the head, unless the last call has not returned."""
        if self._looking is not None:
            if not self._looking.done():
                return
            self._looking.result()
        head, robot = self._perception.head, self._session.robot
        yaw, pitch = head.yaw, head.pitch
        self._looking = self._session.tell(
            "look", lambda: robot.look(yaw, pitch)
        )


def between(one: Pose, other: Pose, share: float) -> Pose:
    """Return the pose at a share of the way from one pose to another."""
    turn = wrap_angle(other.theta - one.theta)
    return Pose(
        one.x + share * (other.x - one.x),
        one.y + share * (other.y - one.y),
        one.theta + share * turn,
    )


def pose_of_camera(time: float, robot: Pose, mount: CameraMount) -> BodyPose:
    """Return the body of a robot of which only the camera matters.

    Args:
        time: Time, in [s].
        robot: Pose of the robot in odometry.
        mount: Pose of its camera.
    """
    turn = rotation(0.0, 0.0, robot.theta)
    floor = np.array([robot.x, robot.y, 0.0])
    return BodyPose(
        time,
        robot,
        floor,
        turn,
        floor + turn @ mount[:3],
        turn @ rotation(mount.roll, mount.pitch, mount.yaw),
        mount.yaw,
        mount.pitch,
    )
