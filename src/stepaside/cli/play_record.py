"""What ``stepaside play --record`` keeps, from the first tick to the end."""

import logging
import tempfile
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

from ..core.atomic_output import free_file, reason_of
from ..core.errors import OutputError, StepAsideError
from ..drivers.guardian_process import SessionLost
from ..drivers.play_log import PlayLog
from ..games.configuration_file import dump_configuration, spelled_settings
from ..games.duel_settings import EVADER
from ..games.outcome import Outcome
from ..games.play_conversion import seal_play
from ..games.play_settings import PlaySettings
from ..games.run_archive import CONFIGURATION
from ..strategies.registry import describe_strategy

if TYPE_CHECKING:
    from ..drivers.joint.joint_loop import JointTick
    from ..drivers.velocity.velocity_loop import VelocityTick
    from ..games.duel_settings import DuelSettings


class PlayRecord:
    """Keeps ticks as they come, and makes a run folder of them at the end.

    A robot plays on if its record cannot be written any more: what there is
    of it is kept elsewhere at the end.

    Attributes:
        log: What is kept.
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
        self._failed: OutputError | None = None

    def note(self, tick: "JointTick | VelocityTick") -> None:
        """Keep a tick, if it can be kept."""
        if self._failed is None:
            try:
                self.log.note(tick)
            except OSError as error:
                self._fail(error)

    def _fail(self, error: OSError) -> None:
        if not isinstance(error, OutputError):
            said = f"could not be written: {reason_of(error)}"
            error = OutputError(f"{self.log.folder} {said}")
        self._failed = error
        logging.warning("nothing more is recorded: %s", error)

    def leave(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close the rows and make a run of them, however it ended.

        Raises:
            OutputError: If it does not lie where it should, and nothing else
                went wrong.
        """
        how = _outcome_of(error, self.ended)
        folder = self.log.folder
        try:
            if self._failed is None:
                self.log.close()
                self._seal(folder, *how)
        except OSError as failure:
            self._fail(failure)
        if self._failed is not None:
            spare = Path(tempfile.gettempdir()) / f"stepaside-{folder.name}"
            folder = free_file(spare)
            try:
                self.log.copy_to(folder)
                self._seal(folder, *how)
            except OSError as failure:
                logging.warning("%s: %s", folder, reason_of(failure))
            if error is None:
                raise self._failed

    def _seal(self, folder: Path, outcome: Outcome, message: str) -> None:
        if not self.log.count:
            return
        try:
            seal_play(folder, self._settings, outcome, message)
        except OSError:
            raise
        except (StepAsideError, ValueError) as failure:
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
        plays=describe_strategy(
            settings.evader_strategy
            if role == EVADER
            else settings.pursuer_strategy
        ),
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
