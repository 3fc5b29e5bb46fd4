"""Compilation by Numba at the first call, kept in the cache folder.

Importing Numba takes longer than importing everything else, so that it is
imported when a function is first compiled. With ``NUMBA_DISABLE_JIT=1`` the
same functions run as Python.
"""

import gc
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from functools import cache, cached_property, partial, update_wrapper
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryFile
from types import CodeType, FunctionType, ModuleType
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
        if _keeps():
            made._cache = _disk_cache()(self.function)
        return made

    @property
    def _numba_type_(self) -> Any:
        """Type of the function where compiled code calls it."""
        return self.dispatcher._numba_type_


@cache
def _disk_cache() -> Any:
    """Return the class of Numba's cache, in our folder."""
    from numba.core import caching

    class Locator(caching._CacheLocator):
        def __init__(self, function: FunctionType) -> None:
            self._function = function

        def get_cache_path(self) -> str:
            return str(_folder())

        def get_source_stamp(self) -> str:
            return _digest(self._function)

        def get_disambiguator(self) -> str:
            code = self._function.__code__
            return sha256(code.co_filename.encode()).hexdigest()[:16]

        @classmethod
        def from_function(cls, function: Any, file: str) -> "Locator":
            return cls(function)

    class Implementation(caching.CompileResultCacheImpl):
        _locator_classes: Any = [Locator]

    class DiskCache(caching.FunctionCache):
        _impl_class = Implementation

        def load_overload(self, signature: Any, context: Any) -> Any:
            load: Any = super().load_overload
            try:
                found = load(signature, context)
            except (AttributeError, ImportError):  # a type has been renamed
                flush: Any = self.flush
                flush()
                found = None
            if found is None:
                _tell_once("compiling for this machine, once: some seconds")
            return found

        def save_overload(self, signature: Any, data: Any) -> None:
            save: Any = super().save_overload
            with suppress(OSError):  # it only saves time
                save(signature, data)

    return DiskCache


def _digest(function: FunctionType) -> str:
    """Return a digest of a function, and of all that it refers to."""
    seen: set[int] = set()
    parts: list[str] = []

    def add(value: Any) -> None:
        if isinstance(value, _Compiled):
            value = value.function
        if isinstance(value, FunctionType):
            if id(value) not in seen:
                seen.add(id(value))
                add_code(value.__code__, value.__globals__)
                for kind in value.__annotations__.values():
                    add(kind)  # fields are found by their number
        elif isinstance(value, type):
            parts.append(repr(getattr(value, "__members__", value.__name__)))
            parts.append(repr(getattr(value, "_fields", ())))
        elif not isinstance(value, ModuleType):
            parts.append(repr(value))

    def add_code(code: CodeType, names: dict[str, Any]) -> None:
        parts.append(code.co_code.hex())
        parts.append(str((code.co_names, code.co_varnames)))
        for constant in code.co_consts:
            if isinstance(constant, CodeType):
                add_code(constant, names)
            else:
                parts.append(repr(constant))
        for name in code.co_names:
            if name in names:
                add(names[name])

    add(function)
    return sha256("\n".join(parts).encode()).hexdigest()


def cache_folder() -> Path:
    """Return the cache folder; ``XDG_CACHE_HOME`` is respected."""
    base = os.environ.get("XDG_CACHE_HOME") or "~/.cache"
    return Path(base).expanduser() / "stepaside"


def _folder() -> Path:
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    return Path(chosen) if chosen else cache_folder() / "compiled"


@cache
def _keeps() -> bool:
    """Return whether the cache folder can be written; say if not."""
    try:
        _folder().mkdir(parents=True, exist_ok=True)
        with TemporaryFile(dir=_folder()):
            return True
    except (OSError, RuntimeError):  # the latter without a home
        _tell_once("compiling; the cache folder cannot be written, so that "
                   "each start does; set XDG_CACHE_HOME")  # fmt: skip
        return False


@cache
def _tell_once(what: str) -> None:
    print(what, file=sys.stderr, flush=True)


@inlined
def copy_values(source: Any, target: Any) -> None:
    """Copy values along one axis, in compiled code.

    An assignment of slices compiles for three more seconds: its message about
    unequal shapes is formatted by compiled code.
    """
    for i in range(len(source)):
        target[i] = source[i]
