"""Output folders that become full or vanish just before a command writes.

Each command writes all its outputs; before one of its file operations, the
folder is changed.
"""

import json
import os
import resource
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from functools import cache
from pathlib import Path
from random import Random
from typing import NamedTuple
from unittest.mock import patch

from click.testing import CliRunner, Result

from stepaside.cli.main import main
from stepaside.core.errors import StepAsideError
from stepaside.games.run_archive import load_run

from .case import Case, told
from .moments import unwhole
from .outlets import files_of, quickly, words_of, writers
from .striking import Strike, struck

REFUSED = 2
TOP, PLACE, SPARE = "top", "place", "spare"
RUNS = {
    "duel",
    "game",
    "walk",
}  # what they played lies somewhere, however it ends
SIZE = "4m"  # of a small file system


def gone(place: Path) -> None:
    """Remove a folder."""
    shutil.rmtree(place, ignore_errors=True)


def all_gone(place: Path) -> None:
    """Remove the parent folder, too."""
    for entry in place.parent.iterdir():  # it may be a mounted one
        shutil.rmtree(entry)
    with suppress(OSError):
        place.parent.rmdir()


def taken(place: Path) -> None:
    """Replace a folder by a file, so that it cannot be created again."""
    shutil.rmtree(place)
    place.write_text("mine")


def full(place: Path) -> None:
    """Fill the small file system of a folder."""
    filler = os.open(place.parent / "filler", os.O_WRONLY | os.O_CREAT)
    try:
        for size in (2**16, 2**12):
            with suppress(OSError):
                while os.write(filler, bytes(size)):
                    pass
    finally:
        os.close(filler)


def short_of(place: Path) -> None:
    """Limit the size of files to a few bytes, like a full disk."""
    limit = resource.getrlimit(resource.RLIMIT_FSIZE)[1]
    resource.setrlimit(resource.RLIMIT_FSIZE, (10, limit))


FAULTS: dict[str, Callable[[Path], None]] = {
    "gone": gone,
    "gone with its parent": all_gone,
    "taken": taken,
    "full": full,
    "short of room": short_of,
}


class Told(NamedTuple):
    """Outcome of a command.

    Attributes:
        result: Output and exit status.
        strike: File operations before and after the fault.
    """

    result: Result
    strike: Strike


def place_cases(random: Random, run: Path) -> Iterator[Case]:
    """Yield commands with a fault before a file operation, without end."""
    while True:
        for name in writers():
            fault = random.choice(sorted(FAULTS))
            yield place_case(name, run, fault, random.random())


def place_case(name: str, run: Path, fault: str, part: float) -> Case:
    """Return a command whose output folder fails before a file operation.

    Args:
        name: Name of the command.
        run: Run folder, for commands that read one.
        fault: Name in ``FAULTS``.
        part: Fraction of the file operations done before the fault.
    """

    def try_it(folder: Path) -> str:
        whole, lacks = undisturbed(name, run)
        if lacks:
            return f"not written without a disturbance: {lacks}"
        number = int(part * len(whole.strike.touched))
        with room_in(folder, small=fault == "full"):
            found = play(name, run, folder, number, FAULTS[fault])
            return _wrong(name, folder, fault, found, whole)

    title = f"{name}, {fault} at {part:.2f}"
    return Case(f"places of {name}", title, try_it, 300.0)


@cache
def undisturbed(name: str, run: Path) -> tuple[Told, list[str]]:
    """Return the outcome of a command without a fault."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / TOP).mkdir()
        told = play(name, run, Path(folder), None, gone)
        files = files_of(name, Path(folder) / TOP / PLACE)
        return told, [file.name for file in files if not file.exists()]


@contextmanager
def room_in(folder: Path, *, small: bool) -> Iterator[None]:
    """Create the parent of the output folder, as a small file system if asked.

    If none can be mounted, the size of files is limited instead.
    """
    (folder / TOP).mkdir()
    words = ["mount", "-t", "tmpfs", "-o", f"size={SIZE}", "none"]
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    mounted = small and not _run(*words, str(folder / TOP))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        if mounted:
            _run("umount", "--lazy", str(folder / TOP))


def _run(*words: str) -> int:
    try:
        return subprocess.run(words, capture_output=True).returncode
    except OSError:
        return 1


def play(
    name: str,
    run: Path,
    folder: Path,
    number: int | None,
    fault: Callable[[Path], None],
) -> Told:
    """Run a command in this process, with a fault at one file operation."""
    place, spare = folder / TOP / PLACE, folder / SPARE
    place.mkdir()
    spare.mkdir()
    strike = Strike(place, number, lambda: fault(place))
    with ExitStack() as stack:
        stack.enter_context(patch.object(tempfile, "tempdir", str(spare)))
        stack.enter_context(quickly())
        stack.enter_context(struck(strike))
        result = CliRunner().invoke(main, words_of(name, run, place))
    return Told(result, strike)


def _wrong(
    name: str, folder: Path, fault: str, found: Told, whole: Told
) -> str:
    """Return what is wrong with the outcome of a command with a fault."""
    error = found.result.exception
    if error is not None and not isinstance(error, SystemExit):
        return f"traceback: {told(error)}"
    return (
        _wrong_words(found.result, whole.result)
        or _lost(name, folder, fault, found)
        or unwhole(folder, killed=False)
        or _empty(folder)
    )


def _wrong_words(result: Result, whole: Result) -> str:
    """Return what is wrong with the output."""
    if result.exit_code not in (whole.exit_code, REFUSED):
        return f"status {result.exit_code}: {result.stderr[-300:]!r}"
    if result.exit_code != REFUSED:
        return ""
    said = result.stderr.splitlines()
    if not said or not said[-1].startswith("stepaside: "):
        return f"no word: {result.stderr[-300:]!r}"
    if not _is_refusal(result) and not _is_answer(result.stdout, whole.stdout):
        return f"no result: {said[-1]!r}"
    return ""


def _is_refusal(result: Result) -> bool:
    """Return whether the output was refused before any work."""
    return result.exit_code == REFUSED and "must" in result.stderr


def _lost(name: str, folder: Path, fault: str, found: Told) -> str:
    """Return which result is missing."""
    place, strike = folder / TOP / PLACE, found.strike
    if found.result.exit_code != REFUSED:
        for file in files_of(name, place):
            if not file.exists() and not strike.has_done(file):
                return f"lost: {file.name}"
    # Where no file may grow, a run can be kept nowhere.
    if name not in RUNS or fault == "short of room":
        return ""
    if _is_refusal(found.result) or strike.has_done(place / "output"):
        return ""
    said = found.result.stderr
    kept = any(map(_is_run, _folders(folder, said.splitlines())))
    return "" if kept else f"no run: {said[-300:]!r}"


def _is_answer(text: str, whole: str) -> bool:
    """Return whether a result was printed as it is without a fault."""
    if whole.lstrip()[:1] not in ("{", "["):
        return bool(text.strip()) or not whole.strip()
    try:
        json.loads(text)
    except ValueError:
        return False
    return True


def _folders(folder: Path, said: list[str]) -> Iterator[Path]:
    """Yield the folders where a run may be: requested or in the message."""
    yield from (folder / TOP / PLACE).glob("*")
    for path in (folder / SPARE).glob("*"):
        if any(str(path) in line for line in said):
            yield path


def _is_run(folder: Path) -> bool:
    try:
        load_run(folder)
    except (StepAsideError, OSError):
        return False
    return True


def _empty(folder: Path) -> str:
    for file in folder.rglob("*"):
        if file.is_file() and not file.stat().st_size:
            return f"not whole: {file.name} is empty"
    return ""
