"""Declarations of options that several commands share."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import degrees
from typing import Any, NamedTuple

import click

from ..value_types import ANGLE, NumberType
from .value_kinds import NameType, WordOrValueType

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]
# Imports and returns a class of settings, so that declaring options is cheap.
SettingsClass = Callable[[], type[Any]]


@dataclass(frozen=True, eq=False)
class OptionDeclaration:
    """Name, meaning and configuration entry of an option.

    Defaults and ranges are not declared here: the settings define both.

    Attributes:
        name: Name for click: ``--friction``, or ``--clutter/--no-clutter``
            for a flag.
        help: Help text. ``{unit}`` and ``{default}`` are placeholders; a unit
            and a default without placeholder are appended.
        path: Configuration entry that the option sets, like
            ``physics.friction``; empty if it is not in a configuration.
        unit: Unit of a number; ``rad`` for an angle, which the user may also
            give in degrees.
        registry: Returns the allowed names, or a mapping from names to the
            values that the entry is set to.
        words: Words for special values, like ``never`` for infinity.
        kind: Click type, if the other attributes do not determine it.
        shows_default: Whether the help ends with the default.
        aliases: Further names.
        collect: Converts the values of a repeated option to the value of the
            entry.
        extra: Further arguments for click.
    """

    name: str
    help: str
    path: str = ""
    unit: str = ""
    registry: Callable[[], Collection[Any]] | None = None
    words: Mapping[str, Any] = field(default_factory=dict)
    kind: click.ParamType[Any] | None = None
    shows_default: bool = True
    aliases: tuple[str, ...] = ()
    collect: Callable[[Any], Any] | None = None
    extra: Mapping[str, Any] = field(default_factory=dict)

    @property
    def is_flag(self) -> bool:
        """Whether the option is a flag."""
        return "/" in self.name

    @cached_property
    def type(self) -> click.ParamType[Any] | None:
        """Click type; None for a flag or for text."""
        kind = self.kind
        if kind is None and self.unit == "rad":
            kind = ANGLE
        elif kind is None and self.unit:
            kind = NumberType(self.unit, bounded=False)
        elif kind is None and self.registry and not self.is_flag:
            kind = NameType(self.registry)
        return (
            WordOrValueType(kind, self.words) if kind and self.words else kind
        )

    def option(
        self, settings: SettingsClass | None = None, **extra: Any
    ) -> Decorator:
        """Return a decorator that adds the option to a command.

        Args:
            settings: Class of the settings that provide the default.
            extra: What click is told in this command alone; ``help``
                replaces what it means, ``type`` how it is read, and
                ``aliases`` adds spellings.
        """
        names = (self.name, *self.aliases, *extra.pop("aliases", ()))
        if self.path:
            names = (*names, self.path.replace(".", "__"))
        extra = {"help": self.help, **self.extra, **extra}
        return click.option(
            *names,
            cls=DeclaredOption,
            declaration=self,
            settings=settings if self.path else None,
            type=extra.pop("type", self.type),
            **extra,
        )

    def value_of(self, given: Any) -> Any:
        """Convert an argument to the value of the configuration entry."""
        if self.collect is not None:
            return self.collect(given)
        values = self.registry() if self.registry is not None else None
        return values[given] if isinstance(values, Mapping) else given

    def default_in(self, settings: Any) -> str:
        """Return the default as the user would write it; empty for None.

        Args:
            settings: Default settings.
        """
        value = settings
        for name in self.path.split("."):
            value = getattr(value, name)
        for word, meant in self.words.items():
            if value == meant:
                return word
        values = self.registry() if self.registry is not None else None
        if isinstance(values, Mapping):
            names = [name for name, v in values.items() if v == value]
            value = names[0] if names else None
        if self.is_flag:
            on, off = (n.strip().lstrip("-") for n in self.name.split("/"))
            return on if value else off
        if value is None or value == ():
            return ""
        if self.unit == "rad":
            return f"{degrees(value):g}deg"
        return f"{value:g}" if isinstance(value, float) else str(value)

    def text(self, meaning: str, default: str) -> str:
        """Return a help text with unit and default filled in."""
        if self.unit and "{unit}" not in meaning:
            meaning = f"{meaning.rstrip('.')} {{unit}}."
        if default and "{default}" not in meaning:
            meaning = f"{meaning}  [default: {{default}}]"
        return meaning.format(unit=f"[{self.unit}]", default=default)


class DeclaredOption(click.Option):
    """Click option made from a declaration."""

    def __init__(
        self,
        *args: Any,
        declaration: OptionDeclaration,
        settings: SettingsClass | None,
        **extra: Any,
    ) -> None:
        """Store declaration and settings class for the help."""
        self.declaration, self._settings = declaration, settings
        super().__init__(*args, **extra)

    @property
    def sets_settings(self) -> bool:
        """Whether the option sets an entry of the command's settings."""
        return self._settings is not None

    def get_help_record(self, ctx: click.Context) -> tuple[str, str] | None:
        """Return name and help, with the default of the settings."""
        default = ""
        if self._settings is not None and self.declaration.shows_default:
            default = self.declaration.default_in(self._settings()())
        meaning, self.help = (
            self.help,
            self.declaration.text(self.help or "", default),
        )
        try:
            return super().get_help_record(ctx)
        finally:
            self.help = meaning


class OptionGroup(NamedTuple):
    """Section of options in the help.

    Attributes:
        title: Title of the section.
        options: Declarations of its options.
    """

    title: str
    options: tuple[OptionDeclaration, ...]

    def without(self, *options: OptionDeclaration) -> "OptionGroup":
        """Return the group without some options."""
        remaining = tuple(o for o in self.options if o not in options)
        return OptionGroup(self.title, remaining)
