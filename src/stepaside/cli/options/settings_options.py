"""Settings as options: a few by name, all by ``--set PATH=VALUE``.

In order of increasing priority: defaults, the file of ``--config``, presets
such as ``--body``, single settings.
"""

from collections.abc import Callable, Collection, Mapping
from dataclasses import MISSING, fields, is_dataclass, replace
from difflib import get_close_matches
from functools import cache, wraps
from math import degrees
from pathlib import Path
from typing import Any, NamedTuple, TypeVar, cast

import click
from click.core import ParameterSource

from ...arena import Room, RoomRecipe
from ...core.entries import load_entries
from ...core.setting import REQUIRED, Setting, settings_of
from ...games.configuration_file import parse_settings
from ...games.robot_settings import (
    body_of_robot,
    with_legs,
    with_players,
    with_robot,
)
from ...planning import PRESETS
from ...sim.push import Push
from ...strategies import Strategy
from ...strategies.registry import OF_EVASION
from ..terminal import write_result
from .parameter_types import (
    ANGLE,
    NameType,
    NumberType,
    PushType,
    RoomType,
    SizeType,
    StrategyType,
    WordOrValueType,
)
from .print_config import commented
from .room_options import RECIPE, with_room, with_sensing

S = TypeVar("S")
Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]
DUEL = {
    "--seed": "seed",
    "--duration": "duration",
    "--robot": "robot",
    "--legs": "legs.network",
    "--gait": "gait",
    "--body": "body",
    "--method": "control.method",
    "--sensing": "sensing",
    "--room": "room.plan",
    "--distance": "start.distance",
    "--strategy": "evader_strategy",
    "--pursuer-strategy": "pursuer_strategy",
    "--pursuer": "pursuer",
    "--push": "pushes",
}
"""Settings of a duel with an option of their own."""
WALK = {
    "--seed": "seed",
    "--duration": "duration",
    "--robot": "robot",
    "--gait": "gait",
    "--body": "body",
    "--method": "control.method",
    "--bearing": "bearing",
    "--push": "pushes",
}
"""Settings of a walk with an option of their own."""
MEANINGS = {
    "robot": "Robot, or folder of its description",
    "gait": "Preset of the gait",
    "body": "Imperfections of the body",
    "control.method": "Start of each maneuver: state as planned, measured, or "
    "measured with MPC",
    "legs.network": "ONNX file of a walking policy",
    "sensing": "Sensing of opponents",
    "room.plan": "Room: seed of a random one, or file",
    "evader_strategy": "Strategy of the evader (docs/strategies.md)",
    "pursuer_strategy": "Strategy of a robot that pursues",
    "start.distance": "Initial distance [m]; drawn by default",
    "pushes": "Push the torso: 1.2@5:90deg is 1.2 N s at 5 s to the left, "
    "pursuer=1.2@5:90deg of the pursuer; repeatable",
}
"""Short meanings of options, by path; --print-config has the long ones."""
CONTROL = ("control.method", "control.feedback")
IMPLY: Mapping[str, tuple[str, ...]] = {
    "body": CONTROL,
    "gait": (*CONTROL, "strategy.trigger"),
    "pursuer": ("strategy.trigger",),
}
"""Entries of a file that an option leaves open again, as it implies them."""
NONE = "none"  # text of a setting that has no value
BOOLEANS = {"true": True, "false": False}
GIVEN = "stepaside.given"  # of a context: paths of the given settings
# Types of values, by type of the field.
TYPES: dict[Any, click.ParamType[Any]] = {
    tuple[Push, ...]: PushType(),
    Room | None: RoomType(),
    str | Strategy: StrategyType(),
    tuple[float, float] | None: SizeType(),
    Path | None: click.Path(file_okay=False, path_type=Path),
}


class Entry(NamedTuple):
    """One setting within settings.

    Attributes:
        path: Path, like ``physics.friction``.
        setting: Description.
        default: Default value.
        hint: Type of the field.
        needs: Conditions of the setting and of its sections.
    """

    path: str
    setting: Setting
    default: Any
    hint: Any
    needs: tuple[tuple[str, str], ...] = ()

    @property
    def is_flag(self) -> bool:
        """Whether the value is true or false."""
        return isinstance(self.default, bool) or self.hint == bool | None

    @property
    def type(self) -> click.ParamType[Any] | None:
        """Click type; None for a flag or for text."""
        setting, kind = self.setting, TYPES.get(self.hint)
        if setting.presets is not None or setting.names:
            kind = NameType(lambda: setting.presets or setting.names)
        elif setting.range is not None and setting.range.unit == "rad":
            kind = ANGLE
        elif setting.range is not None and setting.range.whole:
            kind = click.INT
        elif setting.range is not None:
            kind = NumberType(setting.range.unit, bounded=False)
        if setting.words and kind is not None:
            return WordOrValueType(kind, setting.words)
        return kind

    @property
    def default_text(self) -> str:
        """Default as the user would write it; empty for None."""
        setting, value = self.setting, self.default
        for word, meant in (setting.words or {}).items():
            if value == meant:
                return word
        if setting.presets is not None:
            names = [name for name, v in setting.presets.items() if v == value]
            value = names[0] if names else None
        if value in (None, (), REQUIRED):
            return ""
        if setting.range is not None and setting.range.unit == "rad":
            return f"{degrees(value):g}deg"
        return f"{value:g}" if isinstance(value, float) else str(value)

    def parse(self, text: str) -> Any:
        """Return the value that a text of ``--set`` means."""
        if text == NONE and self.default is None:
            return None
        if self.is_flag:
            if text not in BOOLEANS:
                raise click.BadParameter(f"must be true or false, got {text}")
            return BOOLEANS[text]
        kind = self.type
        return text if kind is None else kind.convert(text, None, None)

    def value_of(self, given: Any) -> Any:
        """Convert an argument to the value of the setting."""
        if isinstance(self.default, tuple):  # the word "none" is None
            return tuple(one for one in given if one is not None)
        presets = self.setting.presets
        return given if presets is None or given is None else presets[given]


class SettingOption(click.Option):
    """Option that sets one setting.

    Attributes:
        entry: Description and place of the setting.
    """

    def __init__(self, flag: str, entry: Entry, meaning: str = "") -> None:
        """Describe the option by its setting.

        Args:
            flag: Name, like ``--seed``.
            entry: The setting.
            meaning: Meaning, if it differs in this command.
        """
        self.entry = entry
        name = flag if not entry.is_flag else f"{flag}/--no-{flag[2:]}"
        text = (meaning or entry.setting.text).rstrip(".") + "."
        default = entry.default_text
        if not meaning:
            default = entry.setting.default_text or default
        if default and not (entry.is_flag and entry.default is False):
            text += f"  [default: {default}]"
        super().__init__(
            [name, argument_of(entry.path)],
            type=entry.type,
            help=text,
            multiple=isinstance(entry.default, tuple),
            required=entry.default is REQUIRED,
        )


def argument_of(path: str) -> str:
    """Return the argument of a command for the setting at a path."""
    return path.replace(".", "__")


@cache
def entries_of(
    kind: Any, section: str = "", needs: tuple[tuple[str, str], ...] = ()
) -> dict[str, Entry]:
    """Return every entry of settings, by its path.

    Args:
        kind: Class of the settings.
        section: Path of the section that they are.
        needs: Conditions of this section.
    """
    described, found = settings_of(kind), dict[str, Entry]()
    for field in fields(kind):
        default = field.default
        if field.default_factory is not MISSING:
            default = field.default_factory()
        path = f"{section}.{field.name}".lstrip(".")
        setting = described[field.name]
        all_needs = (*needs, setting.needs) if setting.needs else needs
        found[path] = Entry(path, setting, default, field.type, all_needs)
        if is_dataclass(default):
            found |= entries_of(cast(Any, type(default)), path, all_needs)
    return found


@cache
def _entries(kind: Any, sections: tuple[str, ...]) -> dict[str, Entry]:
    """Return the entries that ``--set`` takes, those of a room included."""
    found = dict(entries_of(kind))
    if "room.plan" in found:
        size = Setting("Width and depth of a random room [m], or open")
        recipe = entries_of(RoomRecipe, RECIPE)
        found |= {k: e._replace(default=None) for k, e in recipe.items()}
        kind_of_size = tuple[float, float] | None
        path = f"{RECIPE}.size"
        found[path] = Entry(path, size, None, kind_of_size)
    return {
        path: entry
        for path, entry in found.items()
        if not sections or path.startswith(sections)
    }


def entry_at(entries: Mapping[str, Entry], path: str) -> Entry:
    """Return the setting at a path.

    Raises:
        UsageError: If there is none; the message names similar ones.
    """
    if path in entries:
        return entries[path]
    name = path.rpartition(".")[2]
    near = [p for p in entries if p.rpartition(".")[2] == name]
    near = near or get_close_matches(path, entries, 3)
    raise click.UsageError(
        f"--set: unknown setting {path}"
        + (f"; did you mean {' or '.join(near[:3])}?" if near else "")
        + "; --print-config lists all"
    )


def takes_settings(
    kind: type[Any],
    named: Mapping[str, str],
    *,
    without: Collection[str] = (),
    sections: tuple[str, ...] = (),
    ignored: Collection[str] = (),
    meanings: Mapping[str, str] | None = None,
    robot_argument: str | None = None,
) -> Decorator:
    """Add options, ``--set`` and ``--config``; pass ``settings``.

    Args:
        kind: Class of the settings.
        named: Paths of the settings with an option of their own, by option.
        without: Paths that the command does not set.
        sections: Beginnings of the paths that it sets; all if empty.
        ignored: Top-level entries of a file that belong to other commands.
        meanings: Meanings that differ in this command, by path.
        robot_argument: Argument of the command that chooses the robot, if
            not an option of these settings.

    Returns:
        Decorator of a command with an argument ``settings``.
    """
    entries = {
        path: entry
        for path, entry in _entries(cast(Any, kind), sections).items()
        if path not in without
    }
    flags = {flag: p for flag, p in named.items() if p in entries}

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(function)
        def command(**values: Any) -> Any:
            context = click.get_current_context()
            given = _named_values(context, values, entries, flags)
            for path, value in _set_values(values.pop("sets"), entries):
                if isinstance(entries[path].default, tuple):
                    value = (*given.get(path, ()), value)
                given[path] = value
            context.meta[GIVEN] = frozenset(given)
            file = values.pop("config")
            robot = None if robot_argument is None else values[robot_argument]
            settings = _settings(kind, entries, given, file, ignored, robot)
            _refuse_unused(given, entries, flags, settings)
            if values.pop("print_config"):
                write_result(commented(settings))
                return None
            return function(settings=settings, **values)

        for option in _FILE_OPTIONS:
            option(command)
        wrapped: Callable[..., Any] = command
        for flag, path in reversed(list(flags.items())):
            meaning = {**MEANINGS, **(meanings or {})}.get(path, "")
            _add(wrapped, SettingOption(flag, entries[path], meaning))
        return wrapped

    return decorate


def _add(function: Callable[..., Any], option: click.Option) -> None:
    """Add an option to a command that is not made yet, as click does."""
    vars(function).setdefault("__click_params__", []).append(option)


_FILE_OPTIONS: tuple[Callable[..., Any], ...] = (
    click.option(
        "--print-config/--no-print-config",
        help="Print all settings with meaning, unit and range.",
    ),
    click.option(
        "--config",
        type=click.Path(exists=True, dir_okay=False, path_type=Path),
        help="Configuration file (TOML); options override it.",
    ),
    click.option(
        "--set",
        "sets",
        multiple=True,
        metavar="PATH=VALUE",
        help="Any setting, as --print-config lists them: gait.stride=0.03; "
        "repeatable.",
    ),
)


def _named_values(
    context: click.Context,
    values: dict[str, Any],
    entries: Mapping[str, Entry],
    flags: Mapping[str, str],
) -> dict[str, Any]:
    """Remove the values of named options; return those that are given."""
    given = {}
    for path in flags.values():
        value = values.pop(argument_of(path))
        source = context.get_parameter_source(argument_of(path))
        if source is not ParameterSource.DEFAULT:
            given[path] = value
    return given


def _set_values(
    sets: Collection[str], entries: Mapping[str, Entry]
) -> list[tuple[str, Any]]:
    """Return path and value of every ``--set``."""
    found = []
    for text in sets:
        path, equals, value = text.partition("=")
        if not equals:
            raise click.UsageError(
                f"--set must be PATH=VALUE like gait.stride=0.03, got {text}"
            )
        entry = entry_at(entries, path)
        try:
            found.append((path, entry.parse(value)))
        except click.BadParameter as error:
            raise click.UsageError(f"--set {path} {error.message}") from error
    return found


def _settings(
    kind: type[Any],
    entries: Mapping[str, Entry],
    named: Mapping[str, Any],
    config: Path | None,
    ignored: Collection[str],
    robot: str | None,
) -> Any:
    """Return the settings of a command from options and file."""
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
    for path in named.keys() & given.keys():
        given[path] = entries[path].value_of(given[path])
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
    given: Collection[str],
    entries: Mapping[str, Entry],
    flags: Mapping[str, str],
    settings: Any,
) -> None:
    """Refuse settings that have no effect with the others.

    Args:
        given: Paths of the settings that are given.
        entries: All settings of the command.
        flags: Paths of those with an option, by option.
        settings: Resulting settings.
    """
    names = {path: flag for flag, path in flags.items()}
    unused = [path for path in given if path.startswith("strategy.")]
    if unused and not settings.uses_evasion:
        raise click.UsageError(
            f"{', '.join(unused)} requires the strategy "
            f"{' or '.join(OF_EVASION)}, got --strategy "
            f"{settings.named().evader_strategy}"
        )
    for own in given:
        for path, needed in entries[own].needs:
            value = _value_at(settings, path)
            if path in entries and (
                value is None if needed == "" else value != needed
            ):
                raise click.UsageError(
                    f"{names.get(own, own)} requires "
                    f"{names.get(path, path)} {needed}".rstrip()
                    + (f", got {value}" if needed else "")
                )


def _value_at(settings: Any, path: str) -> Any:
    for name in path.split("."):
        settings = getattr(settings, name)
    return settings


def refuse_settings(beginnings: tuple[str, ...], requirement: str) -> None:
    """Refuse settings that have no effect in this call.

    Args:
        beginnings: Beginnings of their paths.
        requirement: What they require, for the message.

    Raises:
        UsageError: If one of them is given.
    """
    given = click.get_current_context().meta[GIVEN]
    for path in sorted(given):
        if path.startswith(beginnings):
            raise click.UsageError(f"{path} requires {requirement}")


def takes(
    kind: type[Any],
    name: str,
    flags: Mapping[str, str] | None = None,
    build: Callable[..., Any] | None = None,
) -> Decorator:
    """Add the options of settings that no configuration file holds.

    Args:
        kind: Class of the settings.
        name: Argument of the command that receives them.
        flags: Paths of its settings by option; by default an option of the
            same name for each.
        build: Makes the argument from the given values; the class of the
            settings by default.
    """
    entries = entries_of(cast(Any, kind))
    chosen = flags or {f"--{p.replace('_', '-')}": p for p in entries}

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(function)
        def command(**values: Any) -> Any:
            context = click.get_current_context()
            given = _named_values(context, values, entries, chosen)
            given = {p: entries[p].value_of(v) for p, v in given.items()}
            return function(**{name: (build or kind)(**given)}, **values)

        for flag, path in reversed(list(chosen.items())):
            _add(command, SettingOption(flag, entries[path]))
        return command

    return decorate


def refuse_options(names: Collection[str], requirement: str) -> None:
    """Refuse options that have no effect in this call.

    Args:
        names: Names of the command's arguments.
        requirement: What the options require, for the message.

    Raises:
        UsageError: If one of them is given.
    """
    context = click.get_current_context()
    for param in context.command.params:
        source = context.get_parameter_source(param.name or "")
        if param.name in names and source is ParameterSource.COMMANDLINE:
            raise click.UsageError(f"{param.opts[0]} requires {requirement}")
