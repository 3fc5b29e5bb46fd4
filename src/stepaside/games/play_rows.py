"""Rows that a player kept, bounded and checked, on one clock."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.errors import ConfigurationError
from ..core.poses import Array
from ..drivers.row_file import HEADER, ROWS, columns_in
from .archive_reader import LARGEST, bytes_of, read_json
from .summary_parsing import check_object, read_figures

WORDS = "play.json"
PERIOD = 0.02  # between samples of a run, at least about, in [s]
LONGEST_GAP = 10.0  # between ticks of one clock, in [s]
TICK = 0.012  # of rows that do not tell, in [s]
COMMON = {"times_s": 1, "sighting": 3, "state": 1}
MOVED = {
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
JOINTS = ("joint_positions", "targets")  # as many as the robot has
DRIVEN = {"pose": 3, "wanted": 2, "velocity": 2}


@dataclass(frozen=True, slots=True)
class StateChange:
    """A change of state, as a player wrote it down.

    Attributes:
        tick: Number of its row.
        state: What it did from then on.
        reason: Why.
    """

    tick: int
    state: str
    reason: str


@dataclass(frozen=True, slots=True)
class PlayNotes:
    """What a player wrote down beside its rows.

    Attributes:
        changes: Of its state.
    """

    changes: tuple[StateChange, ...]


@dataclass(frozen=True, slots=True, eq=False)
class PlayedRows:
    """Rows of a player, with a clock that never goes back.

    Attributes:
        columns: Arrays by name. Shapes (rows,) or (rows, width).
        times: Since the record began, in [s]. Shape (rows,).
        changes: Of what the robot did.
    """

    columns: Mapping[str, Array]
    times: Array
    changes: tuple[StateChange, ...]

    @property
    def moves_joints(self) -> bool:
        """Whether joints were moved, rather than velocities given."""
        return "joint_positions" in self.columns

    @property
    def offset(self) -> Array:
        """From the robot's clock to that of the record, in [s]. (rows,)."""
        offset: Array = self.times - self.columns["times_s"]
        return offset

    @property
    def sampled(self) -> NDArray[np.intp]:
        """Rows that become samples of a run: evenly, and the last."""
        passed = np.diff(self.times)
        new = np.flatnonzero(np.concatenate([[True], passed > 0.0]))
        gap = float(np.median(np.diff(self.times[new], append=np.inf)))
        chosen = new[:: max(1, round(PERIOD / max(gap, 1e-3)))]
        whole = chosen[-1] == new[-1]
        return chosen if whole else np.append(chosen, new[-1:])


def read_played(folder: Path) -> PlayedRows:
    """Read what a player kept; it may still be at it.

    Args:
        folder: Where it lies.

    Raises:
        ConfigurationError: If there are no rows of a player.
        ValueError: If a file is too long, or none.
        OSError: If it cannot be read.
    """
    name = folder.resolve().name
    columns = check_object(read_json(folder / HEADER), f"{HEADER} of {name}")
    _check_columns(columns, name)
    found = columns_in(bytes_of(folder / ROWS, LARGEST), columns)
    if not len(found["times_s"]):
        raise ConfigurationError(f"{ROWS} of {name} has no rows")
    words = read_figures(
        PlayNotes, read_json(folder / WORDS), f"{WORDS} of {name}"
    )
    return PlayedRows(found, one_clock(found["times_s"]), words.changes)


def one_clock(times: Array) -> Array:
    """Times since the first row, on a clock that never goes back.

    A robot's clock begins anew with each walk, and is another one after a
    session was lost: there one tick has passed.

    Args:
        times: On the robot's clock, in [s]. Shape (rows,).
    """
    passed = np.diff(times)
    with np.errstate(invalid="ignore"):
        right = (passed >= 0.0) & (passed < LONGEST_GAP)
        usual = passed[right & (passed > 0.0)]
    tick = float(np.median(usual)) if len(usual) else TICK
    steps = np.where(right, passed, tick)
    since: Array = np.concatenate([[0.0], np.cumsum(steps)])
    return since


def _check_columns(columns: dict[str, Any], name: str) -> None:
    moves = "joint_positions" in columns
    wanted = COMMON | (MOVED if moves else DRIVEN)
    joints = JOINTS if moves else ()
    sizes = {columns.get(key) for key in joints}
    right = set(columns) == {*wanted, *joints}
    right = right and all(columns[key] == n for key, n in wanted.items())
    if moves:
        right = right and len(sizes) == 1
        right = right and all(type(n) is int and 0 < n < 256 for n in sizes)
    if not right:
        raise ConfigurationError(
            f"{HEADER} of {name} must hold the columns of a player: "
            f"{', '.join([*wanted, *joints])}"
        )
