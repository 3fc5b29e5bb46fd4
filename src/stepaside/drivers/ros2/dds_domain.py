"""DDS participant, by default announced on this machine only."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from threading import RLock
from typing import Any

from ...core.errors import ConfigurationError
from . import messages  # its error names the extra to install without DDS

from cyclonedds.core import DDSException, Policy, Qos  # isort: skip
from cyclonedds.domain import DomainParticipant  # isort: skip
from cyclonedds.pub import DataWriter  # isort: skip
from cyclonedds.sub import DataReader  # isort: skip
from cyclonedds.topic import Topic  # isort: skip

SETTING = "CYCLONEDDS_URI"
CREATION = RLock()  # topics that are created concurrently may fail
MAX_DOMAIN = 232  # last domain number for which ports exist
LOCAL = (
    "ROS 2 topics are announced on this machine only: start its ROS 2 "
    "programs with ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST; --network "
    "reaches others. CycloneDDS opens its UDP ports on all interfaces all "
    "the same: close them by a firewall on a network that others use"
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
LOCALHOST = """
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
    """Participant of a DDS domain, with its topics."""

    def __init__(
        self,
        domain: int | None = None,
        *,
        beyond: bool = False,
        tag: str = "",
    ) -> None:
        """Join a domain.

        Args:
            domain: Domain number; ``ROS_DOMAIN_ID``, or 0, by default.
            beyond: Whether other machines are discovered, as configured by
                CycloneDDS's defaults or ``CYCLONEDDS_URI``.
            tag: Discovery tag: participants with another one are ignored.
                Separates concurrent tests.

        Raises:
            ConfigurationError: If the number is out of range or DDS fails.
        """
        number = _environment_domain() if domain is None else domain
        if not 0 <= number <= MAX_DOMAIN:
            raise ConfigurationError(
                f"domain must lie in [0, {MAX_DOMAIN}], got {number}"
            )
        base = (
            os.environ.get(SETTING, "")
            if beyond
            else LOCALHOST.format(tag=tag)
        )
        with CREATION, _configured(base, COMPATIBLE):
            try:
                self.participant = DomainParticipant(number)
            except DDSException as error:
                raise ConfigurationError(
                    f"DDS cannot start: {error}"
                ) from error
        self._number, self._beyond = number, beyond
        self._topics: dict[tuple[str, type[Any]], Any] = {}

    @property
    def reach(self) -> str:
        """Sentence on which programs can be discovered, and how to change it.

        Programs that are not are neither heard nor named anywhere, so users
        need to know.
        """
        if self._beyond:
            return (
                f"searched domain {self._number} of the network; ROS 2 "
                f"programs must have ROS_DOMAIN_ID={self._number} and must "
                "not have ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST or "
                "ROS_LOCALHOST_ONLY=1"
            )
        return (
            f"searched domain {self._number} of this machine only; ROS 2 "
            f"programs here must have ROS_DOMAIN_ID={self._number} and "
            "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST (Humble: "
            "ROS_LOCALHOST_ONLY=1), and those of other machines need "
            "--network"
        )

    def register(self, topic: str, kind: type[Any]) -> None:
        """Create a topic in advance, so that its first writer starts faster.

        Args:
            topic: Name of the topic on DDS.
            kind: Type of its messages.
        """
        with CREATION:
            self._topic(topic, kind)

    def writer(
        self,
        topic: str,
        kind: type[Any],
        depth: int = 1,
        *,
        latched: bool = False,
    ) -> Any:
        """Create a reliable writer of a topic.

        Args:
            topic: Name of the topic on DDS.
            kind: Type of its messages.
            depth: Messages queued for slow readers.
            latched: Whether later readers receive the last message, too
                (durability "transient local").
        """
        durability = Policy.Durability.Volatile
        if latched:
            durability = Policy.Durability.TransientLocal
        qos = Qos(
            durability,
            Policy.Reliability.Reliable(0),
            Policy.History.KeepLast(depth),
            Policy.DataRepresentation(use_cdrv0_representation=True),
        )
        with CREATION:
            return DataWriter(
                self.participant, self._topic(topic, kind), qos=qos
            )

    def reader(
        self,
        topic: str,
        kind: type[Any],
        depth: int = 10,
        *,
        latched: bool = False,
    ) -> Any:
        """Create a best-effort reader, which matches writers of any QoS.

        Args:
            topic: Name of the topic on DDS.
            kind: Type of its messages.
            depth: Messages queued until they are taken.
            latched: Whether to receive the last message of a latched writer
                that wrote before; only such writers match.
        """
        quality = [Policy.Reliability.BestEffort]
        if latched:
            quality = [
                Policy.Reliability.Reliable(0),
                Policy.Durability.TransientLocal,
            ]
        qos = Qos(
            *quality,
            Policy.History.KeepLast(depth),
            Policy.DataRepresentation(use_cdrv0_representation=True),
        )
        with CREATION:
            return DataReader(
                self.participant, self._topic(topic, kind), qos=qos
            )

    def _topic(self, name: str, kind: type[Any]) -> Any:
        key = name, kind
        if key not in self._topics:
            self._topics[key] = Topic(self.participant, name, kind)
        return self._topics[key]

    def close(self) -> None:
        """Leave the domain, even if readers or writers are still referenced.

        A participant that stays alive would impose its configuration on all
        later participants of this domain in this process.
        """
        with CREATION:
            self._topics.clear()
            self.participant.__del__()  # CycloneDDS has no method to close
        del self.participant


def take_messages(reader: Any) -> list[Any]:
    """Take the messages that have arrived, oldest first, without waiting.

    Samples without data, which announce a change of a writer, are dropped.
    """
    try:
        samples = reader.take(N=64)
    except DDSException:
        return []
    return [s for s in samples if s.sample_info.valid_data]


@contextmanager
def _configured(*parts: str) -> Iterator[None]:
    """Set the configuration for the first participant of a domain.

    Args:
        parts: Names of files, or documents; later ones take precedence.
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


def _environment_domain() -> int:
    text = os.environ.get("ROS_DOMAIN_ID", "0") or "0"
    if not text.isascii() or not text.isdigit():
        raise ConfigurationError(
            f"ROS_DOMAIN_ID must be a whole number, got {text!r}"
        )
    return int(text)


__all__ = ["DdsParticipant", "messages", "take_messages"]
