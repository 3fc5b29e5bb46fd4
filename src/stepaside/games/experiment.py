"""Experiments: a ROS 2 bag of players, recorded elsewhere, as a run."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain
from math import atan2
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from ..core.brief_repr import brief_repr
from ..core.errors import ConfigurationError
from ..core.poses import Array
from ..core.rotations import rotation_of
from ..core.setting import CheckedSettings, setting
from .evaluation import measure
from .outcome import Outcome
from .player_settings import MOST_PLAYERS, PLAYER_NAME
from .run import Run
from .trajectory import Trajectory, check_record

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


@dataclass(frozen=True, slots=True)
class ExperimentSettings(CheckedSettings):
    """Settings of an experiment: its recording, and who is who in it."""

    game: ClassVar[str] = "experiment"
    cycle: ClassVar[float] = 1.0  # over which figures average the sway [s]
    __repr__ = brief_repr

    source: str = setting("", "Name of the recording")
    frames: tuple[str, ...] = setting(
        (), "Players, as NAME=FRAME or NAME=/TOPIC"
    )
    world: str = setting("", "Frame in which all poses are")


@dataclass(frozen=True, slots=True, eq=False)
class PoseSeries:
    """Poses of one player over time."""

    world: str  # frame in which they are
    times: Array  # increasing [s]
    positions: Array  # (x, y, z) [m]
    headings: Array  # unwrapped [rad]
    invalid: int  # number left out: not finite, or with a zero rotation


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

    Samples are at the times of the first player's poses, as far as all
    players have poses; those of the others are interpolated.

    Args:
        bag: Folder of a ROS 2 bag, or a file of one.
        words: Players, as ``NAME=FRAME`` or ``NAME=/TOPIC``; at least two.

    Raises:
        ConfigurationError: If the bag lacks a frame or topic, the poses are
            not in one frame, or not at common times.
        ModuleNotFoundError: If rosbags is not installed.
    """
    sources = _parse_sources(words)
    series = _read_poses(bag, sources)
    worlds = {player: one.world for player, one in series.items()}
    if len(set(worlds.values())) > 1:
        found = ", ".join(f"{p} in {w}" for p, w in worlds.items())
        raise ConfigurationError(
            f"poses of all players must be in one frame, got {found}"
        )
    first = next(iter(series.values()))
    begin = max(one.times[0] for one in series.values())
    end = min(one.times[-1] for one in series.values())
    inside = (first.times >= begin) & (first.times <= end)
    times = first.times[inside]
    if len(times) < 2:
        raise ConfigurationError(
            f"players of {bag.name} must have poses at common times, got "
            + ", ".join(
                f"{p} from {one.times[0]:.1f} to {one.times[-1]:.1f} s"
                for p, one in series.items()
            )
        )
    tracks = {p: _sampled(one, times) for p, one in series.items()}
    elapsed = times - times[0]
    check_record(elapsed, tracks, bag.name)
    run = Run(
        name=bag.stem or bag.name,
        settings=ExperimentSettings(
            source=bag.name, frames=words, world=first.world
        ),
        outcome=Outcome.COMPLETED,
        message=f"recorded {elapsed[-1]:.2f} s in {first.world}",
        duration=round(float(elapsed[-1]), 9),
        times=elapsed,
        tracks=tracks,
    )
    notes = []
    for player, one in series.items():
        ends = [begin], np.clip(one.times, begin, end), [end]
        gap = float(np.diff(np.concatenate(ends)).max())
        if gap > NOTED_GAP:
            notes.append(f"{player} has no pose for {gap:.2f} s; interpolated")
        if one.invalid:
            notes.append(f"{player} has {one.invalid} invalid poses; left out")
    return replace(run, summary=replace(measure(run), notes=notes))


def _sampled(series: PoseSeries, times: Array) -> Trajectory:
    """Return the poses at times, linearly interpolated."""
    x, y, z, heading = (
        np.interp(times, series.times, column)
        for column in (*series.positions.T, series.headings)
    )
    return Trajectory(
        com=np.column_stack([x, y, z]),
        torso=np.column_stack([x, y, heading]),
    )


def _read_poses(
    bag: Path, sources: Mapping[str, str]
) -> dict[str, PoseSeries]:
    """Read the poses of players from a bag.

    Sources are frames, or topics that begin with a slash. Times are those of
    the headers; where no header of a player has one, those of recording.
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
