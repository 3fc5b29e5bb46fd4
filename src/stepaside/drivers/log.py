"""What a player noted while it played, as one file of arrays."""

import json
from pathlib import Path

import numpy as np

from ..control import Phase
from ..errors import ConfigurationError
from .lola.safety import State
from .playing import Tick

ARRAYS, WORDS = "play.npz", "play.json"
STATES, PHASES = list(State), list(Phase)


class PlayLog:
    """Keeps every tick: what was measured, wanted and allowed.

    ``play.npz`` holds ``times_s`` (n,), ``joint_positions``, ``targets``
    (n, joints), ``gyro``, ``accelerometer`` (n, 3), ``foot_forces`` (n, 8),
    ``sighting`` (n, 3: time, bearing, distance; NaN without one), ``state``
    and ``phase`` (n,), numbers into the lists of ``play.json``, which also
    says what changed when, and why.
    """

    def __init__(self, folder: Path, about: dict[str, object]) -> None:
        """Make the folder.

        Args:
            folder: Must not exist yet, or be empty.
            about: What to write down beside the arrays.

        Raises:
            ConfigurationError: If it cannot be written.
        """
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if any(folder.iterdir()):
                raise ConfigurationError(f"{folder} must be empty")
        except OSError as error:
            raise ConfigurationError(
                f"cannot write {folder}: {error}"
            ) from error
        self._folder, self._about = folder, about
        self._rows: list[tuple[np.ndarray, ...]] = []
        self._changes: list[dict[str, object]] = []
        self._state: State | None = None

    def note(self, tick: Tick) -> None:
        """Keep a tick."""
        m, seen = tick.measurement, tick.sighting
        self._rows.append(
            (
                np.array(m.time),
                m.joint_positions,
                tick.targets,
                m.gyro,
                m.accelerometer,
                m.foot_forces,
                np.full(3, np.nan) if seen is None else np.array(seen),
                np.array(STATES.index(tick.state)),
                np.array(PHASES.index(tick.phase)),
            )
        )
        if tick.state is not self._state:
            self._state = tick.state
            self._changes.append(
                {
                    "tick": len(self._rows) - 1,
                    "time_s": m.time,
                    "state": tick.state.value,
                    "reason": tick.reason,
                }
            )

    def close(self) -> None:
        """Write what was kept."""
        names = (
            "times_s",
            "joint_positions",
            "targets",
            "gyro",
            "accelerometer",
            "foot_forces",
            "sighting",
            "state",
            "phase",
        )
        columns = zip(*self._rows, strict=True) if self._rows else ()
        arrays = {
            name: np.array(column)
            for name, column in zip(names, columns, strict=False)
        }
        np.savez_compressed(self._folder / ARRAYS, **arrays)  # type: ignore[arg-type]
        words = self._about | {
            "states": [state.value for state in STATES],
            "phases": [str(phase.value) for phase in PHASES],
            "changes": self._changes,
        }
        text = json.dumps(words, indent=1, allow_nan=False)
        (self._folder / WORDS).write_text(text + "\n", encoding="utf-8")
