"""Driver for a robot that follows velocity commands on ROS 2 topics."""

import logging
from collections.abc import Callable, Mapping
from functools import partial
from math import atan2, hypot, inf, isnan
from time import monotonic, sleep
from typing import Any

from ...core.history import History
from ...core.poses import Pose
from ...perception.measurement import Sighting
from ..guardian_process import SessionLost
from ..velocity.velocity_body import REST, VelocityCommand, VelocityReport
from .dds_domain import DdsParticipant, take_messages
from .endpoint_discovery import Endpoints
from .messages import (
    Detection3DArray,
    Header,
    Odometry,
    PointStamped,
    PoseStamped,
    Time,
)
from .topics import (
    COMMAND,
    DETECTIONS,
    IDEAL,
    NO_REMAPPING,
    ODOMETRY,
    POINT,
    POSE,
    dds_topic,
    nearest_detection,
    pose_of,
    position_of,
    ros_topic,
)
from .velocity_commands import KINDS, CommandWriter, ros_type

POLL = 0.001  # between two checks for messages, in [s]
STOP_COUNT = 5  # commands of zero velocity at the end of a session
STOP_PAUSE = 0.02  # between two of them, in [s]
GUARDIAN_DURATION = 3.0  # of zero commands by the guardian, in [s]
HINT_AFTER = 3.0  # without any publisher of odometry, in [s]
POSE_MEMORY = 2.0  # how long past poses are stored, in [s]
FAULT_AGE = 0.5  # at which invalid detections no longer count, in [s]
UNSTAMPED = Header(Time(0, 0), "")  # robots read it as now, or reject it
log = logging.getLogger(__name__)


class Ros2Body:
    """Robot in a ROS 2 namespace.

    Reads ``odom`` and the opponent's position: ``other`` (a point) or
    ``other_pose``, in the odometry frame if the header says so, else in the
    robot's own frame, x forward and y left; or ``detections`` of another
    program, of which the nearest one counts; from a simulated robot also
    ``ideal_sight``. Writes ``cmd_vel`` as ``Twist`` or ``TwistStamped``,
    whichever the robot subscribes to. Commands carry the stamp of the newest
    odometry, as robots reject stamps that are old by their clock.
    """

    def __init__(
        self,
        dds: DdsParticipant,
        namespace: str,
        *,
        dry_run: bool = False,
        remapping: Mapping[str, str] = NO_REMAPPING,
        opponent: str = "",
    ) -> None:
        """Subscribe to the robot's topics.

        Args:
            dds: DDS participant; closed with the body.
            namespace: Namespace of the robot, with a leading slash; or empty.
            dry_run: Whether nothing is commanded.
            remapping: Topics with another name.
            opponent: Class of the detections that count; empty for any.
        """
        self._dds, self._namespace = dds, namespace
        self._opponent = opponent
        self._fault, self._fault_ends = "", -inf

        def topic_of(name: str) -> str:
            return dds_topic(namespace, name, remapping)

        def reader(name: str, kind: type[Any]) -> Any:
            return dds.reader(topic_of(name), kind)

        self._odometry = reader(ODOMETRY, Odometry)
        self._odometry_name = ros_topic(namespace, ODOMETRY, remapping)
        self._publishers = Endpoints(dds, topic_of(ODOMETRY), writers=True)
        self._hint_at = monotonic() + HINT_AFTER
        self._sights = {
            POINT: reader(POINT, PointStamped),
            POSE: reader(POSE, PoseStamped),
            IDEAL: reader(IDEAL, PointStamped),
        }
        self._detections = reader(DETECTIONS, Detection3DArray)
        self._others = Endpoints(dds, topic_of(COMMAND), writers=True)
        self._commands: CommandWriter | None = None
        if not dry_run:
            self._commands = CommandWriter(dds, namespace, remapping)
        self._header = UNSTAMPED
        self._poses: History[Pose] = History(POSE_MEMORY)
        self._sighting: Sighting | None = None
        self._is_ideal_logged = False

    @property
    def commanders(self) -> int:
        """Number of other participants that command this robot."""
        return self._others.participants

    def listen(self, patience: float) -> VelocityReport | None:
        """Return the newest report since the last call, or None.

        Args:
            patience: Longest time to wait for a report, in [s].
        """
        deadline = monotonic() + patience
        while True:
            arrived = take_messages(self._odometry)
            if arrived:
                self._hint_at = inf
                return self._report(arrived[-1])
            self._hint()
            if monotonic() >= deadline:
                return None
            sleep(POLL)

    def _hint(self) -> None:
        """Log once why there may be no odometry, if there never was any."""
        if monotonic() < self._hint_at:
            return
        self._hint_at = inf
        name, types = self._odometry_name, self._publishers.types
        if not types:
            log.warning("nothing publishes %s; %s", name, self._dds.reach)
            return
        kinds = " and ".join(sorted(map(ros_type, types)))
        log.warning(
            "%s is published as %s, but no message arrives", name, kinds
        )

    def command(self, velocity: VelocityCommand) -> None:
        """Publish a velocity command.

        Raises:
            SessionLost: If it cannot be published.
        """
        if self._commands is None:
            return
        try:
            self._commands.write(velocity, self._header)
        except Exception as error:
            raise SessionLost(f"cannot command the robot: {error}") from error

    def close(self) -> None:
        """Command zero velocity several times, and leave DDS."""
        try:
            for _ in range(STOP_COUNT if self._commands else 0):
                self.command(REST)
                sleep(STOP_PAUSE)
        except SessionLost as error:
            log.warning("%s", error)
        finally:
            del self._odometry, self._sights, self._others, self._commands
            del self._publishers, self._detections
            self._dds.close()

    def _report(self, odometry: Odometry) -> VelocityReport:
        pose = pose_of(odometry.pose.pose)
        stamp = odometry.header.stamp
        time = stamp.seconds
        self._header = Header(stamp, odometry.child_frame_id)
        self._poses.note(time, pose)
        for name, reader in self._sights.items():
            for message in take_messages(reader):
                if name == IDEAL and not self._is_ideal_logged:
                    self._is_ideal_logged = True
                    log.warning(
                        "uses the ideal line of sight of %s",
                        self._namespace or "/",
                    )
                point, stamp = position_of(message), message.header
                self._note((point.x, point.y), stamp, odometry)
        for detections in take_messages(self._detections):
            self._note_detections(detections, odometry)
        hindrance = self._odometry_fault(time, pose) or self._hindrance(time)
        return VelocityReport(time, pose, self._sighting, hindrance)

    def _odometry_fault(self, time: float, pose: Pose) -> str:
        """Return which field of the odometry is not filled, if any."""
        if time == 0.0:
            return f"{self._odometry_name} has no stamp: header.stamp is 0"
        if isnan(pose.theta):
            return (
                f"{self._odometry_name} has no heading: pose.orientation is "
                "zero or not finite"
            )
        return ""

    def _hindrance(self, time: float) -> str:
        """Return why the robot must not move; empty if it may."""
        if self._commands and (reason := self._commands.hindrance()):
            return reason
        others = self.commanders
        if others:
            return f"{others} others command this robot"
        return self._fault if time < self._fault_ends else ""

    def _note_detections(
        self, message: Detection3DArray, odometry: Odometry
    ) -> None:
        """Convert the nearest detection to a sighting.

        Detections in the axes of a camera are refused: there, x is to the
        right and y down.
        """
        frame, self._fault_ends = message.header.frame_id, -inf
        if frame.endswith(("optical", "optical_frame")):
            self._fault_ends = odometry.header.stamp.seconds + FAULT_AGE
            self._fault = (
                f"detections are in {frame}, and must be in "
                f"{odometry.child_frame_id} or {odometry.header.frame_id}"
            )
            return
        place = nearest_detection(message, self._opponent)
        if place is not None:
            self._note(place, message.header, odometry)

    def _note(
        self, place: tuple[float, float], stamp: Header, odometry: Odometry
    ) -> None:
        """Convert the opponent's position to a sighting."""
        time, (x, y) = stamp.stamp.seconds, place
        if stamp.frame_id == odometry.header.frame_id:
            pose_in_odometry = self._poses.at(time)
            x, y, _ = pose_in_odometry.inverse().compose(Pose(x, y, 0.0))
        self._sighting = Sighting(time, atan2(y, x), hypot(x, y))


def register_stopper(
    dds: DdsParticipant,
    namespace: str,
    remapping: Mapping[str, str] = NO_REMAPPING,
) -> Callable[[], None]:
    """Register a robot's topics, and return a function that stops it.

    No writer is created before: it would count as a second commander.

    Args:
        dds: DDS participant; closed after the robot has been stopped.
        namespace: Namespace of the robot, with a leading slash; or empty.
        remapping: Topics with another name.
    """
    for kind in KINDS:
        dds.register(dds_topic(namespace, COMMAND, remapping), kind)
    return partial(command_standstill, dds, namespace, remapping=remapping)


def command_standstill(
    dds: DdsParticipant,
    namespace: str,
    duration: float = GUARDIAN_DURATION,
    *,
    remapping: Mapping[str, str] = NO_REMAPPING,
) -> None:
    """Command zero velocity when control has failed.

    Args:
        dds: DDS participant; it is closed.
        namespace: Namespace of the robot, with a leading slash; or empty.
        duration: Duration of the commands, in [s]; discovery takes some
            of it.
        remapping: Topics with another name.
    """
    commands = CommandWriter(dds, namespace, remapping)
    for _ in range(round(duration / STOP_PAUSE)):
        commands.write(REST, UNSTAMPED)
        sleep(STOP_PAUSE)
    del commands
    dds.close()
