"""Optional compilation by Numba; without Numba the decorators do nothing.

Importing Numba takes longer than importing everything else. So functions
that compiled code may call are only registered (:func:`shared`,
:func:`inlined`), and Numba is imported when a function is compiled.
"""

from collections.abc import Callable, Iterable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

F = TypeVar("F", bound=Callable[..., Any])
_OPTIONS: dict[str, Any] = {
    "error_model": "numpy",
    "fastmath": {"contract"},
}
_marked: list[tuple[Callable[..., Any], bool]] = []


@cache
def load_numba() -> Any:
    """Return the module numba, or None without the extra "fast"."""
    try:
        import numba
        import numba.extending
    except ImportError:
        return None
    here = Path(__file__).parent
    forget_stale(here, [*here.glob("*.py"), *here.parent.glob("*.py")])
    return numba


def forget_stale(folder: Path, sources: Iterable[Path]) -> None:
    """Delete cached machine code that is older than any source file.

    Numba only checks the file of a function, not the files of the functions
    that it calls.

    Args:
        folder: Folder whose ``__pycache__`` holds the cached functions.
        sources: Source files of these functions and of their callees.
    """
    with suppress(OSError):
        newest = max(file.stat().st_mtime for file in sources)
        for index in (folder / "__pycache__").glob("*.nbi"):
            if index.stat().st_mtime < newest:
                index.unlink()


def shared(function: F) -> F:
    """Register a function that both compiled code and Python may call.

    One definition then serves numbers in compiled loops and arrays in NumPy.
    """
    _marked.append((function, False))
    return function


def inlined(function: F) -> F:
    """Register a function (:func:`shared`) to be inlined in compiled code."""
    _marked.append((function, True))
    return function


def compiled(function: F, **options: Any) -> F:
    """Compile a function of numbers and arrays at its first call."""
    numba = load_numba()
    if numba is None:
        return function
    while _marked:
        marked, inline = _marked.pop()
        register = numba.extending.register_jitable
        register(forceinline=inline, **_OPTIONS)(marked)
    made: F = numba.njit(cache=True, **options, **_OPTIONS)(function)
    return made


def compiled_parallel(function: F) -> F:
    """Compile a function whose ``prange`` loops run on all cores."""
    return compiled(function, parallel=True, nogil=True)


def parallel_range() -> Any:
    """Return the parallel range of :func:`compiled_parallel` functions."""
    numba = load_numba()
    return range if numba is None else numba.prange
