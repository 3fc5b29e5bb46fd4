"""All settings with their ranges, from the checks themselves."""

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from math import isfinite
from typing import Any, NamedTuple

from stepaside.cli import duel, run
from stepaside.cli.bound import BoundSettings
from stepaside.cli.settings import flag_of
from stepaside.cli.theory import (
    CircleSettings,
    PlanSettings,
    StartMapSettings,
)
from stepaside.core.setting import Setting as Description
from stepaside.core.setting import descriptions_of
from stepaside.games.game_settings import duel as make_duel
from stepaside.games.play_settings import PlaySettings
from stepaside.games.player_settings import PlayerSettings
from stepaside.report.film_settings import FilmSettings
from stepaside.sim.camera_settings import RoomObject
from stepaside.sim.push import Push
from stepaside.theory.unicycle.unicycle_settings import UnicycleSettings

from .markdown import table

CONFIGURATIONS = (
    make_duel(),
    PlayerSettings("one"),
    PlanSettings(),
)
COMMANDS = {
    "play": PlaySettings(),
    "run unicycles": UnicycleSettings(),
    "theory circle": CircleSettings(),
    "theory map": StartMapSettings(),
    "theory bound": BoundSettings(),
    "show": FilmSettings(),
}
OPTIONS = {path: flag_of(path) for path in (*run.NAMED_OF_WALK, *duel.NAMED)}
LISTS: Mapping[str, type[Any]] = {
    "players": PlayerSettings,
    "scene.things": RoomObject,
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
    return _table(all_settings())


def settings_of_commands(_: Any) -> str:
    """List the settings of commands that are no part of a configuration."""
    found = {
        f"{command}: {setting.path}": setting
        for command, values in COMMANDS.items()
        for setting in _in(values, "")
        if "." not in setting.path  # sections are those of configurations
    }
    return _table(found)


def _table(found: Mapping[str, Setting]) -> str:
    rows = []
    for path, setting in found.items():
        known = descriptions_of(setting.kind)[setting.name]
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
