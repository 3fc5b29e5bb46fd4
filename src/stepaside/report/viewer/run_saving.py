"""Run folders of live games."""

import json
from pathlib import Path
from threading import Lock
from typing import Any

from ...core.atomic_output import atomic_draft
from ...core.errors import ConfigurationError
from ...games.duel import Duel
from ...games.game_match import GameMatch
from ...games.match import Match
from ...games.outcome import Outcome
from ..run_folder import free_folder, write_run

MAX_RECORDED = 600.0  # simulated time that is recorded, in [s]
MAX_FOLDERS = 20  # that one page may write
COMMAND_FILE = "hand.json"


class LiveRecording:
    """Observer that records the first ``MAX_RECORDED`` seconds of a game."""

    def before(self, match: Match) -> None:
        """Record a sample."""
        if (
            isinstance(match, (Duel, GameMatch))
            and match.world.time <= MAX_RECORDED
        ):
            match.recorder.before(match)

    def acted(self, match: Match) -> None:
        """Record the steps that begin."""
        if (
            isinstance(match, (Duel, GameMatch))
            and match.world.time <= MAX_RECORDED
        ):
            match.recorder.acted(match)

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Record the last sample."""
        if (
            isinstance(match, (Duel, GameMatch))
            and match.world.time <= MAX_RECORDED
        ):
            match.recorder.ended(match, outcome)


class RunSaver:
    """Writer of the run folders of one page."""

    def __init__(self, parent: Path) -> None:
        """Write into a folder.

        Args:
            parent: Parent of the run folders.
        """
        self._parent = parent
        self._written = 0
        self._lock = Lock()

    def save(
        self,
        match: Duel | GameMatch,
        outcome: Outcome | None,
        commands: Any,
    ) -> Path:
        """Write a game so far.

        Args:
            match: The game; it must not change meanwhile.
            outcome: Outcome of the game; None while it is played.
            commands: Commands of teleoperation, as plain values.

        Returns:
            The run folder.

        Raises:
            ConfigurationError: If nothing has been recorded yet, or
                ``MAX_FOLDERS`` have been written.
            OutputError: If it cannot be written.
        """
        with self._lock:
            if self._written >= MAX_FOLDERS:
                raise ConfigurationError(
                    f"saved runs must be at most {MAX_FOLDERS}; restart "
                    "stepaside view to save more"
                )
            if len(match.recorder.times) < 3:
                raise ConfigurationError(
                    "nothing has been recorded yet: start the game first"
                )
            run = match.run(outcome or Outcome.INTERRUPTED, match.world.time)
            name = f"live-seed{run.settings.seed}"
            folder = write_run(free_folder(self._parent, name), run).parent
            if commands:
                with atomic_draft(folder / COMMAND_FILE) as draft:
                    draft.write_text(json.dumps(commands, indent=1) + "\n")
            self._written += 1
        return folder
