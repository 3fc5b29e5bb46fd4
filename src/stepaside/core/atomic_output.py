"""Output files: checked before the work begins, replaced atomically."""

import os
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from stat import S_IMODE
from typing import NoReturn

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
    if suffixes and file.suffix.lower() not in suffixes:
        _refuse(file, name, f"end in {', '.join(suffixes)}")
    if file.name in ("", ".", ".."):
        _refuse(file, name, "be a file")
    with _writable(file, name) as exists:
        if exists and not file.is_file():
            _refuse(file, name, "be a regular file")
        if exists and not overwrite:
            _refuse(file, name, "not exist: only --overwrite replaces it")


def check_folder(folder: Path, name: str = "output", *, new: bool) -> None:
    """Check that a folder can be written, and if ``new`` is new or empty."""
    with _writable(folder, name) as exists:
        taken = exists and not folder.is_dir()
        if taken or (exists and new and any(folder.iterdir())):
            kind = "a new or an empty folder" if new else "a folder"
            _refuse(folder, name, f"be {kind}")


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


@contextmanager
def _writable(path: Path, name: str) -> Iterator[bool]:
    """Yield whether a path exists; then write a temporary file beside it.

    Only this shows a read-only mount.
    """
    try:
        with suppress(FileNotFoundError):
            path.lstat()
        yield os.path.lexists(path)
        folder = Path(os.path.realpath(path))
        while not folder.is_dir():
            folder = folder.parent
        with tempfile.TemporaryFile(prefix=DRAFT, dir=folder):
            pass
    except ConfigurationError:
        raise
    except (OSError, ValueError) as error:
        _refuse(path, name, "be a path that can be written", reason_of(error))


def _refuse(path: Path, name: str, rule: str, reason: str = "") -> NoReturn:
    text = repr(str(path))
    text = text if len(text) < 120 else f"{text[:100]}...'"
    more = f": {reason}" if reason else ""
    raise ConfigurationError(f"{name} must {rule}, got {text}{more}")
