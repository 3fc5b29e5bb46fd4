"""Nested entries of configurations, as files have them."""

from dataclasses import is_dataclass
from typing import Any, get_origin, get_type_hints


def renamed(entries: dict[str, Any], old: str, new: str) -> dict[str, Any]:
    """Entries with an old name, if it is there, replaced by the new one.

    Raises:
        KeyError: If both are there.
    """
    section, deeper, old_rest = old.partition(".")
    new_rest = new.partition(".")[2]
    if deeper:
        inner = entries.get(section)
        if not isinstance(inner, dict):
            return entries
        return entries | {section: renamed(inner, old_rest, new_rest)}
    if old in entries and new in entries:
        raise KeyError(old)
    return {new if key == old else key: v for key, v in entries.items()}


def over(below: dict[str, Any], above: dict[str, Any]) -> dict[str, Any]:
    """Entries of both; those above win."""
    merged = below | above
    for key in below.keys() & above.keys():
        if isinstance(below[key], dict) and isinstance(above[key], dict):
            merged[key] = over(below[key], above[key])
    return merged


def without(entries: dict[str, Any], old: str) -> dict[str, Any]:
    """Entries without one."""
    section, deeper, rest = old.partition(".")
    inner = entries.get(section)
    if deeper and isinstance(inner, dict):
        return entries | {section: without(inner, rest)}
    return {key: v for key, v in entries.items() if key != old}


def with_tuples(kind: Any, entries: dict[str, Any]) -> dict[str, Any]:
    """Entries with tuples for the lists that settings keep as such."""
    changed = dict(entries)
    hints = get_type_hints(kind)
    for key in entries.keys() & hints.keys():
        value, hint = entries[key], hints[key]
        if isinstance(value, list) and get_origin(hint) is tuple:
            changed[key] = tuple(value)
        elif isinstance(value, dict) and is_dataclass(hint):
            changed[key] = with_tuples(hint, value)
    return changed
