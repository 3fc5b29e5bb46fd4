"""Games of commands: played with a progress bar, saved and reported."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from ..core.progress import show_progress
from .terminal import NOTHING_SAVED, echo, exit_interrupted, print_json

if TYPE_CHECKING:
    from ..games.game import Progress
    from ..games.run import Run

R = TypeVar("R", bound="Run")


def run_folder(
    output: Path | None, as_json: bool, name: str | None
) -> Path | None:
    """Return the folder of a run, checked; None if it is not saved.

    Args:
        output: Requested folder.
        as_json: Whether the result is printed as JSON.
        name: Name of a new folder in ``runs``; None for no such folder.

    Raises:
        ConfigurationError: If the folder is not empty or not writable.
    """
    from ..report.run_folder import check_output, free_folder

    if output is None and name is not None and not as_json:
        output = free_folder(Path("runs"), name)
    if output is not None:
        check_output(output)
    return output


def play_with_bar(
    settings: Any, play: Callable[[Any, "Callable[[Progress], None]"], R]
) -> R:
    """Play a game with a progress bar on standard error.

    Args:
        settings: Settings of the game.
        play: Function that plays it and reports its progress.
    """
    look = "{desc} {bar} {n:.0f}/{total:.0f} s simulated{postfix}"
    total = settings.duration
    with show_progress(
        settings.game, total, "s simulated", bar_format=look
    ) as bar:

        def report(progress: "Progress") -> None:
            bar.n = progress.time
            text = f"{progress.real_time_factor:.1f}x real time"
            if progress.distance is not None:
                text = f"distance {progress.distance:.2f} m, {text}"
            bar.set_postfix_str(text)

        run = play(settings, report)
        bar.n = min(run.duration, total)
        bar.refresh()
    return run


def finish_run(
    run: "Run",
    folder: Path | None,
    as_json: bool,
    show: Callable[[], None],
    results: Any = None,
) -> None:
    """Save and print a run; exit as its outcome and its saving require.

    A run that cannot be saved where requested is saved in the temporary
    folder.

    Args:
        run: The run.
        folder: Folder to write; None to save nothing.
        as_json: Whether to print one JSON object.
        show: Prints the summary.
        results: Results for JSON; those of the run by default.

    Raises:
        OutputError: If the run could not be written to the folder.
    """
    from ..games.outcome import Outcome
    from ..games.run_archive import results_of
    from ..report.run_folder import figure_name, save_run

    failed = None
    if folder is not None:
        requested = folder
        folder, failed = save_run(requested, run)
        if failed is not None and folder is not None:
            echo(
                f"stepaside: cannot write to {requested}; the run is saved "
                f"in {folder}",
                err=True,
            )
    if as_json:
        saved = {} if folder is None else {"run_folder": str(folder)}
        print_json((results or results_of(run)) | saved)
    else:
        show()
        if folder is not None:
            figure = folder / figure_name(run)
            echo(f"\nfigure:     {figure}" if figure.exists() else "")
            echo(f"run folder: {folder}")
    if failed is not None:
        raise failed
    if run.outcome is Outcome.INTERRUPTED:
        exit_interrupted(
            f"{NOTHING_SAVED} without --output"
            if folder is None
            else f"the run so far is saved in {folder}"
        )
