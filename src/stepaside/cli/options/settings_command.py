"""Commands with settings from options, a configuration file, or both.

In order of increasing priority: defaults, the file of ``--config``, presets
such as ``--body``, single options.
"""

from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from functools import wraps
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import click

from ...arena import RoomRecipe
from ...core.setting import Setting
from ...games.configuration_file import load_entries, parse_settings
from ...games.robot_settings import (
    body_of_robot,
    with_legs,
    with_players,
    with_robot,
)
from ...planning import PRESETS
from ...strategies.registry import OF_EVASION
from ..terminal import write_result
from .print_config import commented
from .room_options import RECIPE, with_room, with_sensing
from .setting_options import (
    OWN,
    Decorator,
    Entry,
    GroupedOption,
    all_entries,
    entries_at,
    given_options,
)

S = TypeVar("S")
ROOM_SIZE = Entry(
    f"{RECIPE}.size",
    Setting(
        "Width and depth of the room [m]; open for a floor without walls",
        option="--room-size",
    ),
    None,
    tuple[float, float] | None,
)


CONTROL = ("control.method", "control.feedback")
IMPLY: Mapping[str, tuple[str, ...]] = {
    "body": CONTROL,
    "gait": (*CONTROL, "strategy.trigger"),
    "pursuer": ("strategy.trigger",),
}
"""Entries of a file that an option leaves open again, as it implies them."""


class OptionGroup(NamedTuple):
    """Section of options in the help.

    Attributes:
        title: Title of the section.
        paths: Entries of the settings, and sections, which stand for all
            their entries with options.
    """

    title: str
    paths: tuple[str, ...]


class SettingsCommand(click.Command):
    """Command whose help shows options in sections."""

    def format_options(
        self, ctx: click.Context, formatter: click.HelpFormatter
    ) -> None:
        """Write the command's own options first, then each group."""
        sections: dict[str, list[tuple[str, str]]] = {OWN: []}
        for param in self.get_params(ctx):
            record = param.get_help_record(ctx)
            if record is not None and isinstance(param, click.Option):
                title = getattr(param, "group", OWN)
                sections.setdefault(title, []).append(record)
        for title, records in sections.items():
            with formatter.section(title):
                formatter.write_dl(records)


def takes_settings(
    kind: type[Any],
    *groups: OptionGroup,
    without: Collection[str] = (),
    ignored: Collection[str] = (),
    meanings: Mapping[str, str] | None = None,
    robot_argument: str | None = None,
) -> Decorator:
    """Add options and ``--config`` to a command; pass it ``settings``.

    Args:
        kind: Class of the settings.
        groups: Options that set entries of the settings.
        without: Entries whose options the command does not have.
        ignored: Top-level entries of a file that belong to other commands.
        meanings: Meanings of options that differ in this command, by entry.
        robot_argument: Argument of the command that chooses the robot, if
            not an option of these settings.

    Returns:
        Decorator of a command with an argument ``settings``.
    """
    grouped = [
        (title, entry)
        for title, paths in groups
        for path in paths
        for entry in _entries(kind, path)
        if entry.setting.option and entry.path not in without
    ]
    entries = [entry for _, entry in grouped]

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(function)
        def command(**values: Any) -> Any:
            options = given_options(values, entries)
            file = values.pop("config")
            robot = None if robot_argument is None else values[robot_argument]
            settings = _settings(kind, options, file, ignored, robot)
            given = [entry for entry, _ in options]
            _refuse_unused(given, entries, settings)
            if values.pop("print_config"):
                write_result(commented(settings))
                return None
            return function(settings=settings, **values)

        wrapped: Callable[..., Any] = _CONFIG(_PRINT_CONFIG(command))
        for title, entry in reversed(grouped):
            meaning = (meanings or {}).get(entry.path, "")
            wrapped = entry.option(title, meaning)(wrapped)
        return wrapped

    return decorate


_CONFIG = click.option(
    "--config",
    cls=GroupedOption,
    group="Configuration",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Configuration file (TOML); options override it.",
)
_PRINT_CONFIG = click.option(
    "--print-config/--no-print-config",
    cls=GroupedOption,
    group="Configuration",
    help="Print the resulting configuration with comments, and exit.",
)


def _entries(kind: type[Any], path: str) -> list[Entry]:
    """Return the entries at a path; those of a random room are no settings."""
    if path != RECIPE:
        return list(entries_at(kind, path))
    recipe = [e._replace(default=None) for e in all_entries(RoomRecipe, path)]
    return [ROOM_SIZE, *recipe]


def _settings(
    kind: type[Any],
    options: list[tuple[Entry, Any]],
    config: Path | None,
    ignored: Collection[str],
    robot: str | None,
) -> Any:
    """Return the settings of a command from options and file."""
    named = {entry.path: value for entry, value in options}
    given = dict(named)
    if robot is not None:
        given["robot"] = robot
    file = {} if config is None else load_entries(config)
    own = _without(file, {e for path in given for e in IMPLY.get(path, ())})
    settings = _base_settings(kind, given, own, str(config), ignored)
    if given.get("control.feedback") is False:  # only one method needs none
        given.setdefault("control.method", None)
    if hasattr(settings, "sensing"):
        given = with_sensing(
            given,
            room_in_file=settings.room.plan is not None,
            sensing_in_file="sensing" in file,
        )
    for entry, _ in options:
        if entry.path in given:
            given[entry.path] = entry.value_of(given[entry.path])
    if "body" in named and hasattr(settings, "robot"):
        given["body"] = body_of_robot(settings.robot, named["body"])
    settings = changed(settings, with_room(given))
    return settings.resolved() if hasattr(settings, "resolved") else settings


def _without(
    entries: Mapping[str, Any], paths: Collection[str], section: str = ""
) -> dict[str, Any]:
    """Return the nested entries of a file without those at some paths."""
    return {
        name: _without(value, paths, f"{section}{name}.")
        if isinstance(value, dict)
        else value
        for name, value in entries.items()
        if f"{section}{name}" not in paths
    }


def _base_settings(
    kind: type[Any],
    given: dict[str, Any],
    file: dict[str, Any],
    source: str,
    ignored: Collection[str],
) -> Any:
    """Return the settings of the chosen robots, changed by the file.

    Args:
        kind: Class of the settings.
        given: Options by path; those that choose a player's robot are
            removed.
        file: Entries of the configuration file; those that choose a robot
            are removed.
        source: Name of the file.
        ignored: Entries of the file that belong to other commands.
    """
    base = kind()
    if hasattr(base, "robot"):
        robot = given.get("robot", file.pop("robot", base.robot))
        base = with_robot(base, str(robot))
        if "gait" in given and base.gait != PRESETS["nao"]:
            raise click.UsageError(
                f"--gait {given['gait']} requires a robot with NAO's gait, "
                f"got --robot {robot}, which has its own: its lengths and "
                "times are NAO's"
            )
        players = {}
        for player in ("pursuer", "evader"):
            path = f"{player}_robot"
            if path in given:
                file.pop(path, None)
                players[player] = given.pop(path)
            elif isinstance(file.get(path), dict):
                players[player] = str(file[path].get("robot", robot))
        base = with_players(base, players) if players else base
        in_file = file.get("legs", {}).get("network", "")
        network = given.get("legs.network", in_file)
        if network and hasattr(base, "legs"):
            base = with_legs(base, network)
    return parse_settings(kind, file, source, aside=ignored, base=base)


def changed(settings: S, values: Mapping[str, Any]) -> S:
    """Return settings with new values at some paths.

    Outer sections are replaced before inner ones, and all values of one
    section at once, because their validity may depend on each other.

    Args:
        settings: Settings to start from.
        values: New values by path, like ``physics.friction``.

    Raises:
        StepAsideError: If a value is invalid.
    """
    sections: dict[tuple[str, ...], dict[str, Any]] = {}
    for path, value in values.items():
        *section, name = path.split(".")
        sections.setdefault(tuple(section), {})[name] = value
    for section_path in sorted(sections, key=len):
        settings = _put(settings, section_path, sections[section_path])
    return settings


def _put(settings: Any, section: tuple[str, ...], values: Any) -> Any:
    if not section:
        return replace(settings, **values)
    name, *deeper = section
    inner = _put(getattr(settings, name), tuple(deeper), values)
    return replace(settings, **{name: inner})


def _refuse_unused(
    given: Collection[Entry], options: Collection[Entry], settings: Any
) -> None:
    """Refuse options that have no effect with the other settings.

    Args:
        given: Entries of the options that are given.
        options: Entries of all options of the command.
        settings: Resulting settings.
    """
    unused = [e.flag for e in given if e.path.startswith("strategy.")]
    if unused and not settings.uses_evasion:
        raise click.UsageError(
            f"{', '.join(unused)} requires the strategy "
            f"{' or '.join(OF_EVASION)}, got --strategy "
            f"{settings.named().evader_strategy}"
        )
    names = {entry.path: entry.flag for entry in options}
    for entry in given:
        for path, needed in entry.needs:
            value = _value_at(settings, path)
            if path in names and (
                value is None if needed == "" else value != needed
            ):
                raise click.UsageError(
                    f"{entry.flag} requires {names[path]} {needed}".rstrip()
                    + (f", got {value}" if needed else "")
                )


def _value_at(settings: Any, path: str) -> Any:
    for name in path.split("."):
        settings = getattr(settings, name)
    return settings
