"""What ``stepaside play --record`` keeps, from the first tick to the end."""

import logging
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

from ..drivers.log import PlayLog
from ..drivers.session import SessionLost
from ..errors import StepAsideError
from ..games.configuration import dump_configuration, spelled_settings
from ..games.folder import CONFIGURATION
from ..games.outcome import Outcome
from ..games.play_settings import PlaySettings
from ..games.played import seal_play
from ..games.settings import EVADER

if TYPE_CHECKING:
    from ..games.settings import DuelSettings


class PlayRecord:
    """Keeps ticks as they come, and makes a run folder of them at the end.

    Attributes:
        log: What looks on.
        ended: Why the last session ended; empty while none did.
    """

    def __init__(
        self, folder: Path, settings: "DuelSettings", options: dict[str, Any]
    ) -> None:
        """Try the folder.

        Args:
            folder: Must not exist yet, or be empty.
            settings: How the player plays.
            options: Of the command.

        Raises:
            ConfigurationError: If it cannot be written.
        """
        self._settings = settings_of_play(settings, options)
        spelled = spelled_settings(self._settings)
        about = options | {k: spelled[k] for k in ("gait", "control")}
        text = dump_configuration(self._settings)
        self.log = PlayLog(folder, about, {CONFIGURATION: text})
        self.ended = ""

    def leave(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close the rows and make a run of them, however it ended."""
        self.log.close()
        if not self.log.count:
            return
        outcome, message = _outcome_of(error, self.ended)
        folder = self.log.folder
        try:
            seal_play(folder, self._settings, outcome, message)
        except (StepAsideError, OSError, ValueError) as failure:
            logging.warning("%s was not made a run: %s", folder, failure)
        else:
            logging.info("record: %s", folder)


def settings_of_play(
    settings: "DuelSettings", options: dict[str, Any]
) -> PlaySettings:
    """What a player was told, of the words of its command."""
    role = options["role"]
    return PlaySettings(
        role=role,
        language=options["robot"].partition(":")[0],
        robot=options["description"],
        plays=settings.evader_strategy
        if role == EVADER
        else settings.pursuer_strategy,
        strategy=settings.strategy,
        gait=settings.gait,
        control=settings.control,
        dry_run=options["dry_run"],
    )


def _outcome_of(
    error: BaseException | None, ended: str
) -> tuple[Outcome, str]:
    if isinstance(error, KeyboardInterrupt) or ended == "interrupted":
        return Outcome.INTERRUPTED, "interrupted"
    if error is None:
        return Outcome.COMPLETED, ended
    cause = error.__cause__
    lost = cause if isinstance(cause, SessionLost) else error
    return Outcome.FAILED, str(lost) or type(lost).__name__
