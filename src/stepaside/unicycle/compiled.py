"""Optional compilation by Numba; without it functions stay as they are."""

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeVar

numba: Any
try:
    import numba
except ImportError:  # the extra "fast" is not installed
    numba = None

AVAILABLE = numba is not None
F = TypeVar("F", bound=Callable[..., Any])
_OPTIONS: dict[str, Any] = {
    "cache": True,
    "error_model": "numpy",
    "fastmath": {"contract"},
}


def forget_stale(folder: Path) -> None:
    """Drop cached machine code that is older than any source beside it.

    Numba looks only at the file of a function, not at those of the
    functions it calls.
    """
    with suppress(OSError):
        newest = max(file.stat().st_mtime for file in folder.glob("*.py"))
        for index in (folder / "__pycache__").glob("*.nbi"):
            if index.stat().st_mtime < newest:
                index.unlink()


if AVAILABLE:
    forget_stale(Path(__file__).parent)


def compiled(function: F) -> F:
    """Compile a function of numbers and arrays when it is first called."""
    if numba is None:
        return function
    made: F = numba.njit(**_OPTIONS)(function)
    return made


def compiled_inline(function: F) -> F:
    """Compile a small function into the loops that call it."""
    if numba is None:
        return function
    made: F = numba.njit(forceinline=True, **_OPTIONS)(function)
    return made


def compiled_parallel(function: F) -> F:
    """Compile a function whose ``prange`` loops run on all cores."""
    if numba is None:
        return function
    made: F = numba.njit(parallel=True, nogil=True, **_OPTIONS)(function)
    return made


prange: Any = range if numba is None else numba.prange
"""Range of a loop over cores, for :func:`compiled_parallel`."""
