"""Command-line options made from the descriptions of settings."""

from collections.abc import Callable, Collection, Iterator
from dataclasses import MISSING, fields, is_dataclass
from functools import cache, wraps
from math import degrees
from pathlib import Path
from typing import Any, NamedTuple

import click
from click.core import ParameterSource

from ...arena import Room
from ...core.setting import REQUIRED, Setting, settings_of
from ...sim.push import Push
from ...strategies import Strategy
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

OWN = "Options"  # section of options that no file can set
Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]
# Types of options, by type of the field.
TYPES: dict[Any, click.ParamType[Any]] = {
    tuple[Push, ...]: PushType(),
    Room | None: RoomType(),
    str | Strategy: StrategyType(),
    tuple[float, float] | None: SizeType(),
    Path | None: click.Path(file_okay=False, path_type=Path),
}


class GroupedOption(click.Option):
    """Option in a section of the help.

    Attributes:
        group: Title of the section.
    """

    def __init__(self, *args: Any, group: str, **extra: Any) -> None:
        """Store the title."""
        self.group = group
        super().__init__(*args, **extra)


class SettingOption(GroupedOption):
    """Option that sets an entry of settings.

    Attributes:
        entry: Description and place of the setting.
    """

    def __init__(self, *args: Any, entry: "Entry", **extra: Any) -> None:
        """Store the entry."""
        self.entry = entry
        super().__init__(*args, **extra)

    @property
    def in_file(self) -> bool:
        """Whether a configuration file can set it, too."""
        return self.group != OWN


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

    def option(
        self, group: str = OWN, meaning: str = "", **extra: Any
    ) -> Decorator:
        """Return a decorator that adds the option to a command.

        Args:
            group: Title of the section of the help.
            meaning: Meaning, if it differs in this command.
            extra: Further arguments for click.
        """
        setting = self.setting
        text = meaning or setting.option_help or setting.text
        text = text.rstrip(".") + "."
        if shown := setting.default_text or self.default_text:
            text += f"  [default: {shown}]"
        given: dict[str, Any] = {
            "type": self.type,
            "help": text,
            "multiple": isinstance(self.default, tuple),
            "required": self.default is REQUIRED,
        }
        return click.option(
            *(setting.option, *setting.aliases, self.name),
            cls=SettingOption,
            entry=self,
            group=group,
            **(given | extra),
        )

    @property
    def flag(self) -> str:
        """Name of the option, for messages."""
        return self.setting.option.partition("/")[0]

    @property
    def name(self) -> str:
        """Name of the argument of the command."""
        return self.path.replace(".", "__")

    @property
    def type(self) -> click.ParamType[Any] | None:
        """Click type; None for a flag or for text."""
        setting, kind = self.setting, TYPES.get(self.hint)
        if "/" in setting.option:
            return None
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
        if "/" in setting.option:
            on, off = setting.option.replace(" ", "").split("/")
            return (on if value else off).lstrip("-")
        if value in (None, (), REQUIRED):
            return ""
        if setting.range is not None and setting.range.unit == "rad":
            return f"{degrees(value):g}deg"
        return f"{value:g}" if isinstance(value, float) else str(value)

    def value_of(self, given: Any) -> Any:
        """Convert an argument to the value of the setting."""
        if isinstance(self.default, tuple):  # the word "none" is None
            return tuple(one for one in given if one is not None)
        presets = self.setting.presets
        return given if presets is None else presets[given]


def entries_at(kind: type[Any], path: str) -> Iterator[Entry]:
    """Yield the entry at a path and, of a section, all entries in it.

    Args:
        kind: Class of the settings.
        path: Path like ``gait`` or ``control.method``.
    """
    for entry in all_entries(kind):
        if f"{entry.path}.".startswith(f"{path}."):
            yield entry


def all_entries(
    kind: type[Any],
    section: str = "",
    needs: tuple[tuple[str, str], ...] = (),
) -> tuple[Entry, ...]:
    """Return every entry of settings.

    Args:
        kind: Class of the settings.
        section: Path of the section that they are.
        needs: Conditions of this section.
    """
    key: Any = kind
    return _find_entries(key, section, needs)


@cache
def _find_entries(
    kind: Any, section: str, needs: tuple[tuple[str, str], ...]
) -> tuple[Entry, ...]:
    """Return the entries of :func:`all_entries`, found once."""
    described, found = settings_of(kind), list[Entry]()
    for field in fields(kind):
        default = field.default
        if field.default_factory is not MISSING:
            default = field.default_factory()
        path = f"{section}.{field.name}".lstrip(".")
        setting = described[field.name]
        all_needs = (*needs, setting.needs) if setting.needs else needs
        found.append(Entry(path, setting, default, field.type, all_needs))
        if is_dataclass(default):
            found += all_entries(type(default), path, all_needs)
    return tuple(found)


def given_options(
    values: dict[str, Any], entries: Collection[Entry]
) -> list[tuple[Entry, Any]]:
    """Remove the values of setting options from those of a command.

    Args:
        values: Values of the command, by name; changed.
        entries: Settings of the options.

    Returns:
        Entries and arguments of the options that are given.
    """
    context = click.get_current_context()
    given = []
    for entry in entries:
        value = values.pop(entry.name)
        source = context.get_parameter_source(entry.name)
        if source is not ParameterSource.DEFAULT:
            given.append((entry, value))
    return given


def takes(
    kind: type[Any],
    name: str,
    without: Collection[str] = (),
    build: Callable[..., Any] | None = None,
) -> Decorator:
    """Add the options of settings that no configuration file holds.

    Args:
        kind: Class of the settings.
        name: Argument of the command that receives them.
        without: Entries whose options the command does not have.
        build: Makes the argument from the given values; the class of the
            settings by default.
    """
    entries = [
        entry
        for entry in all_entries(kind)
        if entry.setting.option and entry.path not in without
    ]

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(function)
        def command(**values: Any) -> Any:
            given = given_options(values, entries)
            chosen = {e.path: e.value_of(value) for e, value in given}
            return function(**{name: (build or kind)(**chosen)}, **values)

        wrapped: Callable[..., Any] = command
        for entry in reversed(entries):
            wrapped = entry.option()(wrapped)
        return wrapped

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
