"""Click types of options: registered names, special words, files, sizes."""

from collections.abc import Callable, Collection, Mapping
from math import isfinite
from pathlib import Path
from typing import Any

import click


class NameType(click.ParamType[str]):
    """Choice from a registry that is imported on first use."""

    name = "choice"

    def __init__(
        self,
        registry: Callable[[], Collection[str]],
        old_names: Mapping[str, str] | None = None,
    ) -> None:
        """Store the registry.

        Args:
            registry: Returns the allowed names.
            old_names: Current names by former names, which stay valid.
        """
        self.registry, self._old_names = registry, dict(old_names or {})

    @property
    def choices(self) -> tuple[str, ...]:
        """Allowed names."""
        return tuple(self.registry())

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        """Return the allowed names for the help."""
        return f"[{'|'.join(self.choices)}]"

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> str:
        """Check a name, and replace a former name by the current one."""
        name = self._old_names.get(value, value)
        return click.Choice(self.choices).convert(name, param, ctx)


class WordOrValueType(click.ParamType[Any]):
    """Value of another type, or a word for a special value."""

    def __init__(
        self, kind: click.ParamType[Any], words: Mapping[str, Any]
    ) -> None:
        """Wrap a type.

        Args:
            kind: Type of all other values.
            words: Special values by word.
        """
        self.kind, self.words, self.name = kind, words, kind.name

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> Any:
        """Return the value of a word; convert anything else."""
        if value in self.words:
            return self.words[value]
        return self.kind.convert(value, param, ctx)


class OutputFile(click.ParamType[str]):
    """Output file; a name without suffix gets the default suffix."""

    name = "file"

    def __init__(self, *suffixes: str) -> None:
        """Store the allowed suffixes, the default first; any if empty."""
        self.suffixes = suffixes

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> str:
        """Return the path, with a suffix."""
        file = Path(value)
        if self.suffixes and file.name and not file.suffix:
            return f"{value}{self.suffixes[0]}"
        return str(value)


class SizeType(click.ParamType[tuple[float, float] | None]):
    """Width and depth of a room in [m], like 2.5x4; ``open`` for no walls."""

    name = "size"

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        """Return the placeholder for the help."""
        return "[WIDTHxDEPTH|open]"

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> tuple[float, float] | None:
        """Parse width and depth."""
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
