"""Eyes for a robot that walks by itself, and turns its head when asked."""

from collections import deque
from itertools import pairwise
from typing import NamedTuple, Protocol

import numpy as np

from ...core.poses import Array, Pose, wrap_angle
from ...perception.measurement import Measurement
from ...perception.planar_perception import PlanarPerception
from ..cameras.image_source import ImageSource
from .velocity_body import VelocityBody, VelocityCommand, VelocityReport

PERIOD = 0.05  # between two looks, in [s]; the head is turned as often
KEPT = 20  # reports between which an image may have been taken


class HeadBody(VelocityBody, Protocol):
    """A robot that walks by itself and has a head."""

    @property
    def joints(self) -> Array:
        """Joints when it was last heard, in [rad]. Shape (joints,)."""

    def look(self, yaw: float, pitch: float) -> None:
        """Turn the head, in [rad].

        Raises:
            SessionLost: If the robot cannot be reached.
        """


class PoseReport(NamedTuple):
    """Where a robot was at a report.

    Attributes:
        time: Of the report, in [s].
        pose: By its odometry.
        joints: Their angles, in [rad]. Shape (joints,).
    """

    time: float
    pose: Pose
    joints: Array


class CameraBody:
    """Sees the other by the robot's own camera, and keeps looking at it."""

    def __init__(
        self,
        body: HeadBody,
        eyes: ImageSource,
        perception: PlanarPerception,
        *,
        turns_head: bool = True,
    ) -> None:
        """Open a robot's eyes.

        Args:
            body: The robot; closed with this one.
            eyes: Its camera, likewise.
            perception: What sees and looks, at a period of ``PERIOD``.
            turns_head: Whether the head is commanded.
        """
        self._body, self._eyes = body, eyes
        self._perception, self._turns_head = perception, turns_head
        self._heard = 0
        self._told: deque[PoseReport] = deque(maxlen=KEPT)

    def listen(self, patience: float) -> VelocityReport | None:
        """Newest report, with what was seen until then."""
        report = self._body.listen(patience)
        if report is None:
            return None
        self._heard += 1
        images = self._eyes.percepts(self._heard, report.time, PERIOD)
        nothing = np.zeros(3)
        measured = Measurement(
            *(report.time, self._body.joints, nothing, nothing, np.zeros(8)),
            None,
            tuple(images),
        )
        told = PoseReport(report.time, report.pose, self._body.joints)
        self._told.append(told)
        for image in images:
            self._recall(image.time)
        seen = self._perception.see_level(measured, report.pose)
        if self._turns_head:
            self._body.look(*self._perception.gaze)
        return report._replace(sighting=seen)

    def _recall(self, time: float) -> None:
        """Put the body where it was when an image was taken.

        The head turns by some degrees from one report to the next.
        """
        for earlier, later in pairwise(self._told):
            if earlier.time < time < later.time:
                break
        else:
            return
        share = (time - earlier.time) / (later.time - earlier.time)
        (x, y, heading), after = earlier.pose, later.pose
        turn = wrap_angle(after.theta - heading)
        pose = Pose(
            x + share * (after.x - x),
            y + share * (after.y - y),
            heading + share * turn,
        )
        joints = earlier.joints + share * (later.joints - earlier.joints)
        self._perception.recall_level(time, joints, pose)

    def command(self, velocity: VelocityCommand) -> None:
        """Ask for a velocity."""
        self._body.command(velocity)

    def close(self) -> None:
        """Let the robot stand, and close its eyes."""
        self._eyes.close()
        self._body.close()
