"""Saving of a finished run, and the messages about where it is."""

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from ..core.errors import OutputError
from .terminal import NOTHING_SAVED, echo, exit_interrupted

if TYPE_CHECKING:
    from ..games.outcome import Outcome
    from ..games.run import Run


class SavedRun(NamedTuple):
    """Location of a saved run.

    Attributes:
        folder: Run folder; None if the run is not saved.
        failed: Error on writing to the requested folder; None if there was
            none.
    """

    folder: Path | None = None
    failed: OutputError | None = None

    @property
    def entries(self) -> dict[str, str]:
        """Path of the folder as an entry of JSON; empty if not saved."""
        return {} if self.folder is None else {"run_folder": str(self.folder)}

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


def save_run(output: Path | None, run: "Run") -> SavedRun:
    """Write a run to a folder, or to a temporary one if that fails.

    Args:
        output: Requested folder; None saves nothing.
        run: Run to save.

    Returns:
        Where it is saved.
    """
    if output is None:
        return SavedRun()
    from ..report.run_folder import save_run

    folder, failed = save_run(output, run)
    if folder is not None and folder != output:
        echo(
            f"stepaside: cannot write to {output}; the run is saved in "
            f"{folder}",
            err=True,
        )
    return SavedRun(folder, failed)
