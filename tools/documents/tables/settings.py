"""All settings with their ranges, from the checks themselves."""

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from math import isfinite
from typing import Any, NamedTuple

import click

from stepaside.cli.main import all_commands
from stepaside.cli.options.parameter_types import NumberType
from stepaside.cli.options.settings_options import DUEL, WALK, SettingOption
from stepaside.cli.plan import PlanSettings
from stepaside.core.ranges import Range
from stepaside.core.setting import Setting as Description
from stepaside.core.setting import settings_of
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.game_settings import GameSettings, PlayerSettings
from stepaside.games.walk_settings import WalkSettings
from stepaside.sim.camera_settings import RoomObject
from stepaside.sim.push import Push

from .markdown import table

CONFIGURATIONS = (
    DuelSettings(),
    WalkSettings(),
    PlanSettings(),
    GameSettings(players=(PlayerSettings("one"),)),
)
OPTIONS = {path: option for option, path in (WALK | DUEL).items()}
LISTS: Mapping[str, type[Any]] = {
    "players": PlayerSettings,
    "room.things": RoomObject,
    "pushes": Push,
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
    for configuration in CONFIGURATIONS:
        for setting in _in(configuration, ""):
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
    """List all settings with option, meaning, range and default."""
    rows = []
    for path, setting in all_settings().items():
        known = settings_of(setting.kind)[setting.name]
        option = OPTIONS.get(path, "")
        if known.range is not None:
            values, why = known.range.words, known.range.why
        else:
            values, why = ", ".join(known.names) or _type(setting), ""
        rows.append(
            (
                f"`{path}`",
                f"`{option}`" if option else "",
                known.text.removesuffix("."),
                values,
                "" if path in LISTS else _default(setting.default, known),
                why,
            )
        )
    head = ("setting", "option", "meaning", "values", "default", "reason")
    return table(head, rows)


def _type(setting: Setting) -> str:
    kinds = {field.name: field.type for field in fields(setting.kind)}
    if kinds[setting.name] in (bool, bool | None):
        return "true, false"
    return "a list" if setting.path in LISTS else "text"


def _default(value: Any, known: Description) -> str:
    if value in (None, ""):  # open, or none
        return known.default_text
    if value == () or value == []:
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
            kind: Any = option.type
            if isinstance(option, SettingOption):
                known = option.entry.setting.range
            elif isinstance(kind, NumberType):
                known = kind.range
            elif isinstance(kind, click.IntRange):
                known = Range(
                    kind.min or 0, kind.max or 0, "1", "", whole=True
                )
            else:
                known = None
            if known is None:
                continue
            entry = known.words, known.unit
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
        and not (
            isinstance(param, SettingOption) and param.entry.path in OPTIONS
        )
    ]
