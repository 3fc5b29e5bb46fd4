"""Velocity commands: ``Twist`` or ``TwistStamped``, as they are taken.

ROS 2 robots take one or the other on ``cmd_vel``; on DDS a writer of one
type does not match a reader of the other, and no error says so.
"""

import logging
from typing import Any

from ..velocity.velocity_body import VelocityCommand
from .dds_domain import DdsParticipant, taken
from .endpoint_discovery import Endpoints
from .messages import Header, Twist, TwistStamped
from .topics import COMMAND, dds_topic, vector

KINDS: tuple[type[Any], ...] = (Twist, TwistStamped)
HANDLES = 1 << 64  # handles are signed in some places, unsigned in others
log = logging.getLogger(__name__)


class CommandWriter:
    """Writes commands in each type that has a subscriber.

    A writer is made when the first subscriber of its type is discovered.
    """

    def __init__(self, dds: DdsParticipant, namespace: str) -> None:
        """Look for subscribers.

        Args:
            dds: Where; it stays with the caller.
            namespace: Of the robot, with a slash before it, or empty.
        """
        self._dds, self._name = dds, f"{namespace}/{COMMAND}"
        self._topic = dds_topic(namespace, COMMAND)
        self._subscribers = Endpoints(dds, self._topic, writers=False)
        self._writers: dict[type[Any], Any] = {}

    def hindrance(self) -> str:
        """Why no command would arrive; empty if one would."""
        kinds = self._prepare()
        if not kinds:
            return f"nothing subscribes to {self._name}"
        if not any(ros_name(kind) in kinds for kind in KINDS):
            wanted = " or ".join(ros_name(kind) for kind in KINDS)
            found = " and ".join(sorted(kinds))
            return f"{self._name} is subscribed as {found}, not as {wanted}"
        writers = self._writers.values()
        if not any(each.get_matched_subscriptions() for each in writers):
            return (
                f"no subscriber of {self._name} accepts messages that are "
                "reliable and volatile"
            )
        return ""

    def write(self, velocity: VelocityCommand, header: Header) -> None:
        """Ask for a velocity.

        Args:
            velocity: Of the robot.
            header: Time of the robot's clock and frame of its base, for
                those who take stamped commands.
        """
        self._prepare()
        twist = Twist(vector(velocity.forward), vector(z=velocity.turn))
        for kind, writer in self._writers.items():
            writer.write(
                twist if kind is Twist else TwistStamped(header, twist)
            )

    def _prepare(self) -> set[str]:
        """Make what writers lack; types of the subscribers, as in ROS."""
        kinds = {_ros(kind) for kind in self._subscribers.types}
        for kind in KINDS:
            if ros_name(kind) in kinds and kind not in self._writers:
                self._writers[kind] = self._dds.writer(self._topic, kind)
                log.info("%s takes %s", self._name, ros_name(kind))
        return kinds


class CommandReader:
    """Takes the commands of a served robot, one type at a time.

    A commander that writes each type that has a subscriber writes one then.
    """

    def __init__(self, dds: DdsParticipant, namespace: str) -> None:
        """Subscribe to ``Twist``.

        Args:
            dds: Where; it stays with the caller.
            namespace: Of the robot, with a slash before it, or empty.
        """
        self._dds, self._topic = dds, dds_topic(namespace, COMMAND)
        self._publishers = Endpoints(dds, self._topic, writers=True)
        self._subscribe(Twist)

    def commanders(self) -> set[int]:
        """Handles of those who may command now."""
        found = self._reader.get_matched_publications()
        return {handle % HANDLES for handle in found}

    def taken(self) -> list[tuple[int, Twist]]:
        """Commands that have arrived and their commanders' handles."""
        return [
            (
                sample.sample_info.publication_handle % HANDLES,
                sample if self._kind is Twist else sample.twist,
            )
            for sample in taken(self._reader)
        ]

    def choose(self) -> None:
        """Subscribe to the type that is written, if the present one is not.

        To be called while there is no commander.
        """
        written = {_ros(kind) for kind in self._publishers.types}
        if ros_name(self._kind) in written:
            return
        for kind in KINDS:
            if ros_name(kind) in written:
                self._subscribe(kind)
                return

    def _subscribe(self, kind: type[Any]) -> None:
        self._kind = kind
        self._reader = self._dds.reader(self._topic, kind)


def ros_name(kind: type[Any]) -> str:
    """Name of a message as in ROS, such as ``geometry_msgs/Twist``."""
    return _ros(kind.__idl__.idl_transformed_typename)


def _ros(name: str) -> str:
    """Name in ROS of a type on DDS; others stay as they are."""
    package, _, rest = name.partition("::")
    middle, _, message = rest.rpartition("::")
    if middle != "msg::dds_" or not message.endswith("_"):
        return name
    return f"{package}/{message.removesuffix('_')}"
