"""Run folders: a duel on disk, whole or not at all."""

import errno
import os
import shutil
import tempfile
from pathlib import Path

from ..errors import OutputError
from ..games.folder import write_record
from ..games.run import Run
from ..outputs import check_folder, reason_of
from .duel_figure import draw_duel

FIGURE = "duel.png"
SIGHT = "sight.png"


def check_output(folder: Path) -> None:
    """Refuse a folder that a run cannot be written to.

    Raises:
        ConfigurationError: If it holds something already, or cannot be.
    """
    check_folder(folder, new=True)


def free_folder(parent: Path, name: str) -> Path:
    """Folder in ``parent`` that does not exist yet: name, name-2, ..."""
    folder, number = parent / name, 1
    while os.path.lexists(folder):
        number += 1
        folder = parent / f"{name}-{number}"
    return folder


def write_run(folder: Path, run: Run) -> Path:
    """Write a duel: configuration, summary, trajectories and figures.

    The folder appears when it is complete. If somebody else was first, it
    lies beside theirs, as ``NAME-2``.

    Args:
        folder: Where it shall lie.
        run: The duel.

    Returns:
        Path of the figure, in the folder where the duel is.

    Raises:
        OutputError: If it cannot be written; nothing of it is left then.
    """
    draft = None
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        draft = Path(tempfile.mkdtemp(prefix=".draft-", dir=folder.parent))
        write_record(draft, run)
        draw_duel(run, draft / FIGURE)
        if run.stills:
            from .sight_figure import draw_sight

            draw_sight(run, draft / SIGHT)
        draft.chmod(0o755)
        return _move(draft, folder) / FIGURE
    except OutputError:
        raise
    except OSError as error:
        raise OutputError(
            f"{folder} could not be written: {reason_of(error)}"
        ) from error
    finally:
        if draft is not None:
            shutil.rmtree(draft, ignore_errors=True)


def _move(draft: Path, folder: Path) -> Path:
    """Move a folder into place, or beside what took the place meanwhile."""
    place = folder
    while True:
        try:
            return draft.rename(place)  # an empty folder gives way
        except OSError as error:
            if error.errno not in (errno.ENOTEMPTY, errno.EEXIST):
                raise
            place = free_folder(folder.parent, folder.name)


def keep_run(folder: Path, run: Run) -> tuple[Path | None, OutputError | None]:
    """Write a duel, or keep it elsewhere if it cannot be written there.

    Args:
        folder: Where it shall lie.
        run: The duel.

    Returns:
        Folder in which it lies; None if it lies nowhere. And why it does not
        lie where it should; None if it does.
    """
    try:
        return write_run(folder, run).parent, None
    except OutputError as error:
        place = Path(tempfile.gettempdir())
        try:
            spare = free_folder(place, f"stepaside-{folder.name}")
            return write_run(spare, run).parent, error
        except OutputError:
            return None, error
