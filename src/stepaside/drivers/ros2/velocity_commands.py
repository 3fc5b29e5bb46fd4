"""Writer and reader of velocity commands, ``Twist`` or ``TwistStamped``.

ROS 2 robots take one or the other on ``cmd_vel``; on DDS a writer of one
type does not match a reader of the other, without any error.
"""

import logging
from collections.abc import Mapping
from typing import Any

from ..velocity.velocity_body import VelocityCommand
from .dds_domain import DdsParticipant, take_messages
from .endpoint_discovery import Endpoints
from .messages import Header, Twist, TwistStamped
from .topics import COMMAND, NO_REMAPPING, dds_topic, ros_topic, vector

KINDS: tuple[type[Any], ...] = (Twist, TwistStamped)
HANDLES = 1 << 64  # CycloneDDS has handles as signed and unsigned numbers
log = logging.getLogger(__name__)


class CommandWriter:
    """Publisher of commands in each type that has a subscriber.

    A writer is created when the first subscriber of its type is discovered.
    """

    def __init__(
        self,
        dds: DdsParticipant,
        namespace: str,
        remapping: Mapping[str, str] = NO_REMAPPING,
    ) -> None:
        """Start the discovery of subscribers.

        Args:
            dds: DDS participant; the caller closes it.
            namespace: Namespace of the robot, with a leading slash; or empty.
            remapping: Topics with another name.
        """
        self._dds = dds
        self._name = ros_topic(namespace, COMMAND, remapping)
        self._topic = dds_topic(namespace, COMMAND, remapping)
        self._subscribers = Endpoints(dds, self._topic, writers=False)
        self._writers: dict[type[Any], Any] = {}

    def hindrance(self) -> str:
        """Return why no command would be received; empty if one would."""
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
        """Publish a command.

        Args:
            velocity: Velocity command.
            header: Time of the robot's clock and frame of its base, for
                stamped commands.
        """
        self._prepare()
        twist = Twist(
            vector(velocity.forward, velocity.lateral),
            vector(z=velocity.turn),
        )
        for kind, writer in self._writers.items():
            writer.write(
                twist if kind is Twist else TwistStamped(header, twist)
            )

    def _prepare(self) -> set[str]:
        """Create missing writers, and return the subscribers' types."""
        kinds = {ros_type(kind) for kind in self._subscribers.types}
        for kind in KINDS:
            if ros_name(kind) in kinds and kind not in self._writers:
                self._writers[kind] = self._dds.writer(self._topic, kind)
                log.info("%s is subscribed as %s", self._name, ros_name(kind))
        return kinds


class CommandReader:
    """Subscriber of the commands to a served robot, one type at a time.

    So a commander that writes each subscribed type sends each command once.
    """

    def __init__(self, dds: DdsParticipant, namespace: str) -> None:
        """Subscribe to ``Twist``.

        Args:
            dds: DDS participant; the caller closes it.
            namespace: Namespace of the robot, with a leading slash; or empty.
        """
        self._dds, self._topic = dds, dds_topic(namespace, COMMAND)
        self._publishers = Endpoints(dds, self._topic, writers=True)
        self._subscribe(Twist)

    def commanders(self) -> set[int]:
        """Return the handles of all publishers of commands."""
        found = self._reader.get_matched_publications()
        return {handle % HANDLES for handle in found}

    def taken(self) -> list[tuple[int, Twist]]:
        """Return each command that has arrived, after its sender's handle."""
        return [
            (
                sample.sample_info.publication_handle % HANDLES,
                sample if self._kind is Twist else sample.twist,
            )
            for sample in take_messages(self._reader)
        ]

    def choose(self) -> None:
        """Subscribe to a type that is published, if the present one is not.

        Call this only while there is no commander.
        """
        written = {ros_type(kind) for kind in self._publishers.types}
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
    """Return the name of a message in ROS, such as ``geometry_msgs/Twist``."""
    return ros_type(kind.__idl__.idl_transformed_typename)


def ros_type(name: str) -> str:
    """Convert a type name from DDS to ROS; return others unchanged."""
    package, _, rest = name.partition("::")
    middle, _, message = rest.rpartition("::")
    if middle != "msg::dds_" or not message.endswith("_"):
        return name
    return f"{package}/{message.removesuffix('_')}"
