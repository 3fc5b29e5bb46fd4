"""Doors of rooms: names at the front whose modules load when used.

This is the first that loads, and nothing may take time before it is known
what a Ctrl-C does: so ``typing`` is for those who check types alone.
"""

from __future__ import annotations

from importlib import import_module

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from typing import Any


def door(room: str, names: Mapping[str, str]) -> Callable[[str], Any]:
    """Function for a package's ``__getattr__``.

    Whoever needs the settings of a room alone does not wait for the rest of
    it, which may take MuJoCo with it.

    Args:
        room: Name of the package.
        names: Module in the package that each name lies in.
    """

    def find(name: str) -> Any:
        if name not in names:
            raise AttributeError(f"module {room!r} has no attribute {name!r}")
        return getattr(import_module(f"{room}.{names[name]}"), name)

    return find
