"""Run folders: atomic output of a game with its figures."""

import os
import tempfile
from pathlib import Path

from ..core.atomic_output import check_folder, folder_draft
from ..core.errors import AnyPath, OutputError, as_path
from ..games.game import Outcome
from ..games.run import Run
from ..games.run_archive import write_checksums, write_run_files


def check_output(folder: Path) -> None:
    """Check that a run can be written to a folder.

    Raises:
        ConfigurationError: If the folder is not empty or cannot be written.
    """
    check_folder(folder, new=True)
    check_folder(folder.absolute().parent, new=False)  # of the draft


def free_folder(parent: Path, name: str) -> Path:
    """Return the first unused folder of name, name-2, ... in ``parent``."""
    folder, number = parent / name, 1
    while os.path.lexists(folder):
        number += 1
        folder = parent / f"{name}-{number}"
    return folder


def figure_name(run: Run) -> str:
    """Return the name of a run's figure, like ``duel.png``."""
    return f"{run.game}.png"


def write_run(folder: AnyPath, run: Run, *, drawn: bool = True) -> Path:
    """Write a game: configuration, summary, trajectories and figures.

    The folder appears when it is complete; beside one that exists it is
    ``NAME-2``.

    Args:
        folder: Folder to create.
        run: The game.
        drawn: Whether to draw figures, which takes a second or two.

    Returns:
        Path of the figure in the folder that was written.

    Raises:
        OutputError: If it cannot be written; partial output is removed.
    """
    folder = as_path(folder, "folder")
    if folder.name in ("", ".."):
        folder = folder.resolve()  # ``.`` has neither name nor parent
    with folder_draft(folder) as draft:
        write_run_files(draft, run)
        figure = figure_name(run)
        if drawn:
            # Imported here: checking a folder must not wait for Matplotlib.
            from .run_figure import draw_run

            draw_run(run, draft / figure)
        write_checksums(draft)
        if folder.is_dir() and any(folder.iterdir()):
            folder = free_folder(folder.parent, folder.name)
        return draft.rename(folder) / figure


def save_run(folder: Path, run: Run) -> tuple[Path | None, OutputError | None]:
    """Write a game, falling back to the temporary folder.

    A game that was interrupted is written without figures, since the user is
    waiting for the prompt.

    Returns:
        Folder that was written, or None if both failed; and the error of the
        first attempt, or None if it succeeded.
    """
    drawn = run.outcome is not Outcome.INTERRUPTED
    try:
        return write_run(folder, run, drawn=drawn).parent, None
    except OutputError as error:
        parent = Path(tempfile.gettempdir())
        try:
            fallback = free_folder(parent, f"stepaside-{folder.name}")
            return write_run(fallback, run, drawn=drawn).parent, error
        except OutputError:
            return None, error
