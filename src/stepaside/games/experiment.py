"""Experiments: a ROS 2 bag of players, recorded elsewhere, as a run."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain
from math import atan2
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Array
from ..core.rotations import rotation_of
from ..core.setting import CheckedSettings, setting
from .evaluation import measure
from .game import Outcome
from .player_settings import MOST_PLAYERS, PLAYER_NAME
from .run import Run
from .trajectory import Trajectory

NOTED_GAP = 0.5  # without a pose, from which on a note says so, in [s]
MOVING, STATIC = "/tf", "/tf_static"
MOST_LISTED = 12  # names in a message
SHUFFLED = 1.0  # by which stamps may be out of order, in [s]
# Path to the pose in messages with a header, by type.
POSE_FIELDS = {
    "nav_msgs/msg/Odometry": ("pose", "pose"),
    "geometry_msgs/msg/PoseStamped": ("pose",),
    "geometry_msgs/msg/PoseWithCovarianceStamped": ("pose", "pose"),
}
Link = tuple[str, Array]  # frame in which a pose is, and the pose, (4, 4)


@dataclass(frozen=True, slots=True)
class ExperimentSettings(CheckedSettings):
    """Settings of an experiment: its recording, and who is who in it."""

    game: ClassVar[str] = "experiment"
    cycle: ClassVar[float] = 1.0  # over which figures average the sway [s]
    source: str = setting("", "Name of the recording")
    frames: tuple[str, ...] = setting(
        (), "Players, as NAME=FRAME or NAME=/TOPIC"
    )
    world: str = setting("", "Frame in which all poses are")


def _parse_sources(words: tuple[str, ...]) -> dict[str, str]:
    """Parse words like ``pursuer=robot1/base_link``, at least two."""
    sources: dict[str, str] = {}
    for word in words:
        name, sign, source = word.partition("=")
        if not (sign and source and PLAYER_NAME.fullmatch(name)):
            raise ConfigurationError(
                "frame must be NAME=FRAME or NAME=/TOPIC with a name in "
                f"lower case, got {word!r:.80}"
            )
        if name in sources:
            raise ConfigurationError(f"frame of {name} must be given once")
        sources[name] = source
    if not 2 <= len(sources) <= MOST_PLAYERS:
        raise ConfigurationError(
            f"players of a bag must be 2 to {MOST_PLAYERS}, each as --frame "
            f"NAME=FRAME, got {len(sources)}"
        )
    return sources


def import_experiment(bag: Path, words: tuple[str, ...]) -> Run:
    """Read a bag as a run.

    The bag is a folder of ROS 2, or a file of one; words are players, at
    least two, as ``NAME=FRAME`` or ``NAME=/TOPIC``. Samples are at the times
    of the first player's poses, as far as all players have poses; those of
    the others are interpolated.

    Raises:
        ConfigurationError: If the bag lacks a frame or topic, the poses are
            not in one frame, or not at common times.
        ModuleNotFoundError: If rosbags is not installed.
    """
    worlds, rows = _read_bag(bag, _parse_sources(words))
    tables, notes = {}, []
    for player, found in rows.items():
        valid = found[np.isfinite(found).all(axis=1)]
        if invalid := len(found) - len(valid):
            notes.append(f"{player} has {invalid} invalid poses; left out")
        tables[player] = _table(player, valid, len(found))
    frames = [(p, w) for p, found in worlds.items() for w in sorted(found)]
    if len({world for _, world in frames}) > 1:
        listed = _listed(f"{player} in {world}" for player, world in frames)
        raise ConfigurationError(
            f"poses of all players must be in one frame, got {listed}"
        )
    first = next(iter(tables.values()))[:, 0]
    begin = max(table[0, 0] for table in tables.values())
    end = min(table[-1, 0] for table in tables.values())
    times = first[(first >= begin) & (first <= end)]
    if len(times) < 2:
        raise ConfigurationError(
            f"players of {bag.name} must have poses at common times, got "
            + ", ".join(
                f"{p} from {table[0, 0]:.1f} to {table[-1, 0]:.1f} s"
                for p, table in tables.items()
            )
        )
    tracks = {}
    for player, table in tables.items():
        x, y, z, heading = (
            np.interp(times, table[:, 0], column) for column in table.T[1:]
        )
        tracks[player] = Trajectory(
            com=np.column_stack([x, y, z]),
            torso=np.column_stack([x, y, heading]),
        )
        ends = [begin], np.clip(table[:, 0], begin, end), [end]
        gap = float(np.diff(np.concatenate(ends)).max())
        if gap > NOTED_GAP:
            notes.append(f"{player} has no pose for {gap:.2f} s; interpolated")
    elapsed, (_, world) = times - times[0], frames[0]
    run = Run(
        name=bag.stem or bag.name,
        settings=ExperimentSettings(bag.name, words, world),
        outcome=Outcome.COMPLETED,
        message=f"recorded {elapsed[-1]:.2f} s in {world}",
        duration=round(float(elapsed[-1]), 9),
        times=elapsed,
        tracks=tracks,
    )
    return replace(run, summary=replace(measure(run), notes=notes))


def _read_bag(
    bag: Path, sources: Mapping[str, str]
) -> tuple[dict[str, set[str]], dict[str, Array]]:
    """Return the frames of each player's poses, and the poses.

    Sources are frames, or topics that begin with a slash. Columns are the
    times of header and recording [s], x, y, z [m] and heading [rad].
    """
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    try:
        with AnyReader([bag], default_typestore=store) as reader:
            worlds, rows = _read(reader, sources, bag.name)
    except ConfigurationError:
        raise
    except Exception as error:  # of damaged files, of many kinds
        raise ConfigurationError(
            f"{bag} must be a ROS 2 bag: a folder with metadata.yaml, or a "
            f".mcap or .db3 file, got: {error}"
        ) from error
    return worlds, {player: np.array(found) for player, found in rows.items()}


def _read(
    reader: Any, sources: Mapping[str, str], name: str
) -> tuple[dict[str, set[str]], dict[str, list[tuple[float, ...]]]]:
    """Return the frames and the poses of each player, with both times."""
    kinds = {c.topic: c.msgtype for c in reader.connections}
    for player, source in sources.items():
        kind = kinds.get(source)
        if source.startswith("/") and kind not in POSE_FIELDS:
            raise ConfigurationError(
                f"{player}={source} must be a topic of "
                f"{', '.join(POSE_FIELDS)}, got {kind} in {name}: "
                f"{_listed(kinds)}"
            )
    above: dict[str, Link] = {}  # by frame or topic
    rows: dict[str, list[tuple[float, ...]]] = {p: [] for p in sources}
    worlds: dict[str, set[str]] = {p: set() for p in sources}
    in_frames = any(not s.startswith("/") for s in sources.values())
    # Static transforms hold from the beginning.
    static = {STATIC} if in_frames else set()
    moving = {*sources.values(), *((MOVING,) if in_frames else ())}
    for topic, kind, time, message in chain(
        _messages(reader, static), _messages(reader, moving)
    ):
        stamps = {}
        for child, link, stamp in _links(topic, kind, message):
            above[child], stamps[child] = link, stamp
        for player, source in sources.items():
            chained, root, pose = _pose_of(source, above)
            changed = [stamps[link] for link in chained if link in stamps]
            if changed and topic != STATIC:
                x, y, z = pose[:3, 3].tolist()
                heading = atan2(pose[1, 0], pose[0, 0])
                rows[player].append((max(changed), time, x, y, z, heading))
                worlds[player].add(root)
    for player, source in sources.items():
        if not rows[player]:
            known = [n for child, (p, _) in above.items() for n in (p, child)]
            raise ConfigurationError(
                f"{player}={source} must be a frame of {name}: "
                f"{_listed(dict.fromkeys(known))}"
            )
    return worlds, rows


def _links(
    topic: str, kind: str, message: Any
) -> Iterator[tuple[str, Link, float]]:
    """Yield each frame or topic with its pose in another, and the time."""
    if topic not in (STATIC, MOVING):
        own = message
        for field in POSE_FIELDS[kind]:
            own = getattr(own, field)
        pose = _matrix(own.position, own.orientation)
        yield topic, (message.header.frame_id, pose), _stamp(message)
        return
    for each in message.transforms:
        child = each.child_frame_id.removeprefix("/")
        parent = each.header.frame_id.removeprefix("/")
        pose = _matrix(each.transform.translation, each.transform.rotation)
        yield child, (parent, pose), _stamp(each)


def _pose_of(
    frame: str, above: Mapping[str, Link]
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


def _table(player: str, table: Array, count: int) -> Array:
    """Return the valid poses of one player, in the order of their times.

    Of so many poses. Without stamps, the times of recording must do.
    """
    table = np.delete(table, 1 if table[:, 0].any() else 0, axis=1)
    back = np.maximum.accumulate(table[:, 0]) - table[:, 0]
    if (back > SHUFFLED).any():
        at = int(back.argmax())
        raise ConfigurationError(
            f"stamps of {player} must not go back, got {back[at]:.2f} s back "
            f"at {table[at, 0]:.2f} s: cut the bag where its clock was reset"
        )
    table = table[np.unique(table[:, 0], return_index=True)[1]]
    if len(table) < 2:
        raise ConfigurationError(
            f"poses of {player} must be finite with a rotation that is not "
            f"zero at 2 times at least, got {len(table)} of {count}"
        )
    table[:, 4] = np.unwrap(table[:, 4])
    return table


def _listed(names: Iterable[str]) -> str:
    """Return the first names as text."""
    shown = [*names]
    more = len(shown) - MOST_LISTED
    listed = ", ".join(shown[:MOST_LISTED])
    return listed + (f" and {more} more" if more > 0 else "")
