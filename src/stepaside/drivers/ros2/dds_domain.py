"""Joining DDS: on this machine alone, unless told otherwise."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from threading import RLock
from typing import Any

from ...core.errors import ConfigurationError
from . import messages  # says what to install where there is no DDS

from cyclonedds.core import DDSException, Policy, Qos  # isort: skip
from cyclonedds.domain import DomainParticipant  # isort: skip
from cyclonedds.pub import DataWriter  # isort: skip
from cyclonedds.sub import DataReader  # isort: skip
from cyclonedds.topic import Topic  # isort: skip

SETTING = "CYCLONEDDS_URI"
MAKING = RLock()  # two topics that are made at once may fail, one of them
LONGEST_DOMAIN = 232  # number of the last domain that has ports
LOCAL = (
    "ROS 2 topics stay on this machine: start its ROS 2 programs with "
    "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST; --network reaches others"
)
# Fast DDS, vendor 1.15: version 3, of ROS 2 Kilted, describes types in a form
# that CycloneDDS takes for invalid, and then no endpoint of them is matched.
# ROS 2 itself matches types by their names.
COMPATIBLE = """
<CycloneDDS><Domain>
  <Compatibility>
    <IgnoreTypeInformation>1.15</IgnoreTypeInformation>
  </Compatibility>
</Domain></CycloneDDS>
"""
HERE = """
<CycloneDDS><Domain>
  <General>
    <Interfaces>
      <NetworkInterface name="lo" multicast="false"/>
    </Interfaces>
    <AllowMulticast>false</AllowMulticast>
  </General>
  <Discovery>
    <Tag>{tag}</Tag>
    <Peers><Peer address="127.0.0.1"/></Peers>
    <ParticipantIndex>auto</ParticipantIndex>
    <MaxAutoParticipantIndex>63</MaxAutoParticipantIndex>
  </Discovery>
</Domain></CycloneDDS>
"""


class DdsParticipant:
    """A participant, and what it reads and writes."""

    def __init__(
        self,
        domain: int | None = None,
        *,
        beyond: bool = False,
        tag: str = "",
    ) -> None:
        """Join a domain.

        Args:
            domain: Its number; that of ``ROS_DOMAIN_ID``, or 0, by default.
            beyond: Whether other machines may take part: then discovery is
                as CycloneDDS, or ``CYCLONEDDS_URI``, has it.
            tag: Only who has the same one is met; for tests.

        Raises:
            ConfigurationError: If there is no such domain, or DDS fails.
        """
        number = _number() if domain is None else domain
        if not 0 <= number <= LONGEST_DOMAIN:
            raise ConfigurationError(
                f"domain must lie in [0, {LONGEST_DOMAIN}], got {number}"
            )
        base = os.environ.get(SETTING, "") if beyond else HERE.format(tag=tag)
        with MAKING, _configured(base, COMPATIBLE):
            try:
                self.participant = DomainParticipant(number)
            except DDSException as error:
                raise ConfigurationError(
                    f"DDS cannot start: {error}"
                ) from error
        self._topics: dict[tuple[str, type[Any]], Any] = {}

    def register(self, topic: str, kind: type[Any]) -> None:
        """Make a topic known, so that its first writer is ready at once.

        Args:
            topic: Its name on DDS.
            kind: Of its messages.
        """
        with MAKING:
            self._topic(topic, kind)

    def writer(self, topic: str, kind: type[Any], depth: int = 1) -> Any:
        """Something that writes a topic, reliably.

        Args:
            topic: Its name on DDS.
            kind: Of its messages.
            depth: Messages kept for readers that are slow.
        """
        qos = Qos(
            Policy.Reliability.Reliable(0),
            Policy.History.KeepLast(depth),
            Policy.DataRepresentation(use_cdrv0_representation=True),
        )
        with MAKING:
            topic_of_it = self._topic(topic, kind)
            return DataWriter(self.participant, topic_of_it, qos=qos)

    def reader(self, topic: str, kind: type[Any], depth: int = 10) -> Any:
        """Something that reads a topic, whatever its writers promise.

        Args:
            topic: Its name on DDS.
            kind: Of its messages.
            depth: Messages kept until they are taken.
        """
        qos = Qos(
            Policy.Reliability.BestEffort,
            Policy.History.KeepLast(depth),
            Policy.DataRepresentation(use_cdrv0_representation=True),
        )
        with MAKING:
            topic_of_it = self._topic(topic, kind)
            return DataReader(self.participant, topic_of_it, qos=qos)

    def _topic(self, name: str, kind: type[Any]) -> Any:
        key = name, kind
        if key not in self._topics:
            self._topics[key] = Topic(self.participant, name, kind)
        return self._topics[key]

    def close(self) -> None:
        """Leave the domain, whoever still holds a reader or a writer.

        A participant that lives on keeps the configuration of its domain for
        all that come after it in this process.
        """
        with MAKING:
            self._topics.clear()
            self.participant.__del__()  # there is no other way to say it
        del self.participant


def taken(reader: Any) -> list[Any]:
    """Messages that have arrived, without waiting, oldest first.

    What only says that a writer came or went is none.
    """
    try:
        samples = reader.take(N=64)
    except DDSException:
        return []
    return [s for s in samples if s.sample_info.valid_data]


@contextmanager
def _configured(*parts: str) -> Iterator[None]:
    """Configure the domain that the first participant of a process makes.

    Args:
        parts: Files or documents; what a later one says counts.
    """
    before = os.environ.get(SETTING)
    lines = ("".join(part.split("\n")) for part in parts if part)
    os.environ[SETTING] = ",".join(lines)
    try:
        yield
    finally:
        if before is not None:
            os.environ[SETTING] = before
        else:
            os.environ.pop(SETTING, None)


def _number() -> int:
    text = os.environ.get("ROS_DOMAIN_ID", "0") or "0"
    if not text.isascii() or not text.isdigit():
        raise ConfigurationError(
            f"ROS_DOMAIN_ID must be a whole number, got {text!r}"
        )
    return int(text)


__all__ = ["DdsParticipant", "messages", "taken"]
