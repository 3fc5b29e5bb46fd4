"""Run folders: a duel on disk, whole or not at all."""

import os
import shutil
import tempfile
from pathlib import Path

from ..errors import ConfigurationError
from ..games.folder import write_record
from ..games.run import Run
from .duel_figure import draw_duel

FIGURE = "duel.png"
SIGHT = "sight.png"


def check_output(folder: Path) -> None:
    """Refuse a folder that a run cannot be written to.

    Raises:
        ConfigurationError: If it holds something already, or cannot be.
    """
    if folder.is_dir() and not any(folder.iterdir()):
        return
    if folder.exists():
        raise ConfigurationError(
            f"output must be a new or an empty folder, got {folder}"
        )
    parent = folder.absolute().parent
    while not parent.exists():
        parent = parent.parent
    if not parent.is_dir() or not os.access(parent, os.W_OK):
        raise ConfigurationError(
            f"output must lie in a folder that can be written, got {folder}"
        )


def free_folder(parent: Path, name: str) -> Path:
    """Folder in ``parent`` that does not exist yet: name, name-2, ..."""
    folder, number = parent / name, 1
    while folder.exists():
        number += 1
        folder = parent / f"{name}-{number}"
    return folder


def write_run(folder: Path, run: Run) -> Path:
    """Write a duel: configuration, summary, trajectories and figures.

    The folder appears when it is complete.

    Args:
        folder: Where it shall lie.
        run: The duel.

    Returns:
        Path of the figure.

    Raises:
        ConfigurationError: If the folder cannot be written.
    """
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        draft = Path(tempfile.mkdtemp(prefix=".draft-", dir=folder.parent))
        _write_whole(draft, folder, run)
    except OSError as error:
        raise ConfigurationError(
            f"output {folder} cannot be written: {error}"
        ) from error
    return folder / FIGURE


def _write_whole(draft: Path, folder: Path, run: Run) -> None:
    """Fill a draft, and put it where the folder shall lie."""
    try:
        write_record(draft, run)
        draw_duel(run, draft / FIGURE)
        if run.stills:
            from .sight_figure import draw_sight

            draw_sight(run, draft / SIGHT)
        if folder.is_dir():
            folder.rmdir()
        draft.chmod(0o755)
        draft.rename(folder)
    except BaseException:
        shutil.rmtree(draft, ignore_errors=True)
        raise
