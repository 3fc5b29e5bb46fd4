"""All settings with their ranges, from the checks themselves."""

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from math import isfinite
from typing import Any, NamedTuple

import click

from stepaside.cli.main import all_commands
from stepaside.cli.options.declaration import DeclaredOption
from stepaside.cli.plan_settings import PlanSettings
from stepaside.cli.value_types import NumberType
from stepaside.core.ranges import ranges_of
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.walk_settings import WalkSettings
from stepaside.sim.camera_settings import RoomObject
from stepaside.sim.passerby_settings import Passer
from stepaside.sim.push import Push

from .markdown import table

KINDS = (DuelSettings, WalkSettings, PlanSettings)
LISTS: Mapping[str, type[Any]] = {
    "room.things": RoomObject,
    "pushes": Push,
    "passers": Passer,
}


class Setting(NamedTuple):
    """Entry of a configuration.

    Attributes:
        path: Path like ``gait.speed``.
        kind: Class of its section.
        name: Name of the attribute.
        default: Default value; None if there is none.
    """

    path: str
    kind: type[Any]
    name: str
    default: Any


def all_settings() -> dict[str, Setting]:
    """Return every entry of every configuration, by its path."""
    found: dict[str, Setting] = {}
    for kind in KINDS:
        for setting in _in(kind(), ""):
            found.setdefault(setting.path, setting)
    for path, kind in LISTS.items():
        for field in fields(kind):
            name = f"{path}[].{field.name}"
            found[name] = Setting(name, kind, field.name, None)
    return found


def _in(settings: Any, before: str) -> Iterator[Setting]:
    for field in fields(settings):
        value = getattr(settings, field.name)
        path = f"{before}{field.name}"
        if is_dataclass(value):
            yield from _in(value, f"{path}.")
        else:
            yield Setting(path, type(settings), field.name, value)


def settings(_: Any) -> str:
    """List all settings: range, unit, default and reason for the bounds."""
    names = _names()
    rows = []
    for path, setting in all_settings().items():
        known = ranges_of(setting.kind).get(setting.name)
        if known is not None:
            may_be, unit, why = known.words, known.unit, known.why
        elif path in names:
            may_be, unit, why = ", ".join(names[path]), "", ""
        elif path in LISTS:
            may_be, unit, why = "a list", "", ""
        else:
            truth = isinstance(setting.default, bool)
            may_be, unit, why = "true, false" if truth else "text", "", ""
        rows.append(
            (f"`{path}`", may_be, unit, _default(setting.default), why)
        )
    return table(
        ("setting", "range", "unit", "default", "reason for the range"), rows
    )


def _default(value: Any) -> str:
    if value is None or value == () or value == []:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float) and isfinite(value):
        return f"{value:.6g}"
    return str(value)


def options(_: Any) -> str:
    """List numeric options that are not part of a configuration."""
    found: dict[tuple[str, str, str], list[str]] = {}
    for command, made in all_commands().items():
        for option in _options(made):
            kind = option.type
            if isinstance(kind, NumberType):
                entry = kind.range.words, kind.unit
            elif isinstance(kind, click.IntRange):
                entry = f"{kind.min:g} to {kind.max:g}", "1"
            else:
                continue
            found.setdefault((option.opts[0], *entry), []).append(command)
    rows = [
        (f"`{name}`", words, unit, ", ".join(commands))
        for (name, words, unit), commands in sorted(found.items())
    ]
    return table(("option", "range", "unit", "commands"), rows)


def _options(command: click.Command) -> list[click.Option]:
    """Return the options of a command that are not part of a configuration."""
    return [
        param
        for param in command.params
        if isinstance(param, click.Option)
        and not (isinstance(param, DeclaredOption) and param.sets_settings)
    ]


def _names() -> dict[str, tuple[str, ...]]:
    """Return the allowed names, by the path of the setting."""
    found = {}
    for made in all_commands().values():
        for param in made.params:
            if isinstance(param, DeclaredOption):
                declared = param.declaration
                if declared.registry is not None and declared.path:
                    found[declared.path] = tuple(map(str, declared.registry()))
    return found
