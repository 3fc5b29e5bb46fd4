"""Errors raised by this package, and the checks that raise them."""

import os
import sys
from math import inf, tau
from numbers import Integral, Real
from pathlib import Path

AnyPath = str | os.PathLike[str]

# Of what is greater or smaller, cubes and ratios leave the numbers that a
# computer has; no length, time or rate of a robot is.
LARGEST, LEAST = 1e12, 1e-12
GREATEST = sys.float_info.max
LONGEST_WORD = 240  # of a message; paths are shorter


class StepAsideError(Exception):
    """Base class of every error that this package raises."""

    def __str__(self) -> str:
        """Message, short whatever was given."""
        return shortened(super().__str__())


class PlanError(StepAsideError, ValueError):
    """A plan was asked for with values that no plan can satisfy."""


class ConfigurationError(StepAsideError, ValueError):
    """A setting is unknown, of the wrong type or out of its range."""


class ReachError(StepAsideError, ValueError):
    """A body was asked for a posture that it cannot take."""


class StrategyError(StepAsideError, RuntimeError):
    """A strategy failed when it was asked, or gave no intent."""


class ModelError(StepAsideError, ValueError):
    """A robot description does not fit its model."""


class OutputError(StepAsideError, OSError):
    """The system did not let a result be written."""


def shortened(text: str) -> str:
    """Text without words that nobody reads, like a number of 1,000 digits.

    Args:
        text: Of any length.
    """
    if len(text) <= LONGEST_WORD:
        return text
    words = text.split(" ")
    return " ".join(
        w if len(w) <= LONGEST_WORD else f"{w[:60]}..." for w in words
    )


def shown(value: object) -> str:
    """A value for a message: short, for Python writes no number of any length.

    Args:
        value: Whatever was given.
    """
    if isinstance(value, int) and abs(value) >= 2**128:
        return "an integer of more than 38 digits"
    text = _spelled(value)
    return text if len(text) <= 80 else f"{text[:60]}..."


def _spelled(value: object) -> str:
    if isinstance(value, Real):
        return str(value)  # 0.5 even where NumPy writes np.float64(0.5)
    try:
        return " ".join(repr(value).split())
    except (ValueError, RecursionError):
        return f"a {type(value).__name__}"


def number_in(value: object, *, whole: bool = False) -> float | None:
    """A number in double precision; None for truth, text and all else.

    NumPy compares a narrow number with the bounds in its own precision, in
    which they may be zero or infinite.

    Args:
        value: Whatever was given.
        whole: Whether it must be an integer, which is exact at any size.
    """
    if type(value) is float and not whole:
        return value
    kind = Integral if whole else Real
    if isinstance(value, bool) or not isinstance(value, kind):
        return None
    if whole:
        return int(value)  # type: ignore[call-overload, no-any-return]
    try:
        return float(value)
    except OverflowError:
        return inf if value > 0 else -inf  # type: ignore[operator]


def check_finite(
    value: float,
    name: str,
    unit: str,
    error: type[StepAsideError] = PlanError,
) -> None:
    """Raise ``error`` unless ``value`` is a finite number."""
    number = number_in(value)
    if number is None or not -GREATEST <= number <= GREATEST:
        raise error(f"{name} must be finite [{unit}], got {shown(value)}")


def check_positive(
    value: float,
    name: str,
    unit: str,
    error: type[StepAsideError] = PlanError,
) -> None:
    """Raise ``error`` unless ``value`` is finite and above zero."""
    number = number_in(value)
    if number is None or not LEAST <= number <= LARGEST:
        raise error(
            f"{name} must be finite and > 0 [{unit}], {LEAST:g} to "
            f"{LARGEST:g}, got {shown(value)}"
        )


def check_not_negative(
    value: float,
    name: str,
    unit: str,
    error: type[StepAsideError] = PlanError,
) -> None:
    """Raise ``error`` unless ``value`` is finite and at least zero."""
    number = number_in(value)
    if number is None or not 0.0 <= number <= LARGEST:
        raise error(
            f"{name} must be finite and >= 0 [{unit}], at most "
            f"{LARGEST:g}, got {shown(value)}"
        )


def check_within(
    value: float,
    low: float,
    high: float,
    name: str,
    unit: str,
    error: type[StepAsideError] = PlanError,
) -> None:
    """Raise ``error`` unless ``low <= value <= high``."""
    number = number_in(value)
    if number is None or not low <= number <= high:
        raise error(
            f"{name} must lie in [{low:g}, {high:g}] [{unit}], "
            f"got {shown(value)}"
        )


def check_bearing(
    value: float,
    name: str,
    error: type[StepAsideError] = PlanError,
) -> None:
    """Raise ``error`` unless ``value`` is an angle within one turn, [rad]."""
    check_finite(value, name, "rad", error)
    check_within(value, -tau, tau, name, "rad", error)


def as_path(
    path: AnyPath,
    name: str,
    error: type[StepAsideError] = ConfigurationError,
) -> Path:
    """Return a path as a :class:`~pathlib.Path`.

    Args:
        path: Text or any ``os.PathLike`` of text.
        name: Of the argument, for the message.
        error: What is raised.

    Raises:
        StepAsideError: Of the kind asked for, if it is neither, or holds a
            null character.
    """
    try:
        found = Path(path)
    except TypeError as wrong:
        raise error(
            f"{name} must be a path, str or os.PathLike, got {shown(path)}"
        ) from wrong
    if "\0" in str(found):
        raise error(
            f"{name} must be a path without a null character, "
            f"got {shown(path)}"
        )
    return found
