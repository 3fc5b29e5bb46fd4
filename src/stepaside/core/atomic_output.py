"""Output files: checked before the work begins, replaced atomically."""

import os
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from stat import S_IMODE, S_ISREG

from .errors import ConfigurationError, OutputError

FIGURES = (".png", ".svg", ".pdf")
DRAFT = ".draft-"  # prefix of unfinished output


def check_file(
    file: Path,
    name: str = "output",
    *,
    suffixes: Sequence[str] = (),
    overwrite: bool = False,
) -> None:
    """Check that a file can be written, without creating it.

    Args:
        file: Output file.
        name: Name of the option, for messages.
        suffixes: Permitted suffixes; any if empty.
        overwrite: Whether an existing file may be replaced.

    Raises:
        ConfigurationError: If it cannot be written, with the reason.
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
            f"{name} must be a regular file, got {str(file)!r}"
        )
    if there is not None and not overwrite:
        raise ConfigurationError(
            f"{name} must be a file that does not exist yet, got "
            f"{str(file)!r}; --overwrite replaces it"
        )
    _check_writable(_target(file).parent, file, name)


def check_folder(folder: Path, name: str = "output", *, new: bool) -> None:
    """Check that a folder can be written to; see :func:`check_file`.

    Args:
        folder: Folder of the output files.
        name: Name of the option, for messages.
        new: Whether it must be new or empty.

    Raises:
        ConfigurationError: If it cannot be written, with the reason.
    """
    there = _existing(folder, name)
    if there is None:
        _check_writable(folder.absolute().parent, folder, name)
        return
    if not folder.is_dir() or (new and any(folder.iterdir())):
        kind = "a new or an empty folder" if new else "a folder"
        raise ConfigurationError(f"{name} must be {kind}, got {folder}")
    _check_writable(folder, folder, name)


def free_file(file: Path) -> Path:
    """Return the first path of name, name-2, ... that does not exist."""
    found, number = file, 1
    while os.path.lexists(found):
        number += 1
        found = file.with_name(f"{file.stem}-{number}{file.suffix}")
    return found


@contextmanager
def atomic_draft(file: Path) -> Iterator[Path]:
    """Yield a draft that replaces the file atomically on success.

    Args:
        file: Output file; a link is followed. Missing folders are created.

    Raises:
        OutputError: If it cannot be written; the draft is removed.
    """
    draft = None
    try:
        target = _target(file)
        target.parent.mkdir(parents=True, exist_ok=True)
        handle, draft = tempfile.mkstemp(
            prefix=DRAFT, suffix=file.suffix, dir=target.parent
        )
        os.close(handle)
        yield Path(draft)
        mode = 0o666 & ~_mask()
        if target.exists():
            mode = S_IMODE(target.stat().st_mode)
        os.chmod(draft, mode)
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


@contextmanager
def folder_draft(folder: Path) -> Iterator[Path]:
    """Yield an unfinished folder beside a folder that is to be written.

    The caller renames it when it is complete; otherwise it is removed.

    Args:
        folder: Folder to write. Missing parents are created.

    Raises:
        OutputError: If it cannot be written.
    """
    draft = None
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        draft = Path(tempfile.mkdtemp(prefix=DRAFT, dir=folder.parent))
        draft.chmod(0o777 & ~_mask())
        yield draft
    except OutputError:
        raise
    except OSError as error:
        raise OutputError(
            f"{folder} could not be written: {reason_of(error)}"
        ) from error
    finally:
        if draft is not None:
            shutil.rmtree(draft, ignore_errors=True)


def reason_of(error: BaseException) -> str:
    """Return the operating system's short text for an error."""
    text = getattr(error, "strerror", None) or str(error)
    return (text or type(error).__name__).lower()


def _mask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _target(file: Path) -> Path:
    return Path(os.path.realpath(file))


def _existing(path: Path, name: str) -> os.stat_result | None:
    """Return the status of a path, following links; None if missing."""
    try:
        return path.stat()
    except FileNotFoundError as error:
        if not os.path.lexists(path):
            return None
        cause: BaseException = error
        reason = "it is a dangling link"
    except (OSError, ValueError) as error:
        cause = error
        reason = reason_of(error)
    raise ConfigurationError(
        f"{name} must be a path that can be written, got {_short(path)}: "
        f"{reason}"
    ) from cause


def _short(path: Path) -> str:
    text = repr(str(path))
    return text if len(text) < 120 else f"{text[:100]}...'"


def _check_writable(folder: Path, output: Path, name: str) -> None:
    """Write a temporary file: only then a read-only mount shows."""
    while not os.path.lexists(folder):
        folder = folder.parent
    try:
        with tempfile.TemporaryFile(prefix=DRAFT, dir=folder):
            pass
    except OSError as error:
        raise ConfigurationError(
            f"{name} must lie in a folder that can be written, got "
            f"{_short(output)}: {reason_of(error)}"
        ) from error
