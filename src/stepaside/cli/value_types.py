"""Types and habits that all commands share."""

import json
import os
import sys
from collections.abc import Iterator
from contextlib import (
    ExitStack,
    contextmanager,
    nullcontext,
    redirect_stdout,
)
from math import radians, tau
from typing import Any, TextIO

import click

from ..core.errors import shown
from ..core.ranges import Range
from .terminal import echo

STDOUT, STDERR = 1, 2  # descriptors
UNITS = {"rad": 1.0, "deg": radians(1.0)}
USUAL = "of what is smaller or greater, squares and ratios are no numbers"


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
        except (ValueError, OverflowError):
            angle = float("nan")
        if not -tau <= angle <= tau:
            self.fail(
                "must be a finite angle like 1.2, 1.2rad or 70deg, at most "
                f"one turn, got {shown(value)}",
                param,
                ctx,
            )
        return angle


class NumberType(click.ParamType[float]):
    """A number in a range."""

    name = "number"

    def __init__(
        self, unit: str, *, allow_zero: bool = False, bounded: bool = True
    ) -> None:
        """Name the unit, for messages.

        Args:
            unit: Of the number.
            allow_zero: Whether it may be zero, too.
            bounded: Whether it lies in the range of all numbers of commands;
                those of settings have ranges of their own, which the
                settings refuse to leave.
        """
        also = (0.0,) if allow_zero else ()
        self.unit = unit
        self.range = Range(1e-9, 1e9, unit, USUAL, also=also)
        self.is_bounded = bounded

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> float:
        """Parse a number."""
        try:
            number = float(value)
        except (ValueError, OverflowError):
            number = float("nan")
        if number != number:
            self.fail(
                f"must be a number [{self.unit}], got {shown(value)}",
                param,
                ctx,
            )
        if self.is_bounded and not self.range.holds(number):
            self.fail(
                f"must lie in {self.range.text} [{self.unit}], "
                f"got {shown(value)}",
                param,
                ctx,
            )
        return number


ANGLE = AngleType()
METERS = NumberType("m")
SECONDS = NumberType("s")
POSITIVE = NumberType("1")


_only: list[TextIO] = []  # where JSON goes while nothing else goes there


@contextmanager
def json_alone() -> Iterator[None]:
    """Keep standard output for :func:`print_json`.

    What others write there, like strategies of the user and the processes
    that they start, goes to standard error.
    """
    shared = sys.stdout
    with ExitStack() as stack:
        stream = shared
        if _descriptor(shared) == STDOUT:
            shared.flush()
            kept = os.dup(STDOUT)
            stack.callback(os.close, kept)
            stream = stack.enter_context(
                open(
                    os.dup(STDOUT),
                    "w",
                    encoding=shared.encoding,
                    errors=shared.errors,
                )
            )
            stack.callback(os.dup2, kept, STDOUT)
            stack.callback(shared.flush)
            os.dup2(_elsewhere(stack), STDOUT)
        stack.enter_context(redirect_stdout(sys.stderr))
        _only.append(stream)
        stack.callback(_only.pop)
        yield


def _descriptor(stream: TextIO) -> int | None:
    try:
        return stream.fileno()
    except (OSError, ValueError):  # it is not of the system
        return None


def _elsewhere(stack: ExitStack) -> int:
    """Descriptor of standard error; of nowhere if that is closed."""
    try:
        other = os.dup(STDERR)
    except OSError:
        other = os.open(os.devnull, os.O_WRONLY)
    stack.callback(os.close, other)
    return other


def print_json(value: Any) -> None:
    """Print a value as one JSON object."""
    answer(json.dumps(value, allow_nan=False) + "\n")


def answer(text: str) -> None:
    """Write what was asked for to standard output, see :func:`json_alone`."""
    with redirect_stdout(_only[-1]) if _only else nullcontext():
        echo(text, nl=False)


def print_table(rows: list[tuple[str, str]]) -> None:
    """Print names and values in two columns."""
    width = max(len(name) for name, _ in rows)
    for name, value in rows:
        echo(f"  {name:<{width}}  {value}")
