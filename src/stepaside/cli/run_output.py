"""What commands that play a game do with it when it is over."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from ..core.errors import OutputError
from .interruption import NOTHING, leave_stopped
from .terminal import echo

if TYPE_CHECKING:
    from ..games.outcome import Outcome
    from ..games.run import Run

R = TypeVar("R", bound="Run")


class SavedRun(NamedTuple):
    """Where a run lies.

    Attributes:
        folder: Its folder; None if it lies nowhere.
        failed: Why it does not lie where it should, if it does not.
    """

    folder: Path | None = None
    failed: OutputError | None = None

    def tell(self, figure: str) -> None:
        """Say where figure and folder are, if they are anywhere."""
        if self.folder is not None:
            drawn = self.folder / figure
            echo(f"\nfigure:     {drawn}" if drawn.exists() else "")
            echo(f"run folder: {self.folder}")

    def leave_if(self, outcome: "Outcome") -> None:
        """Leave if Ctrl-C ended the game, and say where it lies."""
        from ..games.outcome import Outcome

        if outcome is Outcome.INTERRUPTED:
            leave_stopped(
                f"{NOTHING} without --output"
                if self.folder is None
                else f"what was played is kept in {self.folder}"
            )

    def check(self) -> None:
        """Raise what failed, when all else is told.

        Raises:
            OutputError: If something did.
        """
        if self.failed is not None:
            raise self.failed


def check_kept(output: Path | None) -> None:
    """Refuse a folder that a run could not be written to.

    Raises:
        ConfigurationError: If it holds something already, or cannot be.
    """
    if output is not None:
        from ..report.run_folder import check_output

        check_output(output)


def keep(output: Path | None, run: R) -> tuple[R, SavedRun]:
    """Write a run where it was asked for, or beside.

    Args:
        output: Folder that was asked for; None keeps nothing.
        run: The run.

    Returns:
        The run, whose figures say where it lies, and where that is.
    """
    if output is None:
        return run, SavedRun()
    from ..report.run_folder import keep_run

    folder, failed = keep_run(output, run)
    if folder is not None and folder != output:
        echo(f"stepaside: not in {output}; the run is in {folder}", err=True)
    summary: Any = run.summary
    where = None if folder is None else str(folder)
    told = replace(run, summary=replace(summary, run_folder=where))
    return told, SavedRun(folder, failed)
