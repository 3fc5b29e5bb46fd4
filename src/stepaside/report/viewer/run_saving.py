"""Run folders of live games."""

import json
from pathlib import Path
from threading import Lock
from typing import Any

from ...core.atomic_output import atomic_draft
from ...core.errors import ConfigurationError
from ...games.game import GameInPlay, GameObserver
from ...games.recorded_game import RecordedGame
from ..run_folder import free_folder, write_run

MAX_RECORDED = 600.0  # simulated time that is recorded, in [s]
MAX_FOLDERS = 20  # that one page may write
COMMAND_FILE = "hand.json"


class LiveRecording(GameObserver):
    """Observer that records the first ``MAX_RECORDED`` seconds of a game."""

    def before(self, game: GameInPlay) -> None:
        """Record a sample."""
        if isinstance(game, RecordedGame) and game.world.time <= MAX_RECORDED:
            game.recorder.before(game)

    def acted(self, game: GameInPlay) -> None:
        """Record the steps that begin."""
        if isinstance(game, RecordedGame) and game.world.time <= MAX_RECORDED:
            game.recorder.acted(game)


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
        match: RecordedGame,
        commands: Any,
    ) -> Path:
        """Write a game so far.

        Args:
            match: The game; it must not change meanwhile.
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
            run = match.run()
            name = f"live-seed{run.settings.seed}"
            folder = write_run(free_folder(self._parent, name), run).parent
            if commands:
                with atomic_draft(folder / COMMAND_FILE) as draft:
                    draft.write_text(json.dumps(commands, indent=1) + "\n")
            self._written += 1
        return folder
