"""Number of values that an object keeps alive."""

from collections import deque
from collections.abc import Mapping
from enum import Enum
from types import FunctionType, MethodType, ModuleType
from typing import Any

import numpy as np

ATOMS = (type(None), bool, int, float, str, bytes, Enum, type, ModuleType)


def reachable_values(thing: Any, seen: set[int] | None = None) -> int:
    """Return the number of values reachable from an object, each once.

    Attributes, slots, items, elements of arrays and what functions and
    methods hold are followed.
    """
    seen = set() if seen is None else seen
    if isinstance(thing, ATOMS):
        return 1
    if id(thing) in seen:
        return 0
    seen.add(id(thing))
    if isinstance(thing, np.ndarray):
        return int(thing.size)
    return 1 + sum(reachable_values(part, seen) for part in parts(thing))


def parts(thing: Any) -> list[Any]:
    """Return what an object refers to directly."""
    if isinstance(thing, Mapping):
        return [*thing.keys(), *thing.values()]
    if isinstance(thing, list | tuple | set | frozenset | deque):
        return list(thing)
    if isinstance(thing, MethodType):
        return [thing.__self__]
    if isinstance(thing, FunctionType):
        return [cell.cell_contents for cell in thing.__closure__ or ()]
    slots = [
        getattr(thing, name)
        for kind in type(thing).__mro__
        for name in getattr(kind, "__slots__", ())
        if hasattr(thing, name)
    ]
    return [*getattr(thing, "__dict__", {}).values(), *slots]
