"""Settings with one field changed, for laws that hold for every field."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from math import isfinite
from typing import Any, Literal, get_args, get_origin, get_type_hints

from stepaside.core.errors import StepAsideError

Others = Mapping[str, Sequence[Any]]


def changed(
    settings: Any, others: Others | None = None, path: str = ""
) -> Iterator[tuple[str, Any]]:
    """Yield a copy of settings for each leaf, with that leaf changed.

    Args:
        settings: A frozen dataclass; sections in it are gone through, too.
        others: Values to try for a field, by its path; what a type says
            nothing of (names, plans) needs an entry, and an empty one
            leaves a field out.
        path: Before the names of its fields.

    Raises:
        AssertionError: If a field accepts none of the values tried.
    """
    known = others or {}
    hints = get_type_hints(type(settings))
    for field in fields(settings):
        name = f"{path}{field.name}"
        value = getattr(settings, field.name)
        if is_dataclass(value) and name not in known:
            for deeper, other in changed(value, known, f"{name}."):
                yield deeper, replace(settings, **{field.name: other})
            continue
        tried = known.get(name, _others(value, hints[field.name]))
        if not tried:
            continue
        for other in tried:
            try:
                made = replace(settings, **{field.name: other})
            except StepAsideError:
                continue
            if made != settings:
                yield name, made
                break
        else:
            raise AssertionError(f"no other value for {name}: {tried!r}")


def _others(value: Any, hint: Any) -> list[Any]:
    """Values that a field may have instead, the nearest first."""
    if get_origin(hint) is Literal:
        return [other for other in get_args(hint) if other != value]
    if isinstance(value, bool):
        return [not value]
    if isinstance(value, int):
        return [value + 1, value - 1, value + 2]
    if isinstance(value, float) and isfinite(value):
        step = max(1e-3 * abs(value), 1e-6)
        more = [0.5 * value, 2.0 * value, value + 1.0]
        return [value + step, value - step, *more]
    if isinstance(value, float):
        return [1.0, 5.0, 50.0]
    if isinstance(value, tuple) and value:
        return [
            (*value[:i], other, *value[i + 1 :])
            for i, each in enumerate(value)
            for other in _others(each, type(each))
        ]
    return [1.0, 0.1, 1, "other"]
