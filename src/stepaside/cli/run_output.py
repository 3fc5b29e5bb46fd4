"""Saving of a finished run, and the messages about where it is."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from ..core.errors import OutputError
from .interruption import NOTHING_SAVED, exit_interrupted
from .terminal import echo

if TYPE_CHECKING:
    from ..games.outcome import Outcome
    from ..games.run import Run

R = TypeVar("R", bound="Run")


class SavedRun(NamedTuple):
    """Location of a saved run.

    Attributes:
        folder: Run folder; None if the run is not saved.
        failed: Error on writing to the requested folder; None if there was
            none.
    """

    folder: Path | None = None
    failed: OutputError | None = None

    def print_paths(self, figure: str) -> None:
        """Print the paths of figure and run folder, if the run is saved."""
        if self.folder is not None:
            drawn = self.folder / figure
            echo(f"\nfigure:     {drawn}" if drawn.exists() else "")
            echo(f"run folder: {self.folder}")

    def exit_if_interrupted(self, outcome: "Outcome") -> None:
        """Exit if Ctrl-C ended the game, and print where the run is saved."""
        from ..games.outcome import Outcome

        if outcome is Outcome.INTERRUPTED:
            exit_interrupted(
                f"{NOTHING_SAVED} without --output"
                if self.folder is None
                else f"the run so far is saved in {self.folder}"
            )

    def raise_failure(self) -> None:
        """Raise the error on writing, after everything else is printed.

        Raises:
            OutputError: If the run could not be written where requested.
        """
        if self.failed is not None:
            raise self.failed


def check_run_folder(output: Path | None) -> None:
    """Check that a run can be written to a folder.

    Raises:
        ConfigurationError: If the folder is not empty or not writable.
    """
    if output is not None:
        from ..report.run_folder import check_output

        check_output(output)


def save_run(output: Path | None, run: R) -> tuple[R, SavedRun]:
    """Write a run to a folder, or to a temporary one if that fails.

    Args:
        output: Requested folder; None saves nothing.
        run: Run to save.

    Returns:
        The run with its folder in the summary, and where it is saved.
    """
    if output is None:
        return run, SavedRun()
    from ..report.run_folder import save_run

    folder, failed = save_run(output, run)
    if folder is not None and folder != output:
        echo(
            f"stepaside: cannot write to {output}; the run is saved in "
            f"{folder}",
            err=True,
        )
    summary: Any = run.summary
    path = None if folder is None else str(folder)
    located = replace(run, summary=replace(summary, run_folder=path))
    return located, SavedRun(folder, failed)
