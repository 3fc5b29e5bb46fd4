"""A robot on ROS 2 topics, behind the interface that velocities move."""

import logging
from collections.abc import Callable
from functools import partial
from math import atan2, hypot
from time import monotonic, sleep
from typing import Any

from ...control.state_history import StateHistory
from ...core.poses import Pose
from ...perception.measurement import Sighting
from ..guardian_process import SessionLost
from ..velocity.velocity_body import REST, VelocityCommand, VelocityReport
from .dds_domain import DdsParticipant, taken
from .endpoint_discovery import Endpoints
from .messages import Header, Odometry, PointStamped, PoseStamped, Time
from .topics import (
    COMMAND,
    IDEAL,
    ODOMETRY,
    POINT,
    POSE,
    dds_topic,
    place_of,
    pose_of,
)
from .velocity_commands import KINDS, CommandWriter

POLL = 0.001  # between two looks for what has arrived, in [s]
PARTING = 5  # times that rest is asked for at the end
PARTING_PAUSE = 0.02  # between them, in [s]
LETTING_GO = 3.0  # how long rest is asked for in control's place, in [s]
POSE_TICK = 0.01  # of remembered poses, in [s]
UNSTAMPED = Header(Time(0, 0), "")  # robots take it for now, or for too old
log = logging.getLogger(__name__)


class Ros2Body:
    """One robot in a namespace.

    It hears ``odom`` and where the other is: ``other`` (a point) or
    ``other_pose``, in the frame of the odometry if that is what the header
    says, else in the robot's own frame, x ahead and y left; from a
    simulated robot also ``ideal_sight``. It writes ``cmd_vel``, as ``Twist``
    or ``TwistStamped``: what the robot subscribes to. A stamp is that of the
    newest odometry, since robots refuse stamps that are old by their clock.
    """

    def __init__(
        self, dds: DdsParticipant, namespace: str, *, dry_run: bool = False
    ) -> None:
        """Take part in the topics of a robot.

        Args:
            dds: Where; it is closed with the body.
            namespace: Of the robot, with a slash before it, or empty.
            dry_run: Whether nothing is ever commanded.
        """
        self._dds, self._namespace = dds, namespace

        def reader(name: str, kind: type[Any]) -> Any:
            return dds.reader(dds_topic(namespace, name), kind)

        self._odometry = reader(ODOMETRY, Odometry)
        self._sights = {
            POINT: reader(POINT, PointStamped),
            POSE: reader(POSE, PoseStamped),
            IDEAL: reader(IDEAL, PointStamped),
        }
        topic = dds_topic(namespace, COMMAND)
        self._others = Endpoints(dds, topic, writers=True)
        self._commands: CommandWriter | None = None
        if not dry_run:
            self._commands = CommandWriter(dds, namespace)
        self._header = UNSTAMPED
        self._poses: StateHistory[Pose] = StateHistory(POSE_TICK)
        self._sighting: Sighting | None = None
        self._told_ideal = False

    @property
    def commanders(self) -> int:
        """How many others command this robot."""
        return self._others.participants

    def listen(self, patience: float) -> VelocityReport | None:
        """Newest report since the last; None if none comes in time.

        Args:
            patience: Longest time to wait for it, in [s].
        """
        until = monotonic() + patience
        while True:
            arrived = taken(self._odometry)
            if arrived:
                return self._report(arrived[-1])
            if monotonic() >= until:
                return None
            sleep(POLL)

    def command(self, velocity: VelocityCommand) -> None:
        """Ask for a velocity.

        Raises:
            SessionLost: If it cannot be written.
        """
        if self._commands is None:
            return
        try:
            self._commands.write(velocity, self._header)
        except Exception as error:
            raise SessionLost(f"the robot takes no command: {error}") from (
                error
            )

    def close(self) -> None:
        """Ask for rest a few times, and leave."""
        try:
            for _ in range(PARTING if self._commands else 0):
                self.command(REST)
                sleep(PARTING_PAUSE)
        except SessionLost as error:
            log.warning("%s", error)
        finally:
            del self._odometry, self._sights, self._others, self._commands
            self._dds.close()

    def _report(self, odometry: Odometry) -> VelocityReport:
        pose = pose_of(odometry.pose.pose)
        stamp = odometry.header.stamp
        time = stamp.seconds
        self._header = Header(stamp, odometry.child_frame_id)
        self._poses.note(time, pose)
        for name, reader in self._sights.items():
            for message in taken(reader):
                if name == IDEAL and not self._told_ideal:
                    self._told_ideal = True
                    log.warning(
                        "sees by the ideal line of sight of %s",
                        self._namespace or "/",
                    )
                self._note(message, odometry.header.frame_id)
        return VelocityReport(time, pose, self._sighting, self._hindrance())

    def _hindrance(self) -> str:
        """Why the robot must not be asked to move, if anything is."""
        if self._commands is not None and (why := self._commands.hindrance()):
            return why
        others = self.commanders
        return f"{others} others command this robot" if others else ""

    def _note(
        self, message: PointStamped | PoseStamped, odometry_frame: str
    ) -> None:
        """Turn a place of the other into a sighting."""
        place, time = place_of(message), message.header.stamp.seconds
        x, y = place.x, place.y
        if message.header.frame_id == odometry_frame:
            own = self._poses.at(time)
            x, y, _ = own.inverse().compose(Pose(x, y, 0.0))
        self._sighting = Sighting(time, atan2(y, x), hypot(x, y))


def rester_of(dds: DdsParticipant, namespace: str) -> Callable[[], None]:
    """Join a robot's topics in advance, and return what asks it for rest.

    Nothing is written before: a second writer would be another commander.

    Args:
        dds: Where; closed when the robot has been asked.
        namespace: Of the robot.
    """
    for kind in KINDS:
        dds.register(dds_topic(namespace, COMMAND), kind)
    return partial(rest, dds, namespace)


def rest(
    dds: DdsParticipant, namespace: str, duration: float = LETTING_GO
) -> None:
    """Ask a robot for rest in place of control that is gone.

    Args:
        dds: Where; it is closed.
        namespace: Of the robot.
        duration: How long, in [s]: it takes a while to be found.
    """
    commands = CommandWriter(dds, namespace)
    for _ in range(round(duration / PARTING_PAUSE)):
        commands.write(REST, UNSTAMPED)
        sleep(PARTING_PAUSE)
    del commands
    dds.close()
