"""What was played on a page, kept: a run folder like any other."""

import json
from pathlib import Path
from threading import Lock
from typing import Any

from ...core.atomic_output import writing
from ...core.errors import ConfigurationError
from ...games.duel import Duel
from ...games.match import Match
from ...games.outcome import Outcome
from ..run_folder import free_folder, write_run

KEPT = 600.0  # of a live duel that can be saved, from its beginning, in [s]
MOST = 20  # folders that one page may write
HAND = "hand.json"


class LiveRecording:
    """Lets the recorder of a live duel look on, for so long as it may."""

    def before(self, match: Match) -> None:
        """Let it take a sample."""
        if isinstance(match, Duel) and match.world.time <= KEPT:
            match.recorder.before(match)

    def acted(self, match: Match) -> None:
        """Let it note the steps that begin."""
        if isinstance(match, Duel) and match.world.time <= KEPT:
            match.recorder.acted(match)

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Let it take the last sample."""
        if isinstance(match, Duel) and match.world.time <= KEPT:
            match.recorder.ended(match, outcome)


class RunSaver:
    """Writes run folders of a live duel, a few at most."""

    def __init__(self, parent: Path) -> None:
        """Write into a folder.

        Args:
            parent: Where run folders shall lie.
        """
        self._parent = parent
        self._written = 0
        self._lock = Lock()

    def save(self, duel: Duel, outcome: Outcome | None, hand: Any) -> Path:
        """Write what was played so far.

        Args:
            duel: The duel; nothing may happen to it meanwhile.
            outcome: How it ended, if it did.
            hand: What a hand asked of the robots, as plain values.

        Returns:
            The folder.

        Raises:
            ConfigurationError: If nothing was played, or too much is kept.
            OutputError: If it cannot be written.
        """
        with self._lock:
            if self._written >= MOST:
                raise ConfigurationError(
                    f"saved runs must be at most {MOST}; start the page anew"
                )
            if len(duel.recorder.times) < 3:
                raise ConfigurationError("nothing has been played yet")
            run = duel.run(outcome or Outcome.INTERRUPTED, duel.world.time)
            name = f"live-seed{run.settings.seed}"
            folder = write_run(free_folder(self._parent, name), run).parent
            if hand:
                with writing(folder / HAND) as draft:
                    draft.write_text(json.dumps(hand, indent=1) + "\n")
            self._written += 1
        return folder
