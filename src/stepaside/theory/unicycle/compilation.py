"""Optional compilation by Numba; without it functions stay as they are.

Numba takes longer to import than all the rest. So functions that compiled
code may call are only marked (:func:`shared`, :func:`inlined`), and Numba is
imported where one is compiled.
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
    """Numba, or None where the extra "fast" is not installed."""
    try:
        import numba
        import numba.extending
    except ImportError:
        return None
    here = Path(__file__).parent
    forget_stale(here, [*here.glob("*.py"), *here.parent.glob("*.py")])
    return numba


def forget_stale(folder: Path, sources: Iterable[Path]) -> None:
    """Drop cached machine code of a folder that is older than any source.

    Numba looks only at the file of a function, not at those of the
    functions it calls.

    Args:
        folder: Where the cached functions are written.
        sources: Files that these functions, or those they call, lie in.
    """
    with suppress(OSError):
        newest = max(file.stat().st_mtime for file in sources)
        for index in (folder / "__pycache__").glob("*.nbi"):
            if index.stat().st_mtime < newest:
                index.unlink()


def shared(function: F) -> F:
    """Let compiled code call a function too, which Python calls as it is.

    So one text serves numbers in compiled loops and arrays in NumPy.
    """
    _marked.append((function, False))
    return function


def inlined(function: F) -> F:
    """Share a function (:func:`shared`) and draw it into compiled loops."""
    _marked.append((function, True))
    return function


def compiled(function: F, **options: Any) -> F:
    """Compile a function of numbers and arrays when it is first called."""
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
    """The range of a loop over cores, for :func:`compiled_parallel`."""
    numba = load_numba()
    return range if numba is None else numba.prange
