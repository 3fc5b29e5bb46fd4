"""Ticks of a player of ``stepaside play``: their log, and a status line."""

import json
import re
from collections.abc import Callable, Mapping
from contextlib import suppress
from enum import Enum
from math import degrees
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, BinaryIO, NamedTuple, TextIO

import numpy as np

from ..core.atomic_output import atomic_draft, check_folder
from ..core.errors import ConfigurationError
from ..core.poses import Array
from ..locomotion.locomotion import Phase, StepStarted
from ..perception.measurement import RobotState, Sighting

if TYPE_CHECKING:
    from ..control.scheme import ControlScheme

METADATA, ROWS = "play.json", "rows.f64"
PERIOD = 0.2  # between two updates of the status line, in [s]
_NUMBER = re.compile(r"[-+]?\d+(\.\d+)?")
FLUSH_INTERVAL = 10  # rows between two flushes to disk
PHASES = list(Phase)
UNSEEN = np.full(3, np.nan)
NO_STEP = np.full(6, np.nan)
Row = dict[str, Array | float]


class PlayTick(NamedTuple):
    """Result of one tick, for logs and the status line."""

    state: Enum
    reason: str  # for the state
    time: float  # of the measurement, in [s]
    sighting: Sighting | None  # newest
    words: str  # state, reason and command
    row: Row  # further columns of the log
    walked: float | None = None  # time since the walk began, in [s]


class PlayLog:
    """Recorder of every tick as a row; a crash loses at most the last ten.

    ``rows.f64`` holds the rows as consecutive little-endian doubles. Each
    has the columns ``times_s``, ``sighting`` (time [s], bearing [rad],
    distance [m]; NaN without a sighting), ``state`` and those of its tick:
    see :func:`joint_row`. ``play.json`` has the widths of the columns, the
    states and phases that numbers stand for, and each change of state with
    its time and reason.
    """

    def __init__(self, folder: Path, beside: Mapping[str, str]) -> None:
        """Check the folder, which is created with the first tick.

        With the texts of other files in it, by name.
        """
        check_folder(folder, "record", new=True)
        self.folder, self._beside = folder, beside
        self._changes: list[dict[str, object]] = []
        self._state: Enum | None = None
        self._columns: dict[str, int] = {}
        self._file: BinaryIO | None = None
        self.count = 0

    def note(self, tick: PlayTick) -> None:
        """Record a tick."""
        sighting, state = tick.sighting, tick.state
        row: Row = {
            "times_s": tick.time,
            "sighting": UNSEEN if sighting is None else np.array(sighting[:3]),
            "state": float(list(type(state)).index(state)),
        }
        parts = {
            name: np.atleast_1d(value)
            for name, value in (row | tick.row).items()
        }
        if self._file is None:
            self._columns = {name: part.size for name, part in parts.items()}
            self._file = self._begin()
        self._file.write(
            np.concatenate(list(parts.values())).astype("<f8").tobytes()
        )
        self.count += 1
        if self.count % FLUSH_INTERVAL == 0:
            self._file.flush()
        if state is not self._state:
            self._state = state
            self._changes.append(
                {
                    "tick": self.count - 1,
                    "time_s": tick.time,
                    "state": state.value,
                    "reason": tick.reason,
                }
            )
            self._write_metadata()

    def _begin(self) -> BinaryIO:
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            file = (self.folder / ROWS).open("wb")
        except OSError as error:
            raise ConfigurationError(
                f"cannot write {self.folder}: {error}"
            ) from error
        for name, text in self._beside.items():
            (self.folder / name).write_text(text, encoding="utf-8")
        return file

    def close(self) -> None:
        """Flush and close the files; write nothing if there was no tick."""
        if self._file is not None:
            self._file.flush()
            (self.folder / ROWS).stat()
            self._file.close()
            self._write_metadata()

    def _write_metadata(self) -> None:
        assert self._state is not None  # there was a tick
        metadata = {
            "columns": self._columns,
            "states": [state.value for state in type(self._state)],
            "phases": [phase.value for phase in PHASES],
            "changes": self._changes,
        }
        text = json.dumps(metadata, indent=1, allow_nan=False)
        self.folder.stat()  # a removed folder must not return without its rows
        with atomic_draft(self.folder / METADATA) as draft:
            draft.write_text(text + "\n", encoding="utf-8")


def joint_row(
    measurement: RobotState,
    targets: Array,
    scheme: "ControlScheme",
    number: int,
    begun: StepStarted | None,
) -> Row:
    """Return the columns of a robot that is driven by its joints.

    ``support``, ``com_reference``, ``zmp_reference`` and ``begun`` are in
    the odometry of the scheme: pose of the stance foot, then 1 for left or
    -1 for right (of other locomotion, pose of the template, then NaN); and
    the step that began at this tick: landing time [s], side, pose, time of
    planning [s].
    """
    walk = scheme.locomotion.maneuvers
    support = np.array([*scheme.locomotion.pose, np.nan])
    com = zmp = np.full(2, np.nan)
    if walk is not None:
        step = walk.step(measurement.time)
        support = np.array([*step.support, -float(step.swing.value)])
        com, zmp = np.array(walk.planned_centers).reshape(2, 2)
    landing = NO_STEP
    if begun is not None:
        spent = begun.planning_time
        landing = np.array(
            [
                *(begun.landing_time, float(begun.foot.value)),
                *(*begun.landing, np.nan if spent is None else spent),
            ]
        )
    return {
        "joint_positions": measurement.joint_positions,
        "targets": targets,
        "gyro": measurement.gyro,
        "accelerometer": measurement.accelerometer,
        "foot_forces": measurement.foot_forces,
        "phase": float(PHASES.index(scheme.phase)),
        "mind": float(number),
        "support": support,
        "com_reference": com,
        "zmp_reference": zmp,
        "begun": landing,
    }


def columns_in(data: bytes, columns: Mapping[str, int]) -> dict[str, Array]:
    """Split row data into columns; an incomplete last row is dropped."""
    shapes = {name: (size,) * (size > 1) for name, size in columns.items()}
    kind = np.dtype([(name, "<f8", shape) for name, shape in shapes.items()])
    rows = np.frombuffer(data, kind, count=len(data) // kind.itemsize)
    return {name: rows[name] for name in columns}


def status_text(tick: PlayTick, begin: float) -> str:
    """Return one line about a tick, with the time since ``begin``."""
    sighting = tick.sighting
    opponent = "opponent not detected"
    if sighting is not None:
        opponent = (
            f"opponent at {sighting.distance:.2f} m, "
            f"{degrees(sighting.bearing):+.0f} deg"
        )
    return f"{tick.time - begin:7.1f} s  {tick.words}, {opponent}"


class StatusLine:
    """Line that is overwritten periodically, and kept at each change.

    A change is a new state or a new reason; reasons that differ only in
    their numbers ("no odometry for 0.31 s") count as the same.
    """

    def __init__(
        self, stream: TextIO, clock: Callable[[], float] = monotonic
    ) -> None:
        """Write to a stream; if it is not a terminal, write changes only."""
        self._stream, self._clock = stream, clock
        self._is_terminal = stream.isatty()
        self._written = -PERIOD
        self._last: tuple[Enum, str] | None = None
        self._begin: float | None = None  # time of the first report [s]

    def note(self, tick: PlayTick) -> None:
        """Show a tick, if the status changed or an update is due."""
        now = self._clock()
        self._begin = self._begin or tick.time  # 0 before the first report
        kind = tick.state, _NUMBER.sub("", tick.reason)
        changed = kind != self._last
        if not changed and not self._is_terminal:
            return
        if not changed and now - self._written < PERIOD:
            return
        self._last, self._written = kind, now
        text = status_text(tick, self._begin)
        if self._is_terminal:
            text = f"\r{text:<79.120}" + ("\n" if changed else "")
        else:
            text += "\n"
        self._write(text)

    def close(self) -> None:
        """End the line."""
        if self._is_terminal:
            self._write("\n")

    def _write(self, text: str) -> None:
        """Write, ignoring errors: a closed terminal must not end the walk."""
        with suppress(OSError):
            self._stream.write(text)
            self._stream.flush()
