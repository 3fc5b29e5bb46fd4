"""Games of commands: played with a progress bar, saved and reported."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..core.progress import ProgressLine
from ..games.game import Outcome
from .terminal import NOTHING_SAVED, echo, exit_interrupted, print_json

if TYPE_CHECKING:
    from ..games.game import Progress
    from ..games.run import Run


def run_folder(
    output: Path | None, as_json: bool, name: str | None
) -> Path | None:
    """Return the folder of a run, checked; None if it is not saved.

    Without an ``output`` it is a new folder in ``runs`` of a name, if any.

    Raises:
        ConfigurationError: If the folder is not empty or not writable.
    """
    if output is None and (name is None or as_json):
        return None
    from ..report.run_folder import check_output, free_folder

    output = output or free_folder(Path("runs"), name or "")
    check_output(output)
    return output


def play_with_bar(
    settings: Any, play: Callable[[Any, "Callable[[Progress], None]"], "Run"]
) -> "Run":
    """Play a game with a progress bar on standard error."""
    total = settings.duration
    with ProgressLine(settings.game, total, "s simulated") as bar:

        def report(progress: "Progress") -> None:
            text = f"{progress.real_time_factor:.1f}x real time"
            if progress.distance is not None:
                text = f"distance {progress.distance:.2f} m, {text}"
            bar.show(progress.time, text=text)

        run = play(settings, report)
        bar.show(min(run.duration, total))
    return run


def finish_run(
    run: "Run",
    folder: Path | None,
    as_json: bool,
    more: dict[str, int] | None = None,
) -> None:
    """Save and print a run; exit as its outcome and its saving require.

    A run that cannot be saved where requested is saved in the temporary
    folder.

    Args:
        run: The run.
        folder: Folder to write; None to save nothing.
        as_json: Whether to print one JSON object.
        more: Results beside those of the run, by name.

    Raises:
        OutputError: If the run could not be written to the folder.
    """
    failed, figure, requested = None, None, folder
    if folder is not None:
        from ..report.run_folder import figure_name, save_run

        folder, failed = save_run(folder, run)
        figure = folder and folder / figure_name(run)
    if failed is not None and folder is not None:
        echo(
            f"stepaside: cannot write to {requested}; the run is saved "
            f"in {folder}",
            err=True,
        )
    if as_json:
        saved = {} if folder is None else {"run_folder": str(folder)}
        print_json(run.results() | (more or {}) | saved)
    else:
        from .tables import print_run

        print_run(run, more)
        if figure is not None:
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
    if run.outcome is Outcome.FAILED:
        raise SystemExit(1)
