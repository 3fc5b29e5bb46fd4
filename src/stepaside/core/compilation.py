"""Compilation by Numba at the first call; :mod:`.compiled_cache` keeps it.

Importing Numba takes longer than importing everything else, so that it is
imported when a function is first compiled. With ``NUMBA_DISABLE_JIT=1`` the
same functions run as Python.
"""

import gc
import os
from collections.abc import Callable
from functools import cache, cached_property, partial, update_wrapper
from types import FunctionType
from typing import Any, TypeVar, cast

F = TypeVar("F", bound=Callable[..., Any])
R = TypeVar("R")
_OPTIONS: dict[str, Any] = {
    "error_model": "numpy",
    "fastmath": {"contract"},
    "no_cfunc_wrapper": True,  # nothing takes a function as a value
}
_marked: list[tuple[Callable[..., Any], bool]] = []


@cache
def load_numba() -> Any:
    """Return the module numba."""
    collects = gc.isenabled()
    gc.disable()  # it makes a million objects to stay: a third of the time
    import numba
    import numba.extending
    from numba.core.registry import cpu_target

    cpu_target.typing_context.refresh()
    cpu_target.target_context.refresh()
    if collects:
        gc.enable()
    return numba


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
    if os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0"):
        return function
    return cast(F, _Compiled(cast(FunctionType, function), options))


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
    return load_numba().prange


def bound(
    function: Callable[..., R], *arguments: Any, more: tuple[Any, ...] = ()
) -> Callable[..., R]:
    """Return a compiled function of fixed arguments, compiled at once.

    Arrays among these must stay where they are in memory. At a call it takes
    the rest, of the very types of ``more``.
    """
    if not isinstance(function, _Compiled):
        return partial(function, *arguments)
    typeof = load_numba().typeof
    types = tuple(map(typeof, (*arguments, *more)))
    # Not the dispatcher, which looks at the types at every call.
    return partial(function.dispatcher.compile(types), *arguments)


class _Compiled:
    """Function that is compiled for the types of its arguments."""

    def __init__(self, function: FunctionType, options: dict[str, Any]):
        self.function, self._options = function, options
        update_wrapper(self, function)

    def __call__(self, *arguments: Any, **named: Any) -> Any:
        return self.dispatcher(*arguments, **named)

    @cached_property
    def dispatcher(self) -> Any:
        """Dispatcher of Numba."""
        numba = load_numba()
        while _marked:
            marked, inline = _marked.pop()
            register = numba.extending.register_jitable
            register(forceinline=inline, **_OPTIONS)(marked)
        made = numba.njit(**self._options, **_OPTIONS)(self.function)
        from .compiled_cache import cache_of

        made._cache = cache_of(self.function) or made._cache
        return made

    @property
    def _numba_type_(self) -> Any:
        """Type of the function where compiled code calls it."""
        return self.dispatcher._numba_type_


@inlined
def copy_values(source: Any, target: Any) -> None:
    """Copy values along one axis, in compiled code.

    An assignment of slices compiles for three more seconds: its message about
    unequal shapes is formatted by compiled code.
    """
    for i in range(len(source)):
        target[i] = source[i]
