"""Optional compilation by Numba, which is imported at its first use only.

Importing Numba takes longer than importing everything else. So functions
that compiled code may call are only registered (:func:`shared`,
:func:`inlined`), and Numba is imported when a function is compiled; without
Numba :func:`compiled` does nothing.

Loops of a robot's tick do not wait for Numba: see :mod:`.machine_code`.
"""

import os
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

F = TypeVar("F", bound=Callable[..., Any])
_OPTIONS: dict[str, Any] = {
    "error_model": "numpy",
    "fastmath": {"contract"},
    "no_cfunc_wrapper": True,  # nothing takes a function as a value
}
_marked: list[tuple[Callable[..., Any], bool]] = []
_folders: set[Path] = set()  # of functions registered or compiled


@cache
def load_numba() -> Any:
    """Return the module numba, or None without the extra "fast"."""
    try:
        import numba
        import numba.extending
    except ImportError:
        return None
    return numba


def shared(function: F) -> F:
    """Register a function that both compiled code and Python may call.

    One definition then serves numbers in compiled loops and arrays in NumPy.
    """
    _register(function, inline=False)
    return function


def inlined(function: F) -> F:
    """Register a function (:func:`shared`) to be inlined in compiled code."""
    _register(function, inline=True)
    return function


def compiled(function: F, **options: Any) -> F:
    """Compile a function of numbers and arrays at its first call."""
    numba = load_numba()
    if numba is None:
        return function
    folder = Path(function.__code__.co_filename).parent
    _folders.add(folder)
    _forget_stale(folder)
    while _marked:
        marked, inline = _marked.pop()
        register = numba.extending.register_jitable
        register(forceinline=inline, **_OPTIONS)(marked)
    made: F = numba.njit(cache=True, **options, **_OPTIONS)(function)
    return made


def compiled_loop(function: F) -> F:
    """Compile a function that fills arrays but creates none.

    It counts no references, which costs more than the arithmetic of a short
    loop.
    """
    return compiled(function, _nrt=False)


def compiled_parallel(function: F) -> F:
    """Compile a function whose ``prange`` loops run on all cores."""
    return compiled(function, parallel=True, nogil=True)


def parallel_range() -> Any:
    """Return the parallel range of :func:`compiled_parallel` functions."""
    numba = load_numba()
    return range if numba is None else numba.prange


@cache
def _forget_stale(folder: Path) -> None:
    """Delete cached machine code of a folder, older than any source file.

    Numba only checks the file of a function, not the files of the functions
    that it calls.
    """
    with suppress(OSError):
        sources = [file for each in _folders for file in each.glob("*.py")]
        newest = max(file.stat().st_mtime for file in sources)
        for index in (folder / "__pycache__").glob("*.nbi"):
            if index.stat().st_mtime < newest:
                index.unlink()


def _register(function: Callable[..., Any], *, inline: bool) -> None:
    """Note a function that compiled code may call."""
    _marked.append((function, inline))
    _folders.add(Path(function.__code__.co_filename).parent)


@inlined
def copy_values(source: Any, target: Any) -> None:
    """Copy values along one axis, in compiled code.

    An assignment of slices compiles for three more seconds: its message about
    unequal shapes is formatted by compiled code.
    """
    for i in range(len(source)):
        target[i] = source[i]


def cache_folder() -> Path:
    """Return the cache folder; ``XDG_CACHE_HOME`` is respected."""
    base = os.environ.get("XDG_CACHE_HOME") or "~/.cache"
    return Path(base).expanduser() / "stepaside"
