"""Optional compilation by Numba, which is imported at its first use only.

Importing Numba takes longer than importing everything else. So functions
that compiled code may call are only registered (:func:`shared`,
:func:`inlined`), and Numba is imported when a function is compiled; without
Numba :func:`compiled` does nothing.

Generated formulas (:func:`function_of`, :func:`kernel_of`) run as plain
Python by default, also on board. For long simulations the same source can be
compiled: a few seconds once, then a tenth of the time, with the same bits,
since the order of operations is preserved and nothing is fused.
"""

import os
import sys
from collections.abc import Callable
from contextlib import suppress
from enum import IntEnum
from functools import cache
from hashlib import sha256
from importlib.util import module_from_spec, spec_from_file_location
from math import cos, sin
from pathlib import Path
from tempfile import NamedTemporaryFile
from typing import Any, TypeVar

F = TypeVar("F", bound=Callable[..., Any])
Function = Callable[..., tuple[float, ...]]
Kernel = Callable[..., Any]
HEAD = "from math import cos, sin"
KERNEL_HEAD = f"""\
{HEAD}

from numba import njit

formula = njit(error_model="numpy")"""

_OPTIONS: dict[str, Any] = {
    "error_model": "numpy",
    "fastmath": {"contract"},
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


class JitPreference(IntEnum):
    """Execution of formulas that are traced from now on."""

    PLAIN = 0  # as Python
    STORED = 1  # as machine code if that is in the cache
    COMPILED = 2  # as machine code, compiled if necessary


# Simulated time after which machine code pays off, in [s]: it saves about
# 30 ms a second of a duel; loading it takes 0.8 s, compiling it 7 s.
LOADING_PAYS = 30.0
COMPILING_PAYS = 300.0
_preference = JitPreference.PLAIN
_work = 0.0  # simulated time of this process, in [s]


def prefer(preference: JitPreference) -> None:
    """Raise the preference of this process; it is never lowered."""
    global _preference
    _preference = max(_preference, preference)


def expect_work(duration: float) -> None:
    """Prefer machine code once the games of this process pay for it.

    A campaign is many games in few processes: what counts is their sum.

    Args:
        duration: Simulated time of the next game, in [s].
    """
    global _work
    _work += duration
    if _work >= COMPILING_PAYS:
        prefer(JitPreference.COMPILED)
    elif _work >= LOADING_PAYS:
        prefer(JitPreference.STORED)


def preferred() -> JitPreference:
    """Return the preference of this process."""
    return _preference


def function_of(name: str, text: str) -> Function:
    """Compile the source of a function of floats.

    Args:
        name: Name of the function.
        text: Its definition in Python, which may use ``sin`` and ``cos``.

    Returns:
        The function, as machine code if that is preferred and available.
    """
    if _preference is not JitPreference.PLAIN:
        # A broken cache or Numba is no error: fall back to plain Python.
        with suppress(Exception):
            machine_code: Function | None = _machine_code(name, text)
            if machine_code is not None:
                return machine_code
    namespace: dict[str, Any] = {"sin": sin, "cos": cos}
    exec(compile(text, f"<{name}>", "exec"), namespace)
    plain: Function = namespace[name]
    return plain


def kernel_of(name: str, text: str, arguments: str) -> Kernel | None:
    """Compile a loop over the rows of arrays.

    Divisions by zero give inf or NaN, which the loop has to reject.

    Args:
        name: Name of the function.
        text: Source that defines it and the functions of floats it calls.
        arguments: One letter for each argument: the number of dimensions of
            floats, or "i" for a row of integers.

    Returns:
        The function as machine code; None if that is not preferred or not
        available: the same formulas then run as plain Python.
    """
    if _preference is JitPreference.PLAIN:
        return None
    with suppress(Exception):  # as above
        return _machine_code(name, text, arguments)
    return None


def cache_folder() -> Path:
    """Return the cache folder; ``XDG_CACHE_HOME`` is respected."""
    base = os.environ.get("XDG_CACHE_HOME") or "~/.cache"
    return Path(base).expanduser() / "stepaside"


def _machine_code(
    name: str, text: str, arguments: str | None = None
) -> Any | None:
    """Load the machine code of a source, or compile it if preferred."""
    numba = load_numba()
    if numba is None:
        return None
    content = f"{HEAD if arguments is None else KERNEL_HEAD}\n\n\n{text}"
    digest = sha256(content.encode()).hexdigest()[:16]
    path = cache_folder() / f"{name}_{digest}.py"
    stored = path.is_file() and path.read_text(encoding="utf-8") == content
    if not stored:
        if _preference is not JitPreference.COMPILED:
            return None
        _write(path, content)
    spec = spec_from_file_location(path.stem, path)
    assert spec is not None and spec.loader is not None
    module = module_from_spec(spec)
    sys.modules[spec.name] = module  # Numba's cache looks it up there
    spec.loader.exec_module(module)
    plain = getattr(module, name)
    if arguments is None:
        floats = (numba.float64,) * plain.__code__.co_argcount
        return numba.njit([floats], cache=True)(plain)
    types = {
        "0": numba.float64,
        "1": numba.float64[::1],
        "2": numba.float64[:, ::1],
        "i": numba.int64[::1],
    }
    signature = tuple(types[letter] for letter in arguments)
    return numba.njit([signature], cache=True, error_model="numpy")(plain)


def _write(path: Path, content: str) -> None:
    """Write a file atomically, readable by its owner alone."""
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    with NamedTemporaryFile(
        "w", dir=path.parent, delete=False, encoding="utf-8"
    ) as file:
        file.write(content)
    Path(file.name).replace(path)
