"""Recording of ``stepaside play``."""

import logging
import tempfile
from dataclasses import asdict, replace
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

from ..core.atomic_output import free_file, reason_of
from ..core.errors import OutputError, StepAsideError
from ..drivers.method_thread import SessionLost
from ..drivers.play_log import PlayLog, PlayTick
from ..games.configuration_file import dump_configuration, json_settings
from ..games.duel_settings import EVADER
from ..games.outcome import Outcome
from ..games.play_settings import PlaySettings
from ..games.run_archive import CONFIGURATION, complete_play
from ..strategies.registry import describe_strategy

if TYPE_CHECKING:
    from ..games.duel_settings import DuelSettings
    from .connection_settings import ConnectionSettings


class PlayRecord:
    """Recorder of ticks, which become a run folder at the end.

    If the record cannot be written any more, the robot continues; the rows
    so far are then copied to the folder for temporary files.

    Attributes:
        log: Recorded rows.
    """

    def __init__(
        self,
        folder: Path,
        settings: "DuelSettings",
        connection: "ConnectionSettings",
    ) -> None:
        """Create the folder.

        Args:
            folder: Run folder; must not exist or must be empty.
            settings: Settings of the player.
            connection: Player and connection.

        Raises:
            ConfigurationError: If the folder cannot be written.
        """
        self._settings = settings_of_play(settings, connection)
        spelled = json_settings(self._settings)
        about = asdict(replace(connection, record=None)) | {
            name: spelled[name] for name in ("gait", "control")
        }
        text = dump_configuration(self._settings)
        self.log = PlayLog(folder, about, {CONFIGURATION: text})
        self._ended = ""
        self._failed: OutputError | None = None

    def note(self, tick: PlayTick) -> None:
        """Record a tick, unless writing has failed before."""
        if self._failed is None:
            try:
                self.log.note(tick)
            except OSError as error:
                self._fail(error)

    def _fail(self, error: OSError) -> None:
        if not isinstance(error, OutputError):
            reason = f"could not be written: {reason_of(error)}"
            error = OutputError(f"{self.log.folder} {reason}")
        self._failed = error
        logging.warning("recording stopped: %s", error)

    def end(self, reason: str) -> None:
        """Note why the last session ended."""
        self._ended = reason

    def leave(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close the log and convert it to a run, however the game ended.

        Raises:
            OutputError: If the requested folder could not be written, and
                there was no other error.
        """
        ending = _outcome_of(error, self._ended)
        folder = self.log.folder
        try:
            if self._failed is None:
                self.log.close()
                self._seal(folder, *ending)
        except OSError as failure:
            self._fail(failure)
        if self._failed is not None:
            spare = Path(tempfile.gettempdir()) / f"stepaside-{folder.name}"
            folder = free_file(spare)
            try:
                self.log.copy_to(folder)
                self._seal(folder, *ending)
            except OSError as failure:
                logging.warning("%s: %s", folder, reason_of(failure))
            if error is None:
                raise self._failed

    def _seal(self, folder: Path, outcome: Outcome, message: str) -> None:
        if not self.log.count:
            return
        try:
            complete_play(folder, self._settings, outcome, message)
        except OSError:
            raise
        except (StepAsideError, ValueError) as failure:
            logging.warning("%s is not a complete run: %s", folder, failure)
        else:
            logging.info("record: %s", folder)


def settings_of_play(
    settings: "DuelSettings", connection: "ConnectionSettings"
) -> PlaySettings:
    """Return the settings of the player from settings and options."""
    return PlaySettings(
        role=connection.role,
        language=connection.language,
        robot=connection.robot,
        plays=describe_strategy(
            settings.evader_strategy
            if connection.role == EVADER
            else settings.pursuer_strategy
        ),
        strategy=settings.strategy,
        gait=settings.gait,
        control=settings.control,
        dry_run=connection.dry_run,
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
