"""Recording of ``stepaside play``."""

import logging
from pathlib import Path
from types import TracebackType

from ..core.atomic_output import reason_of
from ..core.errors import OutputError, StepAsideError
from ..drivers.play_log import PlayLog, PlayTick
from ..games.game import Outcome
from ..games.play_settings import PlaySettings
from ..games.run_archive import CONFIGURATION, complete_play
from ..games.settings_reader import dump_configuration


class PlayRecord:
    """Recorder of ticks, which become a run folder at the end.

    If the record cannot be written any more, the robot continues.
    """

    def __init__(self, folder: Path, settings: PlaySettings) -> None:
        """Check the folder, which must not exist or must be empty."""
        self._settings = settings
        text = dump_configuration(settings)
        self._log = PlayLog(folder, {CONFIGURATION: text})
        self.ended = ""  # why the last session ended
        self._failed: OutputError | None = None

    def note(self, tick: PlayTick) -> None:
        """Record a tick, unless writing has failed before."""
        if self._failed is None:
            try:
                self._log.note(tick)
            except OSError as error:
                self._fail(error)

    def leave(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close the log and convert it to a run, however the game ended.

        Raises:
            OutputError: If the folder could not be written, and there was no
                other error.
        """
        folder = self._log.folder
        try:
            if self._failed is None:
                self._log.close()
            if self._failed is None and self._log.count:
                ending = _outcome_of(error, self.ended)
                complete_play(folder, self._settings, *ending)
                logging.info("record: %s", folder)
        except OSError as failure:
            self._fail(failure)
        except (StepAsideError, ValueError) as failure:
            logging.warning("%s is not a complete run: %s", folder, failure)
        if self._failed is not None and error is None:
            raise self._failed

    def _fail(self, error: OSError) -> None:
        if not isinstance(error, OutputError):
            reason = f"could not be written: {reason_of(error)}"
            error = OutputError(f"{self._log.folder} {reason}")
        self._failed = error
        logging.warning("recording stopped: %s", error)


def _outcome_of(
    error: BaseException | None, ended: str
) -> tuple[Outcome, str]:
    if isinstance(error, KeyboardInterrupt) or ended == "interrupted":
        return Outcome.INTERRUPTED, "interrupted"
    if error is None:
        return Outcome.COMPLETED, ended
    return Outcome.FAILED, str(error) or type(error).__name__
