"""Where results go: tried before work begins, written whole or not at all."""

import os
import platform
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from hashlib import sha256
from pathlib import Path
from stat import S_ISREG

from .errors import ConfigurationError, OutputError

FIGURES = (".png", ".svg", ".pdf")
DRAFT = ".draft-"  # begins the names of what is not whole yet
ROOM = 2**20  # that must be free for a result, in [bytes]


def check_file(
    file: Path,
    name: str = "output",
    *,
    suffixes: Sequence[str] = (),
    overwrite: bool = False,
) -> None:
    """Refuse a file that could not be written; nothing is left of the trial.

    Args:
        file: What would be written.
        name: Of the option that asks for it, for messages.
        suffixes: What it may end in; anything if empty.
        overwrite: Whether a file may be there already.

    Raises:
        ConfigurationError: If it could not; it says why.
    """
    if suffixes and file.suffix.lower() not in suffixes:
        raise ConfigurationError(
            f"{name} must end in {', '.join(suffixes)}, got {str(file)!r}"
        )
    if file.name in ("", ".", ".."):
        raise ConfigurationError(f"{name} must be a file, got {str(file)!r}")
    there = _existing(file, name)
    if there is not None and not S_ISREG(there.st_mode):
        raise ConfigurationError(
            f"{name} must be a file, got {str(file)!r}, which is something "
            "else"
        )
    if there is not None and not overwrite:
        raise ConfigurationError(
            f"{name} must be a file that does not exist yet, got "
            f"{str(file)!r}; --overwrite replaces it"
        )
    _check_room(_target(file).parent, file, name)


def check_folder(folder: Path, name: str = "output", *, new: bool) -> None:
    """Refuse a folder that could not be written to; see :func:`check_file`.

    Args:
        folder: Where several files would lie.
        name: Of the option that asks for it, for messages.
        new: Whether nothing may be in it yet.

    Raises:
        ConfigurationError: If it could not; it says why.
    """
    there = _existing(folder, name)
    if there is None:
        _check_room(folder.absolute().parent, folder, name)
        return
    if not folder.is_dir() or (new and any(folder.iterdir())):
        kind = "a new or an empty folder" if new else "a folder"
        raise ConfigurationError(f"{name} must be {kind}, got {folder}")
    _check_room(folder, folder, name)


def free_file(file: Path) -> Path:
    """File beside this one that does not exist yet: name, name-2, ..."""
    found, number = file, 1
    while os.path.lexists(found):
        number += 1
        found = file.with_name(f"{file.stem}-{number}{file.suffix}")
    return found


@contextmanager
def writing(file: Path) -> Iterator[Path]:
    """Give a draft to write, which becomes the file when it is whole.

    Args:
        file: What to write; of a link, what it leads to. Folders that lack
            are made.

    Raises:
        OutputError: If the system does not let it be written; nothing of it
            is left then.
    """
    draft = None
    try:
        target = _target(file)
        target.parent.mkdir(parents=True, exist_ok=True)
        sweep(target.parent)
        handle, draft = tempfile.mkstemp(
            prefix=draft_prefix(), suffix=file.suffix, dir=target.parent
        )
        os.close(handle)
        yield Path(draft)
        os.chmod(draft, 0o666 & ~_mask())
        os.replace(draft, target)
    except OutputError:
        raise
    except OSError as error:
        raise OutputError(
            f"{file} could not be written: {reason_of(error)}"
        ) from error
    finally:
        if draft is not None:
            with suppress(OSError):
                os.unlink(draft)


def draft_prefix() -> str:
    """Beginning of a draft's name: whose it is."""
    return f"{DRAFT}{_machine()}-{os.getpid()}-"


def sweep(folder: Path) -> None:
    """Remove drafts of processes of this machine that are no more.

    One that was killed at once could not do it itself.

    Args:
        folder: Where drafts may lie; it exists.
    """
    mine = f"{DRAFT}{_machine()}-"
    for entry in os.scandir(folder):
        number = entry.name.removeprefix(mine).partition("-")[0]
        if not entry.name.startswith(mine) or not number.isdigit():
            continue
        if _lives(int(number)):
            continue
        if entry.is_dir(follow_symlinks=False):
            shutil.rmtree(entry.path, ignore_errors=True)
        else:
            with suppress(OSError):
                os.unlink(entry.path)


def _machine() -> str:
    """Name of this machine, as a part of a file's name."""
    return sha256(platform.node().encode()).hexdigest()[:8]


def _lives(process: int) -> bool:
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:  # it is somebody else's
        return True
    return True


def reason_of(error: BaseException) -> str:
    """What the system says of an error, in few words."""
    said = getattr(error, "strerror", None) or str(error)
    return (said or type(error).__name__).lower()


def _mask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _target(file: Path) -> Path:
    return Path(os.path.realpath(file))


def _existing(path: Path, name: str) -> os.stat_result | None:
    """What is at a path, at the end of its links; None if nothing is."""
    try:
        return path.stat()
    except FileNotFoundError as error:
        if not os.path.lexists(path):
            return None
        why: BaseException = error
        said = "it is a link to what is not there"
    except (OSError, ValueError) as error:
        why, said = error, reason_of(error)
    raise ConfigurationError(
        f"{name} must be a path that can be written, got {_short(path)}: "
        f"{said}"
    ) from why


def _short(path: Path) -> str:
    text = repr(str(path))
    return text if len(text) < 120 else f"{text[:100]}...'"


def _check_room(folder: Path, wanted: Path, name: str) -> None:
    """Try to write where something shall lie, and leave nothing there."""
    while not os.path.lexists(folder):
        folder = folder.parent
    try:
        # Permissions do not tell everything: only writing does.
        with tempfile.TemporaryFile(prefix=DRAFT, dir=folder):
            free = shutil.disk_usage(folder).free
    except OSError as error:
        raise ConfigurationError(
            f"{name} must lie in a folder that can be written, got "
            f"{_short(wanted)}: {reason_of(error)}"
        ) from error
    if free < ROOM:
        raise ConfigurationError(
            f"{name} must lie where {ROOM} bytes are free, got "
            f"{_short(wanted)}, where {free} are"
        )
