"""Run folders: a game on disk, whole or not at all."""

import errno
import os
import shutil
import tempfile
from pathlib import Path

from ..core.atomic_output import check_folder, draft_prefix, reason_of, sweep
from ..core.errors import AnyPath, OutputError, as_path
from ..games.checksums import seal
from ..games.outcome import Outcome
from ..games.play_run import PlayRun
from ..games.run import Run
from ..games.run_archive import write_record

SIGHT = "sight.png"


def check_output(folder: Path) -> None:
    """Refuse a folder that a run cannot be written to.

    Raises:
        ConfigurationError: If it holds something already, or cannot be.
    """
    check_folder(folder, new=True)
    check_folder(folder.absolute().parent, new=False)  # of the draft


def free_folder(parent: Path, name: str) -> Path:
    """Folder in ``parent`` that does not exist yet: name, name-2, ..."""
    folder, number = parent / name, 1
    while os.path.lexists(folder):
        number += 1
        folder = parent / f"{name}-{number}"
    return folder


def figure_of(run: Run) -> str:
    """Name of the figure in a run's folder: ``duel.png``, ``walk.png``."""
    return f"{run.game}.png"


def draw_run(run: Run, file: Path) -> None:
    """Write the figure of a game, whatever was played.

    Args:
        run: The game.
        file: File, of a format that its suffix tells.
    """
    # Matplotlib takes as long to import as all the rest: who only checks a
    # folder shall not wait for it.
    if isinstance(run, PlayRun):
        from .play_figure import draw_play

        draw_play(run, file)
    elif run.pair is None:
        from .walk_figure import draw_walk

        draw_walk(run, file)
    else:
        from .duel_figure import draw_duel

        draw_duel(run, file)


def write_run(folder: AnyPath, run: Run, *, drawn: bool = True) -> Path:
    """Write a game: configuration, summary, trajectories and figures.

    The folder appears when it is complete. If somebody else was first, it
    lies beside theirs, as ``NAME-2``.

    Args:
        folder: Where it shall lie.
        run: The game.
        drawn: Whether with figures, which take a second or two.

    Returns:
        Path of the figure, in the folder where the game is.

    Raises:
        OutputError: If it cannot be written; nothing of it is left then.
    """
    draft = None
    folder = as_path(folder, "folder")
    if folder.name in ("", ".."):
        folder = folder.resolve()  # ``.`` has neither name nor parent
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        sweep(folder.parent)
        draft = Path(
            tempfile.mkdtemp(prefix=draft_prefix(), dir=folder.parent)
        )
        write_record(draft, run)
        figure = figure_of(run)
        if drawn:
            draw_run(run, draft / figure)
        if drawn and run.stills:
            from .sight_figure import draw_sight

            draw_sight(run, draft / SIGHT)
        seal(draft)
        draft.chmod(0o755)
        return _move(draft, folder) / figure
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
    """Write a game, or keep it elsewhere if it cannot be written there.

    A game that Ctrl-C ended has no figures: whoever pressed it waits.

    Args:
        folder: Where it shall lie.
        run: The game.

    Returns:
        Folder in which it lies; None if it lies nowhere. And why it does not
        lie where it should; None if it does.
    """
    drawn = run.outcome is not Outcome.INTERRUPTED
    try:
        return write_run(folder, run, drawn=drawn).parent, None
    except OutputError as error:
        place = Path(tempfile.gettempdir())
        try:
            spare = free_folder(place, f"stepaside-{folder.name}")
            return write_run(spare, run, drawn=drawn).parent, error
        except OutputError:
            return None, error
