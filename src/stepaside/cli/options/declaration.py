"""The declaration of an option, which any number of commands share."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import degrees
from typing import Any, NamedTuple

import click

from ..value_types import ANGLE, NumberType
from .value_kinds import NameType, WordOrValueType

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]
Kind = Callable[[], type[Any]]  # gives a class of settings when it is needed


@dataclass(frozen=True, eq=False)
class OptionDeclaration:
    """What an option is called, what it means, and what it sets.

    Defaults are not declared: they are those of the settings. Nor are
    ranges, which the settings refuse to leave.

    Attributes:
        name: As click takes it: ``--friction``, or ``--clutter/--no-clutter``
            for a flag.
        help: What it means; ``{unit}`` and ``{default}`` stand for both,
            which follow at the end if they are not named.
        path: Entry of the configuration that it sets, like
            ``physics.friction``; empty for an option of a command alone.
        unit: Of a number; ``rad`` for an angle, which may be given in
            degrees, too.
        registry: Gives the names that may be chosen, or whole values by
            name, which ``path`` is then set to.
        words: Values that have no number, by word.
        kind: Kind of value, where none of the former says it.
        tells_default: Whether the default follows the help.
        more_names: Further spellings.
        gather: Turns what was given into what is set, where it is not that.
        extra: What else click is told.
    """

    name: str
    help: str
    path: str = ""
    unit: str = ""
    registry: Callable[[], Collection[Any]] | None = None
    words: Mapping[str, Any] = field(default_factory=dict)
    kind: click.ParamType[Any] | None = None
    tells_default: bool = True
    more_names: tuple[str, ...] = ()
    gather: Callable[[Any], Any] | None = None
    extra: Mapping[str, Any] = field(default_factory=dict)

    @property
    def is_flag(self) -> bool:
        """Whether it is switched on and off."""
        return "/" in self.name

    @cached_property
    def type(self) -> click.ParamType[Any] | None:
        """How click reads it; None for a flag or for text."""
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

    def option(self, settings: Kind | None = None, **extra: Any) -> Decorator:
        """Option of one command.

        Args:
            settings: Class that it sets an entry of, for its default.
            extra: What click is told in this command alone; ``help``
                replaces what it means, ``type`` how it is read, and
                ``more_names`` adds spellings.
        """
        names = (self.name, *self.more_names, *extra.pop("more_names", ()))
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
        """Value for what was given: of a registry, for its name."""
        if self.gather is not None:
            return self.gather(given)
        values = self.registry() if self.registry is not None else None
        return values[given] if isinstance(values, Mapping) else given

    def default_in(self, settings: Any) -> str:
        """Word for what holds by default; empty if there is none.

        Args:
            settings: That hold by default.
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
        """Meaning with unit and default in their places."""
        if self.unit and "{unit}" not in meaning:
            meaning = f"{meaning.rstrip('.')} {{unit}}."
        if default and "{default}" not in meaning:
            meaning = f"{meaning}  [default: {{default}}]"
        return meaning.format(unit=f"[{self.unit}]", default=default)


class DeclaredOption(click.Option):
    """Option of a command, made from a declaration."""

    def __init__(
        self,
        *args: Any,
        declaration: OptionDeclaration,
        settings: Kind | None,
        **extra: Any,
    ) -> None:
        """Make it; see :meth:`OptionDeclaration.option`."""
        self.declaration, self._settings = declaration, settings
        super().__init__(*args, **extra)

    @property
    def sets_settings(self) -> bool:
        """Whether the command's settings are built from it."""
        return self._settings is not None

    def get_help_record(self, ctx: click.Context) -> tuple[str, str] | None:
        """Name and help, with the default of the settings."""
        default = ""
        if self._settings is not None and self.declaration.tells_default:
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
    """Options that stand together in the help.

    Attributes:
        title: Of the section.
        options: Their declarations.
    """

    title: str
    options: tuple[OptionDeclaration, ...]

    def without(self, *options: OptionDeclaration) -> "OptionGroup":
        """Group that lacks some options."""
        rest = tuple(o for o in self.options if o not in options)
        return OptionGroup(self.title, rest)
