"""Click types of options: numbers, names, files, rooms, pushes, strategies."""

import re
from collections.abc import Callable, Collection, Mapping
from math import isfinite, radians, tau
from pathlib import Path
from typing import Any, TypeVar

import click

from ...core.errors import StepAsideError, shown
from ...core.ranges import Range
from ...sim.push import Push
from ...strategies.registry import absolute_name, check_strategy_name

UNITS = {"rad": 1.0, "deg": radians(1.0)}
T = TypeVar("T")
REASON = "outside this range squares and ratios overflow a double"


def positive(unit: str, *also: float | None) -> Range:
    """Return the common range of positive numbers.

    Args:
        unit: Unit of the numbers.
        also: Further permitted values.
    """
    return Range(1e-9, 1e9, unit, REASON, also=also)


class TextType(click.ParamType[T]):
    """Option type that parses one value."""

    def parse(self, value: Any) -> T:
        """Return the value of a text, or a value of this type unchanged.

        Raises:
            click.BadParameter: If it is invalid.
            StepAsideError: Likewise.
        """
        raise NotImplementedError

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> T:
        """Parse a value of an option."""
        try:
            return self.parse(value)
        except click.BadParameter as error:
            self.fail(error.message, param, ctx)
        except StepAsideError as error:
            self.fail(str(error), param, ctx)


class AngleType(TextType[float]):
    """Angle in [rad], written as ``1.2``, ``1.2rad`` or ``70deg``."""

    name = "angle"

    def parse(self, value: Any) -> float:
        """Parse an angle."""
        text, scale = str(value).strip(), 1.0
        for unit, factor in UNITS.items():
            if text.endswith(unit):
                text, scale = text[: -len(unit)].strip(), factor
                break
        try:
            angle = float(text) * scale
        except (ValueError, OverflowError):
            angle = float("nan")
        if not -tau <= angle <= tau:
            raise click.BadParameter(
                "must be an angle like 1.2, 1.2rad or 70deg, within one full "
                f"turn, got {shown(value)}"
            )
        return angle


class NumberType(TextType[float]):
    """Number within a range."""

    name = "number"

    def __init__(
        self, unit: str, *, allow_zero: bool = False, bounded: bool = True
    ) -> None:
        """Set unit and range.

        Args:
            unit: Unit of the number, for messages.
            allow_zero: Whether zero is allowed, too.
            bounded: Whether to check the common range 1e-9 to 1e9; entries
                of settings have their own ranges, which the settings check.
        """
        self.unit = unit
        self.range = positive(unit, *((0.0,) if allow_zero else ()))
        self.is_bounded = bounded

    def parse(self, value: Any) -> float:
        """Parse a number."""
        try:
            number = float(value)
        except (ValueError, OverflowError):
            number = float("nan")
        if number != number:
            raise click.BadParameter(
                f"must be a number [{self.unit}], got {shown(value)}"
            )
        if self.is_bounded and not self.range.holds(number):
            raise click.BadParameter(
                f"must lie in {self.range.text} [{self.unit}], "
                f"got {shown(value)}"
            )
        return number


ANGLE = AngleType()
METERS = NumberType("m")
SECONDS = NumberType("s")


class NameType(click.ParamType[str]):
    """Choice from a registry that is imported on first use."""

    name = "choice"

    def __init__(self, registry: Callable[[], Collection[str]]) -> None:
        """Store the registry, which returns the allowed names."""
        self.registry = registry

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
        """Check a name."""
        return click.Choice(self.choices).convert(value, param, ctx)


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


class OutputFile(TextType[str]):
    """Output file; a name without suffix gets the default suffix."""

    name = "file"

    def __init__(self, *suffixes: str) -> None:
        """Store the allowed suffixes, the default first; any if empty."""
        self.suffixes = suffixes

    def parse(self, value: Any) -> str:
        """Return the path, with a suffix."""
        file = Path(value)
        if self.suffixes and file.name and not file.suffix:
            return f"{value}{self.suffixes[0]}"
        return str(value)


class SizeType(TextType[tuple[float, float] | None]):
    """Width and depth of a room in [m], like 2.5x4; ``open`` for no walls."""

    name = "size"

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        """Return the placeholder for the help."""
        return "[WIDTHxDEPTH|open]"

    def parse(self, value: Any) -> tuple[float, float] | None:
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
            raise click.BadParameter(
                f"must be like 3x3 or 2.5x4 [m], or open, got {shown(value)}"
            )
        return width, depth


class RoomType(TextType[int | Path]):
    """Seed of a random room, or room file."""

    name = "FILE|SEED"

    def parse(self, value: Any) -> int | Path:
        """Return the seed if there are only digits, else the path."""
        if isinstance(value, int | Path):
            return value
        if str(value).isdecimal():
            return int(value)
        if not Path(value).is_file():
            raise click.BadParameter(
                "must be an integer >= 0 or an existing file, got "
                f"{shown(value)}"
            )
        return Path(value)


class StrategyType(TextType[str]):
    """Strategy: a name of the registry, FILE.py:NAME or FILE.onnx."""

    name = "NAME|FILE.py:NAME|FILE.onnx"

    def parse(self, value: Any) -> str:
        """Check the syntax; a file is loaded when its strategy is used."""
        check_strategy_name(str(value))
        return absolute_name(str(value))


NO_VALUE = "none"  # removes the values of the configuration


class PushType(TextType[Push | None]):
    """Push: ``1.2@5:90deg`` is 1.2 N s at 5 s to the left, or ``none``.

    The player may precede it, as in ``pursuer=1.2@5:90deg``.
    """

    name = "[PLAYER=]IMPULSE@TIME:DIRECTION"
    syntax = re.compile(
        r"(?:(?P<player>[a-z]+)=)?(?P<impulse>[^@=]+)@(?P<time>[^:]+):"
        r"(?P<direction>.+)"
    )

    def parse(self, value: Any) -> Push | None:
        """Parse a push."""
        if value == NO_VALUE:
            return None
        parts = self.syntax.fullmatch(str(value))
        if parts is None:
            raise click.BadParameter(
                "must be IMPULSE@TIME:DIRECTION [N s, s, angle] like "
                f"1.2@5:90deg, got {shown(value)}"
            )
        return Push(
            IMPULSE.parse(parts["impulse"]),
            TIME.parse(parts["time"]),
            ANGLE.parse(parts["direction"]),
            player=parts["player"] or "",
        )


# Numbers in pushes, whose settings check the ranges.
IMPULSE = NumberType("N s", bounded=False)
TIME = NumberType("s", bounded=False)
SPEED = NumberType("m/s", bounded=False)
LENGTH = NumberType("m", bounded=False)
