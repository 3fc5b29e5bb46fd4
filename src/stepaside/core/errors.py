"""Errors raised by this package, and checks of values."""

import os
import sys
from collections.abc import Collection
from contextlib import suppress
from difflib import get_close_matches
from math import tau
from numbers import Integral, Real
from pathlib import Path
from typing import Any
from unicodedata import category

# Unicode categories: control, format, surrogate, line and paragraph separator.
INVISIBLE = {"Cc", "Cf", "Cs", "Zl", "Zp"}
AnyPath = str | os.PathLike[str]

# Outside this range cubes and ratios may overflow a double; no length, time
# or rate of a robot lies there.
LARGEST, LEAST = 1e12, 1e-12
# Of code of users, whose sys.exit() must not end the program.
FAILURES = (Exception, SystemExit)


class StepAsideError(Exception):
    """Base class of every error that this package raises."""


Kind = type[StepAsideError]


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


def visible(text: str, *, but: str = "") -> str:
    r"""Escape invisible characters, like ``\x1b`` for escape, ``but`` some.

    The text may contain lone surrogates, as file names that are not valid
    UTF-8 do.
    """
    return "".join(
        c.encode("unicode_escape").decode("ascii")
        if category(c) in INVISIBLE and c not in but
        else c
        for c in text
    )


def shown(value: object) -> str:
    """Return a short text of any value, for a message."""
    try:
        # 0.5 even where NumPy writes np.float64(0.5)
        text = str(value) if isinstance(value, Real) else repr(value)
    except (ValueError, RecursionError):  # an integer of 5,000 digits
        text = f"a value of type {type(value).__name__}"
    text = " ".join(text.split())
    return text if len(text) <= 80 else f"{text[:60]}..."


def as_number(value: object, *, whole: bool = False) -> float | None:
    """Return a number in double precision, or an integer, which stays exact.

    It is None for any other type, such as ``bool``, and for an integer
    beyond double precision. NumPy would compare a half or single precision
    number with bounds in that precision, where they may round to zero or
    infinity.
    """
    if isinstance(value, bool):
        return None
    try:
        if whole:
            return int(value) if isinstance(value, Integral) else None
        return float(value) if isinstance(value, Real) else None
    except OverflowError:
        return None


def check_within(
    value: float,
    low: float,
    high: float,
    name: str,
    unit: str,
    error: Kind = PlanError,
    rule: str = "lie in [{:g}, {:g}]",
) -> None:
    """Raise ``error`` unless ``low <= value <= high``."""
    number = value if type(value) is float else as_number(value)
    if number is None or not low <= number <= high:
        told = f"{name} must {rule.format(low, high)} [{unit}]"
        raise error(f"{told}, got {shown(value)}")


def check_choice(value: Any, names: Collection[str], what: str) -> None:
    """Raise :class:`ConfigurationError` unless a value is a known name."""
    if value not in names:
        raise ConfigurationError(
            f"{what} must be one of {', '.join(names)}, got {value!r:.40}"
            f"{nearest_hint(str(value), names)}"
        )


def nearest_hint(name: str, known: Collection[str]) -> str:
    """Return the end of a message that names what may have been meant."""
    near = get_close_matches(name, known, 1)
    return f"; did you mean {near[0]}?" if near else ""


def check_finite(value: float, name: str, unit: str) -> None:
    """Raise :class:`PlanError` unless ``value`` is a finite number."""
    top = sys.float_info.max
    check_within(value, -top, top, name, unit, rule="be finite")


def check_positive(
    value: float, name: str, unit: str, error: Kind = PlanError
) -> None:
    """Raise ``error`` unless ``value`` is finite and above zero."""
    rule = "be finite and > 0"
    check_within(value, LEAST, LARGEST, name, unit, error, rule)


def check_bearing(value: float, name: str, error: Kind = PlanError) -> None:
    """Raise ``error`` unless ``value`` is an angle within one turn, [rad]."""
    check_within(value, -tau, tau, name, "rad", error)


def as_path(
    path: AnyPath, name: str, error: Kind = ConfigurationError
) -> Path:
    """Return a path; raise ``error`` if it is none or has a null character."""
    with suppress(TypeError):
        found = Path(path)
        if "\0" not in str(found):
            return found
    raise error(
        f"{name} must be a path, str or os.PathLike, without a null "
        f"character, got {shown(path)}"
    )
