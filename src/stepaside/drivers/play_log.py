"""What a player noted while it played, on disk as it goes."""

import json
from collections.abc import Mapping
from enum import Enum
from pathlib import Path

import numpy as np

from ..control import Phase
from ..control.walk_snapshots import StepStarted, WalkState
from ..core.atomic_output import check_folder, writing
from ..core.poses import Array
from .joint.joint_loop import JointTick
from .joint.safety import RobotState
from .row_file import RowWriter
from .velocity.velocity_loop import DrivingState, VelocityTick

WORDS = "play.json"
STATES: dict[type[Enum], list[Enum]] = {
    kind: list(kind) for kind in (RobotState, DrivingState)
}
PHASES = list(Phase)
UNSEEN = np.full(3, np.nan)
NO_STEP = np.full(6, np.nan)


class PlayLog:
    """Keeps every tick, as rows (:mod:`stepaside.drivers.row_file`).

    Every tick has ``times_s``, ``sighting`` (time, bearing, distance; NaN
    without one) and ``state``. One that moves joints has
    ``joint_positions``, ``targets``, ``gyro``, ``accelerometer``,
    ``foot_forces`` and ``phase``, and of what control believes, in the
    odometry of ``mind``: ``support`` (x, y, heading of the foot that stands,
    then 1 left or -1 right), ``com_reference``, ``zmp_reference`` and
    ``begun``, the step that began (time of landing, 1 left or -1 right, x,
    y, heading, processor time of planning; NaN without one). One that gives
    velocities has ``pose``, its odometry, ``wanted``, what the template
    would do, and ``velocity``, what was asked for (forward [m/s], turn
    [rad/s]). States and phases are numbers into the lists of ``play.json``,
    which also says what changed when, and why.

    Attributes:
        folder: Where it lies.
        count: Ticks kept so far.
    """

    def __init__(
        self,
        folder: Path,
        about: Mapping[str, object],
        beside: Mapping[str, str] | None = None,
    ) -> None:
        """Try the folder, which is made when there is something to keep.

        Args:
            folder: Must not exist yet, or be empty.
            about: What to write down in ``play.json``.
            beside: Texts of further files, by name.

        Raises:
            ConfigurationError: If it cannot be written.
        """
        check_folder(folder, "record", new=True)
        self._rows: RowWriter | None = None
        self.folder, self._about = folder, dict(about)
        self._beside = dict(beside or {})
        self._changes: list[dict[str, object]] = []
        self._state: Enum | None = None

    @property
    def count(self) -> int:
        """Ticks kept so far."""
        return 0 if self._rows is None else self._rows.count

    def note(self, tick: JointTick | VelocityTick) -> None:
        """Keep a tick."""
        seen, state = tick.sighting, tick.state
        row: dict[str, Array | float] = {
            "times_s": tick.time,
            "sighting": UNSEEN if seen is None else np.array(seen[:3]),
            "state": float(STATES[type(state)].index(state)),
        }
        row |= _moved(tick) if isinstance(tick, JointTick) else _driven(tick)
        rows = self._rows = self._rows or self._begin()
        rows.add(row)
        if state is not self._state:
            self._state = state
            self._changes.append(
                {
                    "tick": rows.count - 1,
                    "time_s": tick.time,
                    "state": state.value,
                    "reason": tick.reason,
                }
            )
            self._write_words(self.folder)

    def _begin(self) -> RowWriter:
        rows = RowWriter(self.folder)
        self._write_beside(self.folder)
        return rows

    def _write_beside(self, folder: Path) -> None:
        for name, text in self._beside.items():
            (folder / name).write_text(text, encoding="utf-8")

    def copy_to(self, folder: Path) -> None:
        """Keep it in another folder, since this one cannot be written.

        Args:
            folder: Does not exist yet.

        Raises:
            OSError: If that cannot be written either.
        """
        if self._rows is not None:
            folder.mkdir(parents=True)
            self._rows.copy_to(folder)
            self._write_beside(folder)
            self._write_words(folder)

    def close(self) -> None:
        """Write what is left; nothing if there is nothing.

        Raises:
            OSError: If the system does not let it be written.
        """
        if self._rows is not None:
            self._rows.close()
            self._write_words(self.folder)

    def _write_words(self, folder: Path) -> None:
        kind = type(self._state) if self._state is not None else RobotState
        words = self._about | {
            "states": [state.value for state in STATES[kind]],
            "phases": [phase.value for phase in PHASES],
            "changes": self._changes,
        }
        text = json.dumps(words, indent=1, allow_nan=False)
        folder.stat()  # where it is gone, it is not made anew without its rows
        with writing(folder / WORDS) as draft:
            draft.write_text(text + "\n", encoding="utf-8")


def _moved(tick: JointTick) -> dict[str, Array | float]:
    """What is known of a robot whose joints are moved."""
    m = tick.measurement
    return {
        "joint_positions": m.joint_positions,
        "targets": tick.targets,
        "gyro": m.gyro,
        "accelerometer": m.accelerometer,
        "foot_forces": m.foot_forces,
        "phase": float(PHASES.index(tick.phase)),
        "mind": float(tick.mind),
        "support": _support(tick.walk, m.time),
        "com_reference": np.array(tick.walk.reference.com[:2]),
        "zmp_reference": np.array(tick.walk.zmp_reference),
        "begun": NO_STEP if tick.begun is None else _begun(tick.begun),
    }


def _support(walk: WalkState, now: float) -> Array:
    """Foot that stands, where control believes it."""
    made = walk.step(now)
    return np.array([*made.support, -float(made.swing.value)])


def _begun(step: StepStarted) -> Array:
    """Step that began."""
    spent = np.nan if step.planning_time is None else step.planning_time
    side = float(step.foot.value)
    return np.array([step.landing_time, side, *step.landing, spent])


def _driven(tick: VelocityTick) -> dict[str, Array | float]:
    """What is known of a robot that walks by itself."""
    return {
        "pose": np.array(tick.pose),
        "wanted": np.array(tick.wanted),
        "velocity": np.array(tick.velocity),
    }
