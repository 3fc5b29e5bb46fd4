"""ROS 2 on DDS: message types, participant, endpoints of others, names.

Types are made from the definitions that rosbags has of ROS 2's messages.
Topics are announced on this machine only, by default.
"""

import os
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from threading import RLock
from typing import Any

from ..core.errors import ConfigurationError

try:
    from cyclonedds.builtin import (
        BuiltinDataReader,
        BuiltinTopicDcpsPublication,
        BuiltinTopicDcpsSubscription,
    )
    from cyclonedds.core import DDSException, Policy, Qos
    from cyclonedds.domain import DomainParticipant
    from cyclonedds.idl import make_idl_struct
    from cyclonedds.idl import types as idl
    from cyclonedds.pub import DataWriter
    from cyclonedds.sub import DataReader
    from cyclonedds.topic import Topic
    from rosbags.interfaces import Nodetype
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore
except ImportError as error:
    raise ConfigurationError(
        "ROS 2 topics need CycloneDDS and rosbags: pip install "
        "'stepaside[robot]'"
    ) from error

_NAME = re.compile(r"(/[A-Za-z_][A-Za-z0-9_]*)*")
SETTING = "CYCLONEDDS_URI"
CREATION = RLock()  # topics that are created concurrently may fail
MAX_DOMAIN = 232  # last domain number for which ports exist
BATCH = 64  # messages or announcements taken per call
LOCAL = (
    "ROS 2 topics are announced on this machine only: start its ROS 2 "
    "programs with ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST; --network "
    "of serve, or network=true of play, reaches others. CycloneDDS opens its "
    "UDP ports on all interfaces all the same: close them by a firewall on a "
    "network that others use"
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
    <Peers><Peer address="127.0.0.1"/></Peers>
    <ParticipantIndex>auto</ParticipantIndex>
    <MaxAutoParticipantIndex>63</MaxAutoParticipantIndex>
  </Discovery>
</Domain></CycloneDDS>
"""
STORE = get_typestore(Stores.ROS2_HUMBLE)
# ROS 2's uint8 is an octet in the IDL that it generates.
PLAIN = {
    **{"bool": bool, "string": str, "byte": idl.byte, "char": idl.byte},
    **{"uint8": idl.byte, "octet": idl.byte},
} | {
    name: getattr(idl, name)
    for name in (
        *("int8", "int16", "int32", "int64", "uint16", "uint32", "uint64"),
        *("float32", "float64"),
    )
}


def define(messages: Mapping[str, str]) -> None:
    """Define messages that ROS 2 itself does not have."""
    for name, text in messages.items():
        if name in STORE.fielddefs:
            continue
        try:
            STORE.register(get_types_from_msg(text, name))
        except Exception as error:  # rosbags raises many kinds of errors
            raise ConfigurationError(
                f"definition of {name} is invalid: {error}"
            ) from error


@cache
def message_type(name: str) -> Any:
    """Return the DDS type of a message, such as geometry_msgs/msg/Twist."""
    if name not in STORE.fielddefs:
        raise ConfigurationError(f"there is no definition of {name}")
    package, _, short = name.split("/")
    fields = {key: _field(kind) for key, kind in STORE.fielddefs[name][1]}
    typename = f"{package}.msg.dds_.{short}_"
    return make_idl_struct(short, typename, fields, dataclassify=True)


def _field(kind: Any) -> Any:
    form, about = kind
    if form == Nodetype.BASE:
        return PLAIN[about[0]]
    if form == Nodetype.NAME:
        return message_type(about)
    inner, count = _field(about[0]), about[1]
    if form == Nodetype.ARRAY:
        return idl.array[inner, count]
    return idl.sequence[inner]


def make(name: str, *values: Any) -> Any:
    """Return a message of a package's type, such as std_msgs/Bool."""
    return message_type(name.replace("/", "/msg/"))(*values)


def stamp_of(time: float) -> Any:
    """Return the stamp of a time in [s]."""
    return make("builtin_interfaces/Time", *divmod(round(1e9 * time), 10**9))


def seconds(stamp: Any) -> float:
    """Return the time of a stamp, in [s]."""
    return float(stamp.sec + 1e-9 * stamp.nanosec)


def header(time: float, frame: str) -> Any:
    """Return a header with a time in [s] and a frame."""
    return make("std_msgs/Header", stamp_of(time), frame)


def vector(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Any:
    """Return a Vector3."""
    return make("geometry_msgs/Vector3", x, y, z)


def ros_type(name: str) -> str:
    """Convert a type name from DDS to ROS; return others unchanged."""
    package, _, rest = name.partition("::")
    middle, _, message = rest.rpartition("::")
    if middle != "msg::dds_" or not message.endswith("_"):
        return name
    return f"{package}/{message.removesuffix('_')}"


def parse_namespace(text: str) -> str:
    """Parse ``/NAMESPACE`` or ``ros2:/NAMESPACE``; empty for the root."""
    name = text.removeprefix("ros2:").rstrip("/")
    name = name if not name or name.startswith("/") else f"/{name}"
    if not _NAME.fullmatch(name):
        raise ConfigurationError(
            "namespace must be /WORD or /WORD/WORD of letters, digits and "
            f"underscores, got {text!r}"
        )
    return name


class DdsParticipant:
    """Participant of a DDS domain, with its topics."""

    def __init__(
        self, domain: int | None = None, *, beyond: bool = False
    ) -> None:
        """Join a domain; beyond this machine, if wanted."""
        text = str(domain)
        if domain is None:
            text = os.environ.get("ROS_DOMAIN_ID", "0") or "0"
        number = int(text) if text.isdecimal() else -1
        if not 0 <= number <= MAX_DOMAIN:
            raise ConfigurationError(
                f"domain, or ROS_DOMAIN_ID, must be a whole number in "
                f"[0, {MAX_DOMAIN}], got {text!r}"
            )
        base = os.environ.get(SETTING, "") if beyond else LOCALHOST
        with CREATION, _configured(base, COMPATIBLE):
            try:
                self.participant = DomainParticipant(number)
            except DDSException as error:
                raise ConfigurationError(
                    f"DDS cannot start: {error}"
                ) from error
        self._number, self._beyond = number, beyond
        self._topics: dict[tuple[str, str], Any] = {}

    @property
    def reach(self) -> str:
        """Sentence on which programs can be discovered.

        Programs that are not are neither heard nor named anywhere.
        """
        where = "the network" if self._beyond else "this machine only"
        negation = " not" if self._beyond else ""
        return (
            f"searched domain {self._number} of {where}: ROS 2 programs must "
            f"have ROS_DOMAIN_ID={self._number} and{negation} "
            "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST (Humble: "
            "ROS_LOCALHOST_ONLY=1)"
        )

    def writer(
        self, topic: str, kind: str, depth: int = 1, *, latched: bool = False
    ) -> Any:
        """Create a reliable writer of a topic."""
        return self._end(DataWriter, topic, kind, depth, True, latched)

    def reader(
        self, topic: str, kind: str, depth: int = 10, *, latched: bool = False
    ) -> Any:
        """Create a best-effort reader, which matches writers of any QoS."""
        return self._end(DataReader, topic, kind, depth, latched, latched)

    def _end(
        self,
        end: Any,
        topic: str,
        kind: str,
        depth: int,
        reliable: bool,
        latched: bool,
    ) -> Any:
        qos = [
            Policy.Reliability.Reliable(0)
            if reliable
            else Policy.Reliability.BestEffort,
            Policy.History.KeepLast(depth),
            Policy.DataRepresentation(use_cdrv0_representation=True),
        ]
        if latched:
            qos.append(Policy.Durability.TransientLocal)
        key, name = (topic, kind), f"rt{topic}"  # the prefix is ROS 2's
        with CREATION:
            if key not in self._topics:
                known = message_type(kind)
                self._topics[key] = Topic(self.participant, name, known)
            return end(self.participant, self._topics[key], qos=Qos(*qos))

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
    return [s for s in _taken(reader) if s.sample_info.valid_data]


def _taken(reader: Any) -> list[Any]:
    try:
        found: list[Any] = reader.take(N=BATCH)
    except DDSException:
        return []
    return found


class Endpoints:
    """Endpoints of other participants on one topic, of any type.

    Includes endpoints whose type or QoS would not match, and creates no
    endpoint that others could match.
    """

    def __init__(
        self, dds: DdsParticipant, topic: str, *, writers: bool
    ) -> None:
        """Subscribe to the discovery of DDS."""
        builtin = BuiltinTopicDcpsSubscription
        if writers:
            builtin = BuiltinTopicDcpsPublication
        self._topic, self._own = f"rt{topic}", dds.participant.guid
        self._reader = BuiltinDataReader(dds.participant, builtin)
        self._found: dict[Any, tuple[Any, str]] = {}

    @property
    def participants(self) -> int:
        """Number of participants that have such an endpoint."""
        return len({participant for participant, _ in self._present()})

    @property
    def types(self) -> set[str]:
        """Types of the endpoints, as ROS names them."""
        return {ros_type(kind) for _, kind in self._present()}

    def _present(self) -> list[tuple[Any, str]]:
        """Return participant and type of each endpoint present now."""
        while arrived := _taken(self._reader):
            for sample in arrived:
                if not sample.sample_info.valid_data:
                    self._found.pop(sample.key, None)  # endpoint removed
                elif sample.topic_name == self._topic:
                    if sample.participant_key != self._own:
                        found = sample.participant_key, sample.type_name
                        self._found[sample.key] = found
        return list(self._found.values())


@contextmanager
def _configured(*parts: str) -> Iterator[None]:
    """Set files or documents for the first participant of a domain."""
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
