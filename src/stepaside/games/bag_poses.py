"""Planar poses of players from a ROS 2 bag: frames of tf, or pose topics."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from math import atan2
from pathlib import Path
from typing import Any

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Array
from ..core.rotations import rotation_of

MOVING, STATIC = "/tf", "/tf_static"
MOST_LISTED = 12  # names in a message
SHUFFLED = 1.0  # by which stamps may be out of order, in [s]
# Path to the pose in messages with a header, by type.
POSE_FIELDS = {
    "nav_msgs/msg/Odometry": ("pose", "pose"),
    "geometry_msgs/msg/PoseStamped": ("pose",),
    "geometry_msgs/msg/PoseWithCovarianceStamped": ("pose", "pose"),
}


@dataclass(frozen=True, slots=True, eq=False)
class PoseSeries:
    """Poses of one player over time.

    Attributes:
        world: Frame in which the poses are.
        times: Increasing times, in [s]. Shape (n,).
        positions: Positions (x, y, z), in [m]. Shape (n, 3).
        headings: Unwrapped headings, in [rad]. Shape (n,).
        invalid: Number of poses that were left out: not finite, or with a
            zero rotation.
    """

    world: str
    times: Array
    positions: Array
    headings: Array
    invalid: int


def read_poses(bag: Path, sources: Mapping[str, str]) -> dict[str, PoseSeries]:
    """Read the poses of players from a bag.

    Times are those of the headers; where no header of a player has one,
    those of recording.

    Args:
        bag: Folder of a ROS 2 bag, or a file in MCAP or SQLite.
        sources: Frame, or topic if it begins with a slash, by player.

    Raises:
        ConfigurationError: If the bag cannot be read, or a frame or topic
            is not in it or holds no valid pose.
        ModuleNotFoundError: If rosbags is not installed.
    """
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    try:
        with AnyReader([bag], default_typestore=store) as reader:
            return _read(reader, sources, bag.name)
    except ConfigurationError:
        raise
    except Exception as error:  # of damaged files, of many kinds
        raise ConfigurationError(
            f"{bag} must be a ROS 2 bag: a folder with metadata.yaml, or a "
            f".mcap or .db3 file, got: {error}"
        ) from error


def _read(
    reader: Any, sources: Mapping[str, str], name: str
) -> dict[str, PoseSeries]:
    kinds = {c.topic: c.msgtype for c in reader.connections}
    for player, source in sources.items():
        kind = kinds.get(source)
        if source.startswith("/") and kind not in POSE_FIELDS:
            raise ConfigurationError(
                f"{player}={source} must be a topic of "
                f"{', '.join(POSE_FIELDS)}, got {kind} in {name}: "
                f"{_listed(kinds)}"
            )
    frames = {p: s for p, s in sources.items() if not s.startswith("/")}
    above: dict[str, tuple[str, Array]] = {}  # parent and pose in it
    rows: dict[str, list[tuple[float, ...]]] = {p: [] for p in sources}
    worlds: dict[str, set[str]] = {p: set() for p in sources}
    # Static transforms hold from the beginning.
    static = {STATIC} if frames else set()
    moving = {*sources.values(), *((MOVING,) if frames else ())}
    for topic, kind, time, message in chain(
        _messages(reader, static), _messages(reader, moving)
    ):
        if topic in (STATIC, MOVING):
            changed = _place(message, above)
            for player, frame in frames.items():
                links, root, pose = _pose_of(frame, above)
                stamps = [changed[link] for link in links if link in changed]
                if stamps and topic == MOVING:
                    worlds[player].add(root)
                    rows[player].append(_row(max(stamps), time, pose))
            continue
        for player, source in sources.items():
            if source == topic:
                own = message
                for field in POSE_FIELDS[kind]:
                    own = getattr(own, field)
                worlds[player].add(message.header.frame_id)
                pose = _matrix(own.position, own.orientation)
                rows[player].append(_row(_stamp(message), time, pose))
    known = dict.fromkeys(n for c, (p, _) in above.items() for n in (p, c))
    for player, source in sources.items():
        if not rows[player]:
            raise ConfigurationError(
                f"{player}={source} must be a frame of {name}: "
                f"{_listed(known)}"
            )
    return {
        player: _series(player, worlds[player], found)
        for player, found in rows.items()
    }


def _place(
    message: Any, above: dict[str, tuple[str, Array]]
) -> dict[str, float]:
    """Take transforms; return each child with its time, in [s]."""
    placed = {}
    for each in message.transforms:
        child = each.child_frame_id.removeprefix("/")
        step = _matrix(each.transform.translation, each.transform.rotation)
        above[child] = each.header.frame_id.removeprefix("/"), step
        placed[child] = _stamp(each)
    return placed


def _pose_of(
    frame: str, above: Mapping[str, tuple[str, Array]]
) -> tuple[list[str], str, Array]:
    """Return the frames up to the root, the root, and the pose in it."""
    links: list[str] = []
    pose: Array = np.eye(4)
    while frame in above and frame not in links:
        links.append(frame)
        frame, step = above[frame]
        pose = step @ pose
    return links, frame, pose


def _messages(
    reader: Any, topics: set[str]
) -> Iterator[tuple[str, str, float, Any]]:
    """Yield topic, type, time of recording in [s], and message."""
    chosen = [c for c in reader.connections if c.topic in topics]
    if not chosen:
        return  # the reader would yield all
    for connection, stamp, raw in reader.messages(chosen):
        message = reader.deserialize(raw, connection.msgtype)
        yield connection.topic, connection.msgtype, 1e-9 * stamp, message


def _stamp(message: Any) -> float:
    """Return the time of a header, in [s]."""
    stamp = message.header.stamp
    return float(stamp.sec) + 1e-9 * float(stamp.nanosec)


def _matrix(position: Any, rotation: Any) -> Array:
    """Return a pose as a homogeneous matrix; NaN if it is invalid."""
    matrix = np.eye(4)
    matrix[:3, :3] = rotation_of(
        (rotation.w, rotation.x, rotation.y, rotation.z)
    )
    matrix[:3, 3] = position.x, position.y, position.z
    return matrix


def _row(stamp: float, time: float, pose: Array) -> tuple[float, ...]:
    """Return both times, position and heading of a pose."""
    x, y, z = pose[:3, 3].tolist()
    return stamp, time, x, y, z, atan2(pose[1, 0], pose[0, 0])


def _series(
    player: str, worlds: set[str], rows: list[tuple[float, ...]]
) -> PoseSeries:
    """Return the poses of one player, in the order of their times."""
    if len(worlds) > 1:
        raise ConfigurationError(
            f"poses of {player} must all be in one frame, got "
            f"{_listed(dict.fromkeys(sorted(worlds)))}"
        )
    table = np.array(rows)
    valid = np.isfinite(table).all(axis=1)
    table = table[valid]
    # Without stamps, the times of recording must do.
    times = table[:, 0] if table[:, 0].any() else table[:, 1]
    back = np.maximum.accumulate(times) - times
    if (back > SHUFFLED).any():
        at = int(back.argmax())
        raise ConfigurationError(
            f"stamps of {player} must not go back, got {back[at]:.2f} s back "
            f"at {times[at]:.2f} s: cut the bag where its clock was reset"
        )
    times, kept = np.unique(times, return_index=True)
    table = table[kept]
    if len(table) < 2:
        raise ConfigurationError(
            f"poses of {player} must be finite with a rotation that is not "
            f"zero at 2 times at least, got {len(table)} of {len(rows)}"
        )
    headings = np.unwrap(table[:, 5])
    (world,) = worlds
    invalid = int((~valid).sum())
    return PoseSeries(world, times, table[:, 2:5], headings, invalid)


def _listed(names: Mapping[str, Any]) -> str:
    """Return the first names as text."""
    shown = list(names)[:MOST_LISTED]
    more = len(names) - len(shown)
    return ", ".join(shown) + (f" and {more} more" if more > 0 else "")
