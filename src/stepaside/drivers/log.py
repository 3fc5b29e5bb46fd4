"""What a player noted while it played, on disk as it goes."""

import json
from collections.abc import Mapping
from enum import Enum
from pathlib import Path

import numpy as np

from ..control import Phase
from ..outputs import check_folder, writing
from ..poses import Array
from .lola.safety import State
from .playing import Tick
from .rows import RowWriter
from .velocity.playing import Driving, VelocityTick

WORDS = "play.json"
STATES: dict[type[Enum], list[Enum]] = {
    kind: list(kind) for kind in (State, Driving)
}
PHASES = list(Phase)
UNSEEN = np.full(3, np.nan)


class PlayLog:
    """Keeps every tick, as rows (:mod:`stepaside.drivers.rows`).

    Every tick has ``times_s``, ``sighting`` (time, bearing, distance; NaN
    without one) and ``state``. One that moves joints has
    ``joint_positions``, ``targets``, ``gyro``, ``accelerometer``,
    ``foot_forces`` and ``phase``; one that gives velocities has ``pose``,
    its odometry, ``wanted``, what the template would do, and ``velocity``,
    what was asked for (forward [m/s], turn [rad/s]). States and phases are
    numbers into the lists of ``play.json``, which also says what changed
    when, and why.
    """

    def __init__(self, folder: Path, about: Mapping[str, object]) -> None:
        """Try the folder, which is made when there is something to keep.

        Args:
            folder: Must not exist yet, or be empty.
            about: What to write down beside the rows.

        Raises:
            ConfigurationError: If it cannot be written.
        """
        check_folder(folder, "record", new=True)
        self._rows: RowWriter | None = None
        self._folder, self._about = folder, dict(about)
        self._changes: list[dict[str, object]] = []
        self._state: Enum | None = None

    def note(self, tick: Tick | VelocityTick) -> None:
        """Keep a tick."""
        seen, state = tick.sighting, tick.state
        row: dict[str, Array | float] = {
            "times_s": tick.time,
            "sighting": UNSEEN if seen is None else np.array(seen),
            "state": float(STATES[type(state)].index(state)),
        }
        row |= _moved(tick) if isinstance(tick, Tick) else _driven(tick)
        rows = self._rows = self._rows or RowWriter(self._folder)
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
            self._write_words()

    def close(self) -> None:
        """Write what is left; nothing if there is nothing.

        Raises:
            OutputError: If the system does not let it be written.
        """
        if self._rows is not None:
            self._rows.close()
            self._write_words()

    def _write_words(self) -> None:
        kind = type(self._state) if self._state is not None else State
        words = self._about | {
            "states": [state.value for state in STATES[kind]],
            "phases": [phase.value for phase in PHASES],
            "changes": self._changes,
        }
        text = json.dumps(words, indent=1, allow_nan=False)
        with writing(self._folder / WORDS) as draft:
            draft.write_text(text + "\n", encoding="utf-8")


def _moved(tick: Tick) -> dict[str, Array | float]:
    """What is known of a robot whose joints are moved."""
    m = tick.measurement
    return {
        "joint_positions": m.joint_positions,
        "targets": tick.targets,
        "gyro": m.gyro,
        "accelerometer": m.accelerometer,
        "foot_forces": m.foot_forces,
        "phase": float(PHASES.index(tick.phase)),
    }


def _driven(tick: VelocityTick) -> dict[str, Array | float]:
    """What is known of a robot that walks by itself."""
    return {
        "pose": np.array(tick.pose),
        "wanted": np.array(tick.wanted),
        "velocity": np.array(tick.velocity),
    }
