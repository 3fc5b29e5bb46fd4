"""Click types for numbers and angles, and JSON on standard output."""

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

STDOUT, STDERR = 1, 2  # file descriptors
UNITS = {"rad": 1.0, "deg": radians(1.0)}
REASON = "outside this range squares and ratios overflow a double"


class AngleType(click.ParamType[float]):
    """Angle in [rad], written as ``1.2``, ``1.2rad`` or ``70deg``."""

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
                "must be an angle like 1.2, 1.2rad or 70deg, within one full "
                f"turn, got {shown(value)}",
                param,
                ctx,
            )
        return angle


class NumberType(click.ParamType[float]):
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
        also = (0.0,) if allow_zero else ()
        self.unit = unit
        self.range = Range(1e-9, 1e9, unit, REASON, also=also)
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


_reserved: list[TextIO] = []  # standard output while reserved for JSON


@contextmanager
def reserve_stdout() -> Iterator[None]:
    """Reserve standard output for :func:`print_json`.

    All other output, as of user strategies and of processes that they start,
    is redirected to standard error.
    """
    shared = sys.stdout
    with ExitStack() as stack:
        stream = shared
        if _descriptor(shared) == STDOUT:
            shared.flush()
            saved = os.dup(STDOUT)
            stack.callback(os.close, saved)
            stream = stack.enter_context(
                open(
                    os.dup(STDOUT),
                    "w",
                    encoding=shared.encoding,
                    errors=shared.errors,
                )
            )
            stack.callback(os.dup2, saved, STDOUT)
            stack.callback(shared.flush)
            os.dup2(_duplicate_stderr(stack), STDOUT)
        stack.enter_context(redirect_stdout(sys.stderr))
        _reserved.append(stream)
        stack.callback(_reserved.pop)
        yield


def _descriptor(stream: TextIO) -> int | None:
    try:
        return stream.fileno()
    except (OSError, ValueError):  # a stream without descriptor
        return None


def _duplicate_stderr(stack: ExitStack) -> int:
    """Duplicate standard error; open the null device if it is closed."""
    try:
        descriptor = os.dup(STDERR)
    except OSError:
        descriptor = os.open(os.devnull, os.O_WRONLY)
    stack.callback(os.close, descriptor)
    return descriptor


def print_json(value: Any) -> None:
    """Print a value as one JSON object."""
    write_result(json.dumps(value, allow_nan=False) + "\n")


def write_result(text: str) -> None:
    """Write a result to standard output, even while that is reserved."""
    with redirect_stdout(_reserved[-1]) if _reserved else nullcontext():
        echo(text, nl=False)
