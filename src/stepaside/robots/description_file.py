"""Reader of ``robot.toml``: entries, their types and their checks."""

import tomllib
from collections.abc import Callable, Mapping
from math import isfinite
from pathlib import Path
from typing import Any

from ..core.errors import ModelError
from .description_types import (
    Overlay,
    ReferencePoint,
    SensorNames,
    ServoGains,
    SoleFrame,
)

Entries = dict[str, Any]
LEAN_LIMIT = 0.3  # greatest lean of a torso, in [rad]


def read_entries(path: Path) -> Entries:
    """Read and check the entries of a robot description.

    Returns:
        Values by field of :class:`~.description.RobotDescription`.

    Raises:
        ModelError: If the file is not TOML, or has unknown, missing or
            ill-typed entries; names the first.
    """
    try:
        entries = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ModelError(f"{path}: {error}") from error
    names = ", ".join((*REQUIRED, *OPTIONAL))
    for key in entries:
        if key not in REQUIRED and key not in OPTIONAL:
            raise ModelError(
                f"{path}: unknown entry {key!r}; there are {names}"
            )
    for key in REQUIRED:
        if key not in entries:
            raise ModelError(f"{path}: entry {key!r} is missing")
    readers = REQUIRED | OPTIONAL
    try:
        return {key: readers[key](key, entries[key]) for key in entries}
    except ModelError as error:
        raise ModelError(f"{path}: {error}") from None


def _type_error(name: str, expected: str, got: object) -> ModelError:
    return ModelError(f"{name} must be {expected}, got {got!r}")


def _text(name: str, value: object) -> str:
    if not isinstance(value, str):
        raise _type_error(name, "a name", value)
    return value


def _number(name: str, value: object) -> float:
    fits = isinstance(value, int | float) and not isinstance(value, bool)
    if not fits or not isfinite(value):  # type: ignore[arg-type]
        raise _type_error(name, "a finite number", value)
    return float(value)  # type: ignore[arg-type]


def _positive(name: str, value: object) -> float:
    number = _number(name, value)
    if number <= 0.0:
        raise _type_error(name, "a number > 0", value)
    return number


def _not_negative(name: str, value: object) -> float:
    number = _number(name, value)
    if number < 0.0:
        raise _type_error(name, "a number >= 0", value)
    return number


def _lean(name: str, value: object) -> float:
    number = _number(name, value)
    if not 0.0 <= number <= LEAN_LIMIT:
        raise _type_error(name, f"0 to {LEAN_LIMIT} rad", value)
    return number


def _table(name: str, value: object) -> Entries:
    if not isinstance(value, dict):
        raise _type_error(name, "a table", value)
    return value


def _row(
    reader: Callable[[str, object], Any], count: int | None = None
) -> Callable[[str, object], tuple[Any, ...]]:
    def read(name: str, value: object) -> tuple[Any, ...]:
        if not isinstance(value, list) or count not in (None, len(value)):
            number = "" if count is None else f"{count} "
            raise _type_error(name, f"an array of {number}values", value)
        return tuple(reader(name, entry) for entry in value)

    return read


def _range(name: str, value: object) -> tuple[float, float]:
    low, high = _row(_number, 2)(name, value)
    if not low < high:
        raise _type_error(name, "a range [low, high] with low < high", value)
    return low, high


def _by_name(reader: Callable[[str, object], Any]) -> Callable[..., Entries]:
    def read(name: str, value: object) -> Entries:
        table = _table(name, value)
        return {k: reader(f"{name}.{k}", v) for k, v in table.items()}

    return read


def _fields(
    kind: Callable[..., Any],
    required: Mapping[str, Callable[[str, object], Any]],
    optional: Mapping[str, Callable[[str, object], Any]],
) -> Callable[[str, object], Any]:
    """Return a reader of a table whose entries are the fields of a type."""
    readers = {**required, **optional}

    def read(name: str, value: object) -> Any:
        table = _table(name, value)
        for key in table:
            if key not in readers:
                raise ModelError(
                    f"unknown entry {name}.{key}; there are "
                    f"{', '.join(readers)}"
                )
        for key in required:
            if key not in table:
                raise ModelError(f"entry {name}.{key} is missing")
        return kind(
            **{k: readers[k](f"{name}.{k}", v) for k, v in table.items()}
        )

    return read


_SERVO = _fields(
    ServoGains,
    {
        "stiffness": _positive,
        "damping": _not_negative,
        "torque": _positive,
    },
    {"armature": _not_negative},
)
_SOLE = _fields(
    SoleFrame,
    {
        "body": _text,
        "place": _row(_number, 3),
        "turn": _row(_number, 4),
    },
    {},
)
REQUIRED: dict[str, Callable[[str, object], Any]] = {
    "name": _text,
    "model": _text,
    "torso": _text,
    "left_foot": _text,
    "right_foot": _text,
    "legs": _row(_text),
    "standing": _by_name(_number),
    "speed_limits": _by_name(_positive),
    "accent": _text,
}
OPTIONAL: dict[str, Callable[[str, object], Any]] = {
    "working_limits": _by_name(_range),
    "gait": _table,
    "sole": _by_name(_number),
    "control": _table,
    "locomotion": _table,
    "body": _table,
    "published": _fields(
        dict,
        {},
        {
            "stiffness": _by_name(_not_negative),
            "damping": _by_name(_not_negative),
            "default_posture": _by_name(_number),
        },
    ),
    "game": _by_name(_number),
    "sensors": _fields(
        SensorNames,
        {},
        {"gyro": _text, "accelerometer": _text, "feet": _row(_text, 8)},
    ),
    "lean": _lean,
    "place": _fields(
        ReferencePoint, {}, {"forward": _number, "reach": _positive}
    ),
    "overlay": _fields(
        Overlay,
        {"soles": _row(_SOLE, 2), "servos": _by_name(_SERVO)},
        {"meshes": _row(_text), "turn": _row(_number, 4)},
    ),
}
