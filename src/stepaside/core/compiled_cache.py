"""Cache of compiled functions, in the folder of the user."""

import os
import sys
from contextlib import suppress
from functools import cache
from hashlib import sha256
from multiprocessing import parent_process
from pathlib import Path
from tempfile import TemporaryFile
from types import CodeType, FunctionType, ModuleType
from typing import Any


def cache_of(function: FunctionType) -> Any:
    """Return the cache of a function; None where nothing can be kept."""
    return _disk_cache()(function) if _keeps() else None


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
                _tell_once("compiling this part, once: some seconds")
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
        value = getattr(value, "function", value)  # of a compiled one
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
    if parent_process() is None:  # workers would repeat it
        print(what, file=sys.stderr, flush=True)
