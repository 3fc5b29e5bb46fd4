"""Dead-man switch on a ROS 2 topic."""

from collections.abc import Callable
from time import monotonic

from .dds_domain import DdsParticipant, take_messages
from .messages import Bool
from .topics import dds_topic

AGE = 0.5  # at which a message no longer counts, in [s]


class TopicSwitch:
    """Topic of ``std_msgs/Bool``, published while an operator holds it."""

    def __init__(
        self,
        dds: DdsParticipant,
        topic: str,
        clock: Callable[[], float] = monotonic,
    ) -> None:
        """Subscribe to a topic.

        Args:
            dds: DDS participant; closed with the switch.
            topic: Topic like ``/operator/hold``.
            clock: Time of this computer, in [s].
        """
        self._dds, self._topic, self._clock = dds, topic, clock
        self._reader = dds.reader(dds_topic("", topic.strip("/")), Bool)
        self._held_until = -1.0

    def released(self) -> str:
        """Return why the robot must stand; empty while true is received."""
        now = self._clock()
        for message in take_messages(self._reader):
            self._held_until = now + AGE if message.data else -1.0
        if not self._reader.get_matched_publications():
            self._held_until = -1.0  # the publisher has left
        if now <= self._held_until:
            return ""
        return f"dead-man switch: {self._topic} is not true"

    def close(self) -> None:
        """Unsubscribe and leave DDS."""
        del self._reader
        self._dds.close()
