"""Output files: checked before the work begins, replaced atomically."""

import os
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from stat import S_IMODE, S_ISREG

from .errors import ConfigurationError, OutputError

FIGURES = (".png", ".svg", ".pdf")
DRAFT = ".draft-"  # prefix of the folders of unfinished output


def check_file(
    file: Path,
    name: str = "output",
    *,
    suffixes: Sequence[str] = (),
    overwrite: bool = False,
) -> None:
    """Check that a file can be written, without creating it.

    The name is that of the option, for messages; without suffixes any may be.
    """
    there, rule = _existing(file, name), ""
    if suffixes and file.suffix.lower() not in suffixes:
        rule = f"end in {', '.join(suffixes)}"
    elif file.name in ("", ".", ".."):
        rule = "be a file"
    elif there is not None and not S_ISREG(there.st_mode):
        rule = "be a regular file"
    if rule:
        raise ConfigurationError(f"{name} must {rule}, got {str(file)!r}")
    if there is not None and not overwrite:
        raise ConfigurationError(
            f"{name} must be a file that does not exist yet, got "
            f"{str(file)!r}; --overwrite replaces it"
        )
    _check_writable(Path(os.path.realpath(file)).parent, file, name)


def check_folder(folder: Path, name: str = "output", *, new: bool) -> None:
    """Check that a folder can be written, and if ``new`` is new or empty."""
    place = folder
    if _existing(folder, name) is None:
        place = folder.absolute().parent
    elif not folder.is_dir() or (new and any(folder.iterdir())):
        kind = "a new or an empty folder" if new else "a folder"
        raise ConfigurationError(f"{name} must be {kind}, got {folder}")
    _check_writable(place, folder, name)


@contextmanager
def atomic_draft(file: Path) -> Iterator[Path]:
    """Yield a draft that replaces the file atomically on success.

    A link is followed, missing folders are created. A draft that cannot be
    written is removed.
    """
    target = Path(os.path.realpath(file))
    with _draft_of(target) as draft:
        yield draft
        if target.exists():
            draft.chmod(S_IMODE(target.stat().st_mode))
        draft.replace(target)


@contextmanager
def folder_draft(folder: Path) -> Iterator[Path]:
    """Yield an unfinished folder for a folder that is to be written.

    The caller renames it when it is complete; otherwise it is removed.
    """
    with _draft_of(folder) as draft:
        draft.mkdir()
        yield draft


@contextmanager
def _draft_of(path: Path) -> Iterator[Path]:
    """Yield a path of the same name in a temporary folder beside a path."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(
            prefix=DRAFT, dir=path.parent, ignore_cleanup_errors=True
        ) as folder:
            yield Path(folder, path.name)
    except OutputError:
        raise
    except OSError as error:
        raise OutputError(
            f"{path} could not be written: {reason_of(error)}"
        ) from error


def reason_of(error: BaseException) -> str:
    """Return the operating system's short text for an error."""
    text = getattr(error, "strerror", None) or str(error)
    return (text or type(error).__name__).lower()


def _existing(path: Path, name: str) -> os.stat_result | None:
    """Return the status of a path, following links; None if missing."""
    try:
        return path.stat()
    except (OSError, ValueError) as error:
        missing = isinstance(error, FileNotFoundError)
        if missing and not os.path.lexists(path):
            return None
        reason = "it is a dangling link" if missing else reason_of(error)
        raise ConfigurationError(
            f"{name} must be a path that can be written, got {_short(path)}: "
            f"{reason}"
        ) from error


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
