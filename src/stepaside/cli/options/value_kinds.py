"""Kinds of values that options take."""

from collections.abc import Callable, Collection, Mapping
from math import isfinite
from pathlib import Path
from typing import Any

import click


class NameType(click.ParamType[str]):
    """One of the names of a registry, which is asked when it is needed."""

    name = "choice"

    def __init__(
        self,
        registry: Callable[[], Collection[str]],
        old_names: Mapping[str, str] | None = None,
    ) -> None:
        """Remember where the names are.

        Args:
            registry: Gives the names.
            old_names: Names of today by what they were called before.
        """
        self.registry, self._old_names = registry, dict(old_names or {})

    @property
    def choices(self) -> tuple[str, ...]:
        """Names that may be chosen."""
        return tuple(self.registry())

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        """Names, as the help shows them."""
        return f"[{'|'.join(self.choices)}]"

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> str:
        """Look a name up."""
        name = self._old_names.get(value, value)
        return click.Choice(self.choices).convert(name, param, ctx)


class WordOrValueType(click.ParamType[Any]):
    """A value of another kind, or a word for one that has no number."""

    def __init__(
        self, kind: click.ParamType[Any], words: Mapping[str, Any]
    ) -> None:
        """Wrap a kind.

        Args:
            kind: Of all other values.
            words: Values by word; None stands for no value at all.
        """
        self.kind, self.words, self.name = kind, words, kind.name

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> Any:
        """Take a word for its value, and anything else as its kind does."""
        if value in self.words:
            return self.words[value]
        return self.kind.convert(value, param, ctx)


class OutputFile(click.ParamType[str]):
    """A file to write; one without a suffix gets the usual one."""

    name = "file"

    def __init__(self, *suffixes: str) -> None:
        """Note what it may end in, the usual first; anything if none."""
        self.suffixes = suffixes

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> str:
        """Take a path as it is written then."""
        file = Path(value)
        if self.suffixes and file.name and not file.suffix:
            return f"{value}{self.suffixes[0]}"
        return str(value)


class SizeType(click.ParamType[tuple[float, float] | None]):
    """Sides of a room like 3x3 or 2.5x4, in [m], or ``open`` for no walls."""

    name = "size"

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        """How it is written."""
        return "[WIDTHxDEPTH|open]"

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> tuple[float, float] | None:
        """Parse two sides."""
        if value is None or value == "open":
            return None
        if isinstance(value, tuple):
            return value
        try:
            width, depth = (float(side) for side in str(value).split("x"))
        except ValueError:
            width = depth = float("nan")
        if not (isfinite(width) and isfinite(depth)):
            self.fail(
                f"must be like 3x3 or 2.5x4 [m], or open, got {value!r:.60}",
                param,
                ctx,
            )
        return width, depth
