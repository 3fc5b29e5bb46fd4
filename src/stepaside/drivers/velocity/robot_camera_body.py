"""Camera perception for a robot that a user connects in Python."""

from collections import deque
from itertools import pairwise

import numpy as np

from ...core.poses import Pose, wrap_angle
from ...core.rotations import rotation
from ...perception.pipeline import Perception
from ...robots.body_pose import BodyPose
from ..cameras.robot_camera import CameraMount, PosedCamera, colour_image
from .adapter_body import AdapterBody
from .velocity_body import VelocityCommand, VelocityReport

HISTORY = 50  # reports among which an image is placed in time: 1 s


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


class RobotCameraBody:
    """Robot in Python whose sightings come from images of its camera."""

    def __init__(
        self,
        body: AdapterBody,
        camera: PosedCamera,
        perception: Perception,
        *,
        turns_head: bool,
    ) -> None:
        """Combine a robot, its camera and perception.

        Args:
            body: The robot; closed with this object.
            camera: Its camera; closed with this object.
            perception: Perception that detects the opponent.
            turns_head: Whether the head follows the opponent.
        """
        self._body, self._camera = body, camera
        self._perception, self._turns_head = perception, turns_head
        self._mount: CameraMount | None = None  # at the newest image
        self._reports: deque[VelocityReport] = deque(maxlen=HISTORY)

    def listen(self, patience: float) -> VelocityReport | None:
        """Return the newest report, with the newest sighting.

        Raises:
            SessionLost: If a method failed or does not return.
        """
        report = self._body.listen(patience)
        if report is None or report.hindrance:
            return report
        if self._reports and report.time == self._reports[-1].time:
            return report  # repeated
        self._reports.append(report)
        percepts = []
        image = self._camera.take(report.time)
        if image is not None:
            assert image.mount is not None  # as the camera has checked
            self._mount = image.mount
            pose = self._pose_at(image.time)
            self._perception.note_pose(
                pose_of_camera(image.time, pose, image.mount)
            )
            percepts.append(colour_image(image, image.time))
        hindrance = self._camera.hindrance
        if self._mount is None:
            return report._replace(sighting=None, hindrance=hindrance)
        now = pose_of_camera(report.time, report.pose, self._mount)
        sighting = self._perception.see_from(now, percepts)
        if self._turns_head:
            head = self._perception.head
            self._body.look(head.yaw, head.pitch)
        return report._replace(sighting=sighting, hindrance=hindrance)

    def command(self, velocity: VelocityCommand) -> None:
        """Send a velocity command."""
        self._body.command(velocity)

    def close(self) -> None:
        """Stop the robot and close its camera."""
        self._camera.close()
        self._body.close()

    def _pose_at(self, time: float) -> Pose:
        """Return the pose at the time of an image, between two reports."""
        last = self._reports[-1].pose
        for earlier, later in pairwise(self._reports):
            if earlier.time <= time < later.time:
                share = (time - earlier.time) / (later.time - earlier.time)
                (x, y, heading), end = earlier.pose, later.pose
                turn = wrap_angle(end.theta - heading)
                return Pose(
                    x + share * (end.x - x),
                    y + share * (end.y - y),
                    heading + share * turn,
                )
        return last
