"""Formulas of a robot as machine code, kept from one run to the next.

What :mod:`.tracing` writes down runs as it stands wherever Python does, and
that is what a robot gets. Who simulates for hours can have the same text
compiled by Numba: some seconds once, then a tenth of the time, and the same
bits, for the order of operations stays and nothing is fused.
"""

import os
import sys
from collections.abc import Callable
from contextlib import suppress
from enum import IntEnum
from hashlib import sha256
from importlib.util import module_from_spec, spec_from_file_location
from math import cos, sin
from pathlib import Path
from tempfile import NamedTemporaryFile
from typing import Any

Function = Callable[..., tuple[float, ...]]


class JitPreference(IntEnum):
    """How formulas that are traced from now on shall run."""

    PLAIN = 0  # as Python
    STORED = 1  # as machine code where it was stored
    COMPILED = 2  # as machine code, compiled where it was not


LONG = 60.0  # simulated time that is worth loading machine code for, in [s]
_used = JitPreference.PLAIN


def prefer(machine: JitPreference) -> None:
    """Let this process run new formulas that way, or a swifter one."""
    global _used
    _used = max(_used, machine)


def prefer_for(duration: float, *, many: bool = False) -> None:
    """Prefer machine code for games that it pays for.

    Args:
        duration: Simulated time of a game, in [s]; it takes half a second
            to load what is stored.
        many: Whether so many are played that compiling pays, too.
    """
    if duration >= LONG:
        prefer(JitPreference.COMPILED if many else JitPreference.STORED)


def preferred() -> JitPreference:
    """How new formulas run in this process."""
    return _used


def function_of(name: str, text: str) -> Function:
    """Function of floats from its text, which knows ``sin`` and ``cos``.

    Args:
        name: Of the function.
        text: Its definition in Python.

    Returns:
        The function, as machine code if that is preferred and can be had.
    """
    if _used is not JitPreference.PLAIN:
        # Whatever is wrong with stored code: the text itself runs, too.
        with suppress(Exception):
            made = _machine_code(name, text)
            if made is not None:
                return made
    space: dict[str, Any] = {"sin": sin, "cos": cos}
    exec(compile(text, f"<{name}>", "exec"), space)
    plain: Function = space[name]
    return plain


def folder() -> Path:
    """Where machine code is kept; by ``XDG_CACHE_HOME`` if that is set."""
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "stepaside"


def _machine_code(name: str, text: str) -> Function | None:
    """Stored machine code of a text; compiled, if that is preferred."""
    content = f"from math import cos, sin\n\n\n{text}"
    digest = sha256(content.encode()).hexdigest()[:16]
    path = folder() / f"{name}_{digest}.py"
    stored = path.is_file() and path.read_text(encoding="utf-8") == content
    if not stored:
        if _used is not JitPreference.COMPILED:
            return None
        _write(path, content)
    import numba  # takes longer than all the rest

    spec = spec_from_file_location(path.stem, path)
    assert spec is not None and spec.loader is not None
    module = module_from_spec(spec)
    sys.modules[spec.name] = module  # where stored code looks for it
    spec.loader.exec_module(module)
    plain = getattr(module, name)
    floats = (numba.float64,) * plain.__code__.co_argcount
    made: Function = numba.njit([floats], cache=True)(plain)
    return made


def _write(path: Path, content: str) -> None:
    """Write a text whole, for one's own eyes."""
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    with NamedTemporaryFile(
        "w", dir=path.parent, delete=False, encoding="utf-8"
    ) as file:
        file.write(content)
    Path(file.name).replace(path)
