"""Robot on ROS 2 topics that walks at velocities, and its people.

Reads ``odom``, ``tf`` and the topics of ``ros2_people.toml``; writes
``cmd_vel`` as ``Twist`` or ``TwistStamped``, whichever the robot subscribes
to: on DDS a writer of one type does not match a reader of the other, without
any error. Commands carry the stamp of the newest odometry, as robots reject
stamps that are old by their clock.
"""

import logging
import tomllib
from collections.abc import Callable, Sequence
from functools import partial
from math import atan2, hypot, inf, isfinite, isnan
from operator import attrgetter
from pathlib import Path
from time import monotonic, sleep
from typing import Any, NamedTuple

import numpy as np

from ..core.errors import ConfigurationError
from ..core.history import History
from ..core.poses import Array, Pose
from ..core.rotations import rotation_of
from ..perception.measurement import RobotState, Sighting
from .robot import REST, VelocityLimits, VelocityRobot
from .robot_loader import RobotRequest
from .ros2_dds import (
    DdsParticipant,
    Endpoints,
    define,
    header,
    make,
    message_type,
    parse_namespace,
    seconds,
    take_messages,
    vector,
)

ODOMETRY, COMMAND, IDEAL = "odom", "cmd_vel", "ideal_sight"
KINDS = ("geometry_msgs/Twist", "geometry_msgs/TwistStamped")
PEOPLE = Path(__file__).with_name("ros2_people.toml")
PATIENCE, POLL = 0.05, 0.001  # for odometry, and between two looks, in [s]
STOP_COUNT = 5  # commands of zero velocity at the end of a session
STOP_PAUSE = 0.02  # between two of them, in [s]
STANDSTILL = 3.0  # of zero commands when control has died, in [s]
HINT_AFTER = 3.0  # without any publisher of odometry, in [s]
POSE_MEMORY = 2.0  # how long past poses are stored, in [s]
FAULT_AGE = 0.5  # at which a position without a frame no longer counts, in [s]
HELD = 0.5  # age at which a message of a switch no longer counts, in [s]
DEEPEST = 32  # frames from one to the root of a tree
log = logging.getLogger(__name__)


class PeopleTopic(NamedTuple):
    """Topic that says where people are; see ``ros2_people.toml``."""

    name: str
    type: str
    position: str
    each: str = ""
    classes: str = ""

    def nearest(self, message: Any, kind: str) -> Any:
        """Return the nearest position that counts, in [m], or None."""
        place = attrgetter(self.position)
        if not self.each:
            return place(message)
        found = []
        for each in attrgetter(self.each)(message):
            if kind and self.classes:
                scored = [r.hypothesis for r in getattr(each, self.classes)]
                best = max(scored, key=lambda h: h.score, default=None)
                if best is None or best.class_id != kind:
                    continue
            found.append(place(each))
        finite = [p for p in found if isfinite(p.x) and isfinite(p.y)]
        return min(finite, key=lambda p: hypot(p.x, p.y), default=None)


def read_people(files: Sequence[str]) -> list[PeopleTopic]:
    """Read tables of topics with people."""
    rows: dict[str, PeopleTopic] = {}
    for file in (PEOPLE, *map(Path, files)):
        try:
            text = file.read_text(encoding="utf-8")
            for entry in tomllib.loads(text)["topics"]:
                define(entry.pop("messages", {}))
                row = PeopleTopic(**entry)
                message_type(row.type)
                rows[row.name] = row
        except (OSError, KeyError, TypeError, ValueError) as error:
            raise ConfigurationError(f"people of {file}: {error}") from error
    return list(rows.values())


def parse_remapping(rules: Sequence[str], names: set[str]) -> dict[str, str]:
    """Parse rules like ``cmd_vel:=/nav/cmd_vel``; topics by name."""
    found: dict[str, str] = {}
    for rule in rules:
        name, separator, topic = rule.partition(":=")
        if name not in names or not separator or not topic.strip("/"):
            raise ConfigurationError(
                f"remap must be NAME:=/TOPIC with NAME one of "
                f"{', '.join(sorted(names))}, got {rule!r}"
            )
        if name in found:
            raise ConfigurationError(f"remap has two topics for {name}")
        found[name] = parse_namespace(topic)
    return found


class CommandWriter:
    """Publisher of commands in each type that has a subscriber.

    A writer is created when the first subscriber of its type is discovered.
    """

    def __init__(self, dds: DdsParticipant, topic: str) -> None:
        """Start the discovery of subscribers of a topic."""
        self._dds, self._topic = dds, topic
        self._subscribers = Endpoints(dds, topic, writers=False)
        self._writers: dict[str, Any] = {}

    def hindrance(self) -> str:
        """Return why no command would be received; empty if one would."""
        kinds = self._prepare()
        if not kinds:
            return f"nothing subscribes to {self._topic}"
        if not kinds.intersection(KINDS):
            found, wanted = " and ".join(sorted(kinds)), " or ".join(KINDS)
            return f"{self._topic} is subscribed as {found}, not as {wanted}"
        writers = self._writers.values()
        if not any(each.get_matched_subscriptions() for each in writers):
            return (
                f"no subscriber of {self._topic} accepts messages that are "
                "reliable and volatile"
            )
        return ""

    def write(
        self, forward: float, lateral: float, turn: float, head: Any
    ) -> None:
        """Publish a velocity, in [m/s] and [rad/s]."""
        self._prepare()
        twist = make(KINDS[0], vector(forward, lateral), vector(z=turn))
        for kind, writer in self._writers.items():
            stamped = kind != KINDS[0]
            writer.write(make(kind, head, twist) if stamped else twist)

    def _prepare(self) -> set[str]:
        """Create missing writers, and return the subscribers' types."""
        kinds = self._subscribers.types
        for kind in KINDS:
            if kind in kinds and kind not in self._writers:
                name = kind.replace("/", "/msg/")
                self._writers[kind] = self._dds.writer(self._topic, name)
                log.info("%s is subscribed as %s", self._topic, kind)
        return kinds


class FrameTree:
    """Newest transforms between frames, from ``/tf`` and ``/tf_static``."""

    def __init__(self, dds: DdsParticipant) -> None:
        """Subscribe."""
        kind = "tf2_msgs/msg/TFMessage"
        self._readers = [
            dds.reader("/tf", kind, 100),
            dds.reader("/tf_static", kind, 100, latched=True),
        ]
        self._parents: dict[str, tuple[str, Array]] = {}

    def read(self) -> None:
        """Take the transforms that have arrived."""
        for reader in self._readers:
            for message in take_messages(reader):
                for each in message.transforms:
                    move, turn = each.transform.translation, np.eye(4)
                    q = each.transform.rotation
                    turn[:3, :3] = rotation_of((q.w, q.x, q.y, q.z))
                    turn[:3, 3] = move.x, move.y, move.z
                    if np.isfinite(turn).all():
                        parent = each.header.frame_id
                        self._parents[each.child_frame_id] = parent, turn

    def up(self, frame: str, ends: Sequence[str] = ()) -> tuple[str, Array]:
        """Return an ancestor of a frame, or the root, and its transform."""
        turn: Array = np.eye(4)
        for _ in range(DEEPEST):
            if frame in ends or frame not in self._parents:
                break
            frame, own = self._parents[frame]
            turn = own @ turn
        return frame, turn


class Ros2Robot(VelocityRobot):
    """Robot in a ROS 2 namespace."""

    def __init__(
        self,
        request: RobotRequest,
        namespace: str,
        people: Sequence[PeopleTopic],
        remapping: dict[str, str],
    ) -> None:
        """Make a robot; see :func:`make_robot`."""
        self.limits = VelocityLimits(lateral=request.lateral)
        self._request, self._people = request, people
        self._namespace, self._remapping = namespace, remapping
        self._commands: CommandWriter | None = None
        self._head, self._stamp = header(0.0, ""), 0.0
        self._poses: History[Pose] = History(POSE_MEMORY)
        self._sighting: Sighting | None = None
        self._fault, self._fault_ends = "", -inf
        self._faulty = ""  # topic of the fault
        self._warned: set[str] = set()

    def open(self) -> None:
        """Subscribe to the robot's topics; no writer is created."""
        request, topic = self._request, self._topic
        self._dds = dds = DdsParticipant(
            request.domain, beyond=request.network
        )
        self._odometry = dds.reader(topic(ODOMETRY), "nav_msgs/msg/Odometry")
        self._publishers = Endpoints(dds, topic(ODOMETRY), writers=True)
        self._others = Endpoints(dds, topic(COMMAND), writers=True)
        self._frames = FrameTree(dds)
        self._sights = [
            (row, dds.reader(topic(row.name), row.type))
            for row in self._people
        ]
        self._hint_at = monotonic() + HINT_AFTER

    def prepare(self) -> None:
        """Find the subscribers of commands."""
        self._commands = CommandWriter(self._dds, self._topic(COMMAND))

    def listen(self) -> RobotState | None:
        """Return the newest odometry, with the newest sighting."""
        deadline = monotonic() + PATIENCE
        while not (arrived := take_messages(self._odometry)):
            self._hint()
            if monotonic() >= deadline:
                return None
            sleep(POLL)
        self._hint_at = inf
        odometry = arrived[-1]
        point, q = odometry.pose.pose.position, odometry.pose.pose.orientation
        turn = rotation_of((q.w, q.x, q.y, q.z))
        heading = float(np.arctan2(turn[1, 0], turn[0, 0]))
        pose = Pose(point.x, point.y, heading)
        self._stamp = time = seconds(odometry.header.stamp)
        frames = odometry.header.frame_id, odometry.child_frame_id
        self._head = make("std_msgs/Header", odometry.header.stamp, frames[1])
        self._poses.note(time, pose)
        self._frames.read()
        for row, reader in self._sights:
            for message in take_messages(reader):
                self._note(row, message, *frames)
        hindrance = self._odometry_fault(pose) or self._hindrance()
        return RobotState(
            time, sighting=self._sighting, pose=pose, hindrance=hindrance
        )

    def command(self, forward: float, lateral: float, turn: float) -> None:
        """Publish a velocity."""
        assert self._commands is not None  # prepare() was called
        self._commands.write(forward, lateral, turn, self._head)

    def stop(self) -> None:
        """Publish zero; in the guardian, for a while without a stamp."""
        if self._commands is not None:
            self._commands.write(*REST, self._head)
            return
        # A writer created before would have counted as a second commander.
        commands = CommandWriter(self._dds, self._topic(COMMAND))
        for _ in range(round(STANDSTILL / STOP_PAUSE)):
            commands.write(*REST, self._head)
            sleep(STOP_PAUSE)

    def close(self) -> None:
        """Publish zero several times, and leave DDS."""
        if self._commands is not None:
            for _ in range(STOP_COUNT - 1):
                sleep(STOP_PAUSE)
                self.stop()
        self._commands = None
        del self._odometry, self._sights, self._others, self._publishers
        del self._frames
        self._dds.close()

    def _topic(self, name: str) -> str:
        if name.startswith("/"):
            return name
        return self._remapping.get(name, f"{self._namespace}/{name}")

    def _hint(self) -> None:
        """Log once why there may be no odometry, if there never was any."""
        if monotonic() < self._hint_at:
            return
        self._hint_at = inf
        name, types = self._topic(ODOMETRY), self._publishers.types
        if not types:
            log.warning("nothing publishes %s; %s", name, self._dds.reach)
            return
        kinds = " and ".join(sorted(types))
        log.warning(
            "%s is published as %s, but no message arrives", name, kinds
        )

    def _odometry_fault(self, pose: Pose) -> str:
        """Return which field of the odometry is not filled, if any."""
        name = self._topic(ODOMETRY)
        if self._stamp == 0.0:
            return f"{name} has no stamp: header.stamp is 0"
        if isnan(pose.theta):
            return (
                f"{name} has no heading: pose.orientation is zero or not "
                "finite"
            )
        return ""

    def _hindrance(self) -> str:
        """Return why the robot must not move; empty if it may."""
        if self._commands and (reason := self._commands.hindrance()):
            return reason
        if others := self._others.participants:
            return f"{others} others command this robot"
        return self._fault if self._stamp < self._fault_ends else ""

    def _note(
        self, row: PeopleTopic, message: Any, fixed: str, base: str
    ) -> None:
        """Convert the nearest person of a message to a sighting."""
        if row.name == IDEAL and IDEAL not in self._warned:
            self._warned.add(IDEAL)
            log.warning("uses the ideal line of sight of %s",
                        self._namespace or "/")  # fmt: skip
        point = row.nearest(message, self._request.opponent)
        if row.name == self._faulty:
            self._fault_ends = -inf
        frame = message.header.frame_id
        ancestor, turn = self._frames.up(frame, (fixed, base))
        if ancestor not in (fixed, base):
            root, own = self._frames.up(fixed)
            if root == ancestor:
                ancestor, turn = fixed, np.linalg.inv(own) @ turn
        if ancestor not in (fixed, base):
            if frame and not frame.rpartition("/")[2].startswith("base"):
                self._faulty = row.name
                self._fault_ends = self._stamp + FAULT_AGE
                self._fault = (
                    f"{row.name} are in {frame}, which tf does not connect "
                    f"with {base} or {fixed}"
                )
                return
            turn = np.eye(4)  # the robot's own, by a name like base_link
        if point is None:
            return
        time = seconds(message.header.stamp)
        place = turn @ [point.x, point.y, point.z, 1.0]
        x, y = float(place[0]), float(place[1])
        if ancestor == fixed:
            back = self._poses.at(time).inverse()
            x, y, _ = back.compose(Pose(x, y, 0.0))
        self._sighting = Sighting(time, atan2(y, x), hypot(x, y))


def make_robot(request: RobotRequest) -> Callable[[], Ros2Robot]:
    """Return a function that makes the robot at ``ros2:/NAMESPACE``."""
    people = read_people(request.people)
    names = {row.name for row in people} - {IDEAL} | {ODOMETRY, COMMAND}
    remapping = parse_remapping(request.remap, names)
    namespace = parse_namespace(request.address)
    return partial(Ros2Robot, request, namespace, people, remapping)


class TopicSwitch:
    """Dead-man switch on a topic of ``std_msgs/Bool``."""

    def __init__(
        self,
        dds: DdsParticipant,
        topic: str,
        clock: Callable[[], float] = monotonic,
    ) -> None:
        """Subscribe to a topic."""
        self._dds, self._topic, self._clock = dds, topic, clock
        self._reader = dds.reader(topic, "std_msgs/msg/Bool")
        self._held_until = -1.0

    def released(self) -> str:
        """Return why the robot must stand; empty while true is received."""
        now = self._clock()
        for message in take_messages(self._reader):
            self._held_until = now + HELD if message.data else -1.0
        if not self._reader.get_matched_publications():
            self._held_until = -1.0  # the publisher has left
        if now <= self._held_until:
            return ""
        return f"dead-man switch: {self._topic} is not true"

    def close(self) -> None:
        """Unsubscribe and leave DDS."""
        del self._reader
        self._dds.close()
