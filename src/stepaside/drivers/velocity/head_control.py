"""Camera perception and gaze for a robot driven by velocity commands."""

from collections import deque
from itertools import pairwise
from typing import NamedTuple, Protocol

import numpy as np

from ...core.poses import Array, Pose, wrap_angle
from ...perception.measurement import Measurement
from ...perception.pipeline import Perception
from ..cameras.image_source import ImageSource
from .velocity_body import VelocityBody, VelocityCommand, VelocityReport

PERIOD = 0.05  # between two updates of perception and head, in [s]
HISTORY = 20  # reports among which an image is placed in time: 1 s


class HeadBody(VelocityBody, Protocol):
    """Robot driven by velocity commands that can also turn its head."""

    @property
    def joints(self) -> Array:
        """Joint angles of the newest report, in [rad]. Shape (joints,)."""

    def look(self, yaw: float, pitch: float) -> None:
        """Command the angles of the head, in [rad].

        Raises:
            SessionLost: If the robot cannot be reached.
        """


class PoseReport(NamedTuple):
    """Configuration of a robot at one report.

    Attributes:
        time: Time of the report, in [s].
        pose: Pose of the robot in odometry.
        joints: Joint angles, in [rad]. Shape (joints,).
    """

    time: float
    pose: Pose
    joints: Array


class CameraBody:
    """Robot whose sightings of the opponent come from its own camera."""

    def __init__(
        self,
        body: HeadBody,
        eyes: ImageSource,
        perception: Perception,
        *,
        turns_head: bool = True,
    ) -> None:
        """Combine a robot and its camera.

        Args:
            body: The robot; closed with this object.
            eyes: Its camera; closed with this object.
            perception: Perception that detects the opponent and plans the
                gaze, at a period of ``PERIOD``.
            turns_head: Whether the head is commanded.
        """
        self._body, self._eyes = body, eyes
        self._perception, self._turns_head = perception, turns_head
        self._reports: deque[PoseReport] = deque(maxlen=HISTORY)

    def listen(self, patience: float) -> VelocityReport | None:
        """Return the newest report, with the newest sighting."""
        report = self._body.listen(patience)
        if report is None:
            return None
        images = self._eyes.percepts(report.time)
        measured = Measurement(
            report.time,
            self._body.joints,
            np.zeros(3),
            np.zeros(3),
            np.zeros(8),
            None,
            tuple(images),
        )
        self._reports.append(
            PoseReport(report.time, report.pose, self._body.joints)
        )
        for image in images:
            self._recall(image.time)
        sighting = self._perception.see_level(measured, report.pose)
        if self._turns_head:
            head = self._perception.head
            self._body.look(head.yaw, head.pitch)
        return report._replace(sighting=sighting)

    def _recall(self, time: float) -> None:
        """Give perception the configuration at the time of an image.

        Interpolated, as the head turns by some degrees between reports.
        """
        for earlier, later in pairwise(self._reports):
            if earlier.time < time < later.time:
                break
        else:
            return
        fraction = (time - earlier.time) / (later.time - earlier.time)
        (x, y, heading), after = earlier.pose, later.pose
        turn = wrap_angle(after.theta - heading)
        pose = Pose(
            x + fraction * (after.x - x),
            y + fraction * (after.y - y),
            heading + fraction * turn,
        )
        joints = earlier.joints + fraction * (later.joints - earlier.joints)
        self._perception.note_level(time, joints, pose)

    def command(self, velocity: VelocityCommand) -> None:
        """Send a velocity command."""
        self._body.command(velocity)

    def close(self) -> None:
        """Stop the robot and close its camera."""
        self._eyes.close()
        self._body.close()
