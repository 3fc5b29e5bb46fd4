"""Types and habits that all commands share."""

import json
from math import isfinite, radians
from typing import Any

import click

from .terminal import echo

UNITS = {"rad": 1.0, "deg": radians(1.0)}


class AngleType(click.ParamType[float]):
    """An angle: ``1.2``, ``1.2rad`` or ``70deg``; a float in [rad]."""

    name = "angle"

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> float:
        """Parse an angle."""
        text, scale = str(value).strip(), 1.0
        for unit, factor in UNITS.items():
            if text.endswith(unit):
                text, scale = text[: -len(unit)].strip(), factor
                break
        try:
            angle = float(text) * scale
        except ValueError:
            angle = float("nan")
        if not isfinite(angle):
            self.fail(
                "must be a finite angle like 1.2, 1.2rad or 70deg, "
                f"got {value!r}",
                param,
                ctx,
            )
        return angle


class NumberType(click.ParamType[float]):
    """A finite number above a bound, or at it."""

    name = "number"

    def __init__(self, unit: str, *, allow_zero: bool = False) -> None:
        """Name the unit for messages."""
        self.unit, self.allow_zero = unit, allow_zero

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> float:
        """Parse a number."""
        try:
            number = float(value)
        except ValueError:
            number = float("nan")
        low_enough = number >= 0.0 if self.allow_zero else number > 0.0
        # Of what is smaller or greater, squares and ratios are no numbers.
        small = 0.0 < number < 1e-9
        if small or number > 1e9 or not (isfinite(number) and low_enough):
            rule = ">= 0" if self.allow_zero else "> 0"
            self.fail(
                f"must be finite and {rule}, 1e-9 to 1e9 [{self.unit}], "
                f"got {value!r:.60}",
                param,
                ctx,
            )
        return number


ANGLE = AngleType()
METERS = NumberType("m")
SECONDS = NumberType("s")
POSITIVE = NumberType("1")


def print_json(value: Any) -> None:
    """Print a value as one JSON object."""
    echo(json.dumps(value, allow_nan=False))


def print_table(rows: list[tuple[str, str]]) -> None:
    """Print names and values in two columns."""
    width = max(len(name) for name, _ in rows)
    for name, value in rows:
        echo(f"  {name:<{width}}  {value}")
