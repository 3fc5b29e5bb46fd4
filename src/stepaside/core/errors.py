"""Errors raised by this package, and checks of values."""

import os
import sys
from math import inf, tau
from numbers import Integral, Real
from pathlib import Path

AnyPath = str | os.PathLike[str]

# Outside this range cubes and ratios may overflow a double; no length, time
# or rate of a robot lies there.
LARGEST, LEAST = 1e12, 1e-12
GREATEST = sys.float_info.max
LONGEST_WORD = 240  # in a message, in [characters]; paths are shorter


class StepAsideError(Exception):
    """Base class of every error that this package raises."""

    def __str__(self) -> str:
        """Return the message with overlong words cut."""
        return shorten_words(super().__str__())


class PlanError(StepAsideError, ValueError):
    """Arguments of a plan are invalid."""


class ConfigurationError(StepAsideError, ValueError):
    """A setting is unknown, of the wrong type or out of range."""


class ReachError(StepAsideError, ValueError):
    """A posture is outside the reach of a robot."""


class StrategyError(StepAsideError, RuntimeError):
    """A strategy raised an error or returned no valid intent."""


class ModelError(StepAsideError, ValueError):
    """A robot description does not fit its model."""


class PolicyError(StepAsideError, ValueError):
    """A learned policy does not fit its contract or its robot."""


class OutputError(StepAsideError, OSError):
    """A result could not be written."""


class CampaignError(StepAsideError, RuntimeError):
    """A campaign cannot go on: its workers are lost or do not fit."""


def shorten_words(text: str) -> str:
    """Return a text with overlong words cut, like a number of 1,000 digits."""
    if len(text) <= LONGEST_WORD:
        return text
    words = text.split(" ")
    return " ".join(
        w if len(w) <= LONGEST_WORD else f"{w[:60]}..." for w in words
    )


def shown(value: object) -> str:
    """Return a short text of any value, for a message.

    Python refuses to convert integers of thousands of digits.
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


def as_number(value: object, *, whole: bool = False) -> float | None:
    """Return a number in double precision; None for any other type.

    NumPy would compare a half or single precision number with the bounds in
    that precision, where they may round to zero or infinity.

    Args:
        value: Value to convert; ``bool`` is not a number.
        whole: Whether it must be an integer, which stays exact.
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
    number = as_number(value)
    if number is None or not -GREATEST <= number <= GREATEST:
        raise error(f"{name} must be finite [{unit}], got {shown(value)}")


def check_positive(
    value: float,
    name: str,
    unit: str,
    error: type[StepAsideError] = PlanError,
) -> None:
    """Raise ``error`` unless ``value`` is finite and above zero."""
    number = as_number(value)
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
    number = as_number(value)
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
    number = as_number(value)
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
        name: Name of the argument, for the message.
        error: Class of the error.

    Raises:
        StepAsideError: Of class ``error``, if it is no path or contains a
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
