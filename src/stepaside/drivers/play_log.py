"""Log of a player of ``stepaside play``, written to disk during the run."""

import json
from collections.abc import Mapping
from enum import Enum
from pathlib import Path

import numpy as np

from ..core.atomic_output import atomic_draft, check_folder
from ..core.poses import Array
from ..locomotion.walk_snapshots import Phase, StepStarted, WalkState
from ..strategies.velocity_set import BodyVelocity
from .joint_loop import JointTick
from .row_file import RowWriter
from .safety_states import SafetyState
from .velocity_loop import DrivingState, VelocityTick

METADATA = "play.json"
STATES: dict[type[Enum], list[Enum]] = {
    kind: list(kind) for kind in (SafetyState, DrivingState)
}
PHASES = list(Phase)
UNSEEN = np.full(3, np.nan)
NO_STEP = np.full(6, np.nan)


class PlayLog:
    """Recorder of every tick as a row (:mod:`stepaside.drivers.row_file`).

    Each row has the columns ``times_s``, ``sighting`` (time [s], bearing
    [rad], distance [m]; NaN without a sighting) and ``state``.

    A tick of :class:`JointTick` adds ``joint_positions``, ``targets``,
    ``gyro``, ``accelerometer``, ``foot_forces`` and ``phase``, and in the
    odometry frame of the controller numbered ``mind``: ``support`` (x, y,
    heading of the stance foot, then 1 for left or -1 for right; of other
    locomotion place of the CoM and heading of the torso, then NaN),
    ``com_reference``, ``zmp_reference`` and ``begun``, the step that began
    at this tick (landing time, 1 left or -1 right, x, y, heading, processor
    time of planning; NaN if none began).

    A tick of :class:`VelocityTick` adds ``pose`` (odometry), ``wanted``
    (velocity of the template) and ``velocity`` (command), each forward
    [m/s], turn [rad/s] and lateral [m/s].

    ``state`` and ``phase`` are indices into the lists of ``play.json``,
    which also lists each change of state with its time and reason.

    Attributes:
        folder: Folder of the log.
        count: Number of recorded ticks.
    """

    def __init__(
        self,
        folder: Path,
        about: Mapping[str, object],
        beside: Mapping[str, str] | None = None,
    ) -> None:
        """Check the folder, which is created with the first tick.

        Args:
            folder: Folder that does not exist yet, or is empty.
            about: Entries of ``play.json``.
            beside: Contents of further files, by name.

        Raises:
            ConfigurationError: If the folder cannot be written.
        """
        check_folder(folder, "record", new=True)
        self._rows: RowWriter | None = None
        self.folder, self._about = folder, dict(about)
        self._beside = dict(beside or {})
        self._changes: list[dict[str, object]] = []
        self._state: Enum | None = None

    @property
    def count(self) -> int:
        """Number of recorded ticks."""
        return 0 if self._rows is None else self._rows.count

    def note(self, tick: JointTick | VelocityTick) -> None:
        """Record a tick."""
        sighting, state = tick.sighting, tick.state
        row: dict[str, Array | float] = {
            "times_s": tick.time,
            "sighting": UNSEEN if sighting is None else np.array(sighting[:3]),
            "state": float(STATES[type(state)].index(state)),
        }
        row |= (
            _joint_columns(tick)
            if isinstance(tick, JointTick)
            else _velocity_columns(tick)
        )
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
            self._write_metadata(self.folder)

    def _begin(self) -> RowWriter:
        rows = RowWriter(self.folder)
        self._write_beside(self.folder)
        return rows

    def _write_beside(self, folder: Path) -> None:
        for name, text in self._beside.items():
            (folder / name).write_text(text, encoding="utf-8")

    def copy_to(self, folder: Path) -> None:
        """Copy the log to another folder when its own cannot be written.

        Args:
            folder: Folder that does not exist yet.

        Raises:
            OSError: If that folder cannot be written either.
        """
        if self._rows is not None:
            folder.mkdir(parents=True)
            self._rows.copy_to(folder)
            self._write_beside(folder)
            self._write_metadata(folder)

    def close(self) -> None:
        """Flush and close the files; write nothing if there was no tick.

        Raises:
            OSError: If the files cannot be written.
        """
        if self._rows is not None:
            self._rows.close()
            self._write_metadata(self.folder)

    def _write_metadata(self, folder: Path) -> None:
        kind = type(self._state) if self._state is not None else SafetyState
        metadata = self._about | {
            "states": [state.value for state in STATES[kind]],
            "phases": [phase.value for phase in PHASES],
            "changes": self._changes,
        }
        text = json.dumps(metadata, indent=1, allow_nan=False)
        folder.stat()  # a removed folder must not return without its rows
        with atomic_draft(folder / METADATA) as draft:
            draft.write_text(text + "\n", encoding="utf-8")


def _joint_columns(tick: JointTick) -> dict[str, Array | float]:
    """Return the columns of a robot driven by its joints."""
    m = tick.measurement
    return {
        "joint_positions": m.joint_positions,
        "targets": tick.targets,
        "gyro": m.gyro,
        "accelerometer": m.accelerometer,
        "foot_forces": m.foot_forces,
        "phase": float(PHASES.index(tick.phase)),
        "mind": float(tick.mind),
        "support": _support(tick),
        **_references(tick.walk),
        "begun": NO_STEP if tick.begun is None else _begun(tick.begun),
    }


def _references(walk: WalkState | None) -> dict[str, Array | float]:
    """Return the references of a walk by maneuvers; NaN of another."""
    if walk is None:
        unknown = np.full(2, np.nan)
        return {"com_reference": unknown, "zmp_reference": unknown}
    return {
        "com_reference": np.array(walk.reference.com[:2]),
        "zmp_reference": np.array(walk.zmp_reference),
    }


def _support(tick: JointTick) -> Array:
    """Return the pose of the stance foot in odometry, and its side."""
    if tick.walk is None:
        return np.array([*tick.pose, np.nan])
    step = tick.walk.step(tick.time)
    return np.array([*step.support, -float(step.swing.value)])


def _begun(step: StepStarted) -> Array:
    """Return the entries of the column ``begun``."""
    spent = np.nan if step.planning_time is None else step.planning_time
    side = float(step.foot.value)
    return np.array([step.landing_time, side, *step.landing, spent])


def _velocity_columns(tick: VelocityTick) -> dict[str, Array | float]:
    """Return the columns of a robot driven by velocity commands."""
    return {
        "pose": np.array(tick.pose),
        "wanted": _row(tick.wanted),
        "velocity": _row(tick.velocity),
    }


def _row(velocity: BodyVelocity) -> Array:
    return np.array([velocity.forward, velocity.turn, velocity.lateral])
