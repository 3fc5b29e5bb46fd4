"""Rows recorded by a player at a robot, validated and on one clock."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.entries import load_entries, read_entries
from ..core.errors import ConfigurationError
from ..core.poses import Array
from ..drivers.play_log import METADATA, ROWS, columns_in
from .archive_reader import read_bytes

PERIOD = 0.02  # approximate smallest period of the samples of a run, in [s]
MAX_GAP = 10.0  # between ticks of one clock, in [s]
DEFAULT_TICK = 0.012  # of rows whose times do not advance, in [s]
# Width of each column: of all plays, and of those by joints or velocities.
COMMON = {"times_s": 1, "sighting": 3, "state": 1}
BY_JOINTS = {
    "gyro": 3,
    "accelerometer": 3,
    "foot_forces": 8,
    "phase": 1,
    "mind": 1,
    "support": 4,
    "com_reference": 2,
    "zmp_reference": 2,
    "begun": 6,
}
JOINTS = ("joint_positions", "targets")  # one column per joint
BY_VELOCITY = {"pose": 3, "wanted": 3, "velocity": 3}


class LoggedChange(NamedTuple):
    """Change of a player's state, at the row with an index."""

    tick: int
    state: str
    reason: str


@dataclass(frozen=True, slots=True)
class PlayStateLog:
    """Changes of state in ``play.json``."""

    changes: tuple[LoggedChange, ...]


@dataclass(frozen=True, slots=True, eq=False)
class PlayedRows:
    """Rows of a player, with a monotonic clock."""

    columns: Mapping[str, Array]  # by name: (rows,) or (rows, width)
    times: Array  # since the record began, in [s]
    changes: tuple[LoggedChange, ...]

    @property
    def moves_joints(self) -> bool:
        """Whether joints were commanded, not velocities."""
        return "joint_positions" in self.columns

    @property
    def offset(self) -> Array:
        """Record time minus the robot's time, in [s]. Shape (rows,)."""
        offset: Array = self.times - self.columns["times_s"]
        return offset

    @property
    def sampled(self) -> NDArray[np.intp]:
        """Indices of the rows that become samples: periodic, and the last."""
        passed = np.diff(self.times)
        new = np.flatnonzero(np.concatenate([[True], passed > 0.0]))
        gap = float(np.median(np.diff(self.times[new], append=np.inf)))
        chosen = new[:: max(1, round(PERIOD / max(gap, 1e-3)))]
        has_last = chosen[-1] == new[-1]
        return chosen if has_last else np.append(chosen, new[-1:])


def read_played(folder: Path) -> PlayedRows:
    """Read the rows of a player, which may still be running.

    Raises:
        ConfigurationError: If there are no valid rows.
    """
    name = folder.resolve().name
    notes = load_entries(folder / METADATA)
    columns = _columns_of(notes, name)
    found = columns_in(read_bytes(folder / ROWS), columns)
    if not len(found["times_s"]):
        raise ConfigurationError(f"{ROWS} of {name} has no rows")
    source = f"{METADATA} of {name}"
    changes = read_entries(PlayStateLog, notes, source, ignoring=True).changes
    return PlayedRows(found, monotonic_times(found["times_s"]), changes)


def monotonic_times(times: Array) -> Array:
    """Convert robot times to monotonic times since the first row.

    A robot's clock restarts with each walk and after each lost connection.
    At a restart one tick is taken to have passed.
    """
    passed = np.diff(times)
    with np.errstate(invalid="ignore"):
        regular = (passed >= 0.0) & (passed < MAX_GAP)
        positive = passed[regular & (passed > 0.0)]
    tick = float(np.median(positive)) if len(positive) else DEFAULT_TICK
    steps = np.where(regular, passed, tick)
    elapsed: Array = np.concatenate([[0.0], np.cumsum(steps)])
    return elapsed


def _columns_of(notes: Mapping[str, Any], name: str) -> dict[str, int]:
    columns: Any = notes.get("columns")
    columns = columns if isinstance(columns, dict) else {}
    moves_joints = "joint_positions" in columns
    expected = COMMON | (BY_JOINTS if moves_joints else BY_VELOCITY)
    joints = JOINTS if moves_joints else ()
    sizes = {columns.get(key) for key in joints}
    valid = set(columns) == {*expected, *joints}
    valid = valid and all(columns[key] == n for key, n in expected.items())
    if moves_joints:
        valid = valid and len(sizes) == 1
        valid = valid and all(type(n) is int and 0 < n < 256 for n in sizes)
    if not valid:
        raise ConfigurationError(
            f"{METADATA} of {name} must hold the columns of a player: "
            f"{', '.join([*expected, *joints])}"
        )
    found: dict[str, int] = columns
    return found
