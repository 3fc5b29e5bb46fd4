"""Ranges of values: one description for checks, options and documents."""

from collections.abc import Mapping
from dataclasses import MISSING, fields, is_dataclass
from functools import cache
from numbers import Integral
from types import NoneType
from typing import Any, NamedTuple

from .errors import ConfigurationError, StepAsideError, number_in, shown


class Range(NamedTuple):
    """Numbers that a value may be, and why no others.

    Attributes:
        low: Least number.
        high: Greatest number.
        unit: Of both; ``1`` for a ratio or a count without a unit.
        why: Reason for the bounds, in a few words.
        above: Whether it must be above ``low``, not at it.
        whole: Whether it must be an integer.
        also: What it may be beside: infinity, zero, None for what is drawn.
    """

    low: float
    high: float
    unit: str
    why: str
    above: bool = False
    whole: bool = False
    also: tuple[float | None, ...] = ()

    def check(
        self,
        value: object,
        name: str,
        error: type[StepAsideError] = ConfigurationError,
    ) -> None:
        """Refuse what is not such a number, true and false among it.

        Args:
            value: Whatever was given.
            name: What it is for, for the message.
            error: What is raised.

        Raises:
            StepAsideError: Of the kind asked for; it names value, rule, unit
                and what was got.
        """
        if self.holds(value):
            return
        kind = "be an integer" if self.whole else "lie"
        raise error(
            f"{name} must {kind} in {self.text} [{self.unit}], "
            f"got {shown(value)}"
        )

    def holds(self, value: object) -> bool:
        """Whether a value is such a number, or what it may be beside."""
        if value is None:
            return None in self.also
        number = number_in(value, whole=self.whole)
        if number is None:
            return False
        within = self.low <= number <= self.high
        return (
            within and not (self.above and number == self.low)
        ) or number in self.also

    @property
    def text(self) -> str:
        """The range in brackets; a round one leaves its end out."""
        begin = "(" if self.above else "["
        return f"{begin}{self.low:g}, {self.high:g}]{self._more}"

    @property
    def words(self) -> str:
        """The range as docstrings and documents have it."""
        begin = "above " if self.above else ""
        return f"{begin}{self.low:g} to {self.high:g}{self._more}"

    @property
    def _more(self) -> str:
        named = ("none" if one is None else f"{one:g}" for one in self.also)
        return "".join(f" or {name}" for name in named)


Ranges = Mapping[str, Range]
NO_RANGES: Ranges = {}


def ranges_of(kind: type[Any]) -> Ranges:
    """Ranges that a class of settings declares, by attribute."""
    found: Ranges = getattr(kind, "ranges", NO_RANGES)
    return found


def check_settings(
    settings: Any,
    error: type[StepAsideError] = ConfigurationError,
    *,
    prefix: str = "",
) -> None:
    """Refuse settings that leave their ranges or are of another type.

    Numbers of other types than Python's become those.

    Args:
        settings: A dataclass with ``ranges``, by attribute. What has none
            must be of the type of its default: truth, text or a section.
        error: What is raised.
        prefix: Before each name in messages, like ``person.``.

    Raises:
        StepAsideError: Of the kind asked for.
    """
    for name, allowed in ranges_of(type(settings)).items():
        value = getattr(settings, name)
        allowed.check(value, f"{prefix}{name}", error)
        if type(value) not in (int, float, NoneType):  # of NumPy, or a ratio
            number = number_in(value, whole=isinstance(value, Integral))
            object.__setattr__(settings, name, number)
    for name, kind in _kinds(type(settings)).items():  # type: ignore[arg-type]
        value = getattr(settings, name)
        if not isinstance(value, kind):
            called = _CALLED.get(kind, f"a {kind.__name__}")
            raise error(f"{prefix}{name} must be {called}, got {shown(value)}")
        if kind is str and "\0" in value:  # no name of a file holds it
            raise error(
                f"{prefix}{name} must be text without a null, got "
                f"{shown(value)}"
            )


def check_count(
    values: object,
    most: int,
    name: str,
    error: type[StepAsideError] = ConfigurationError,
) -> None:
    """Refuse a list or tuple of more entries than anybody needs."""
    if not isinstance(values, list | tuple) or len(values) > most:
        got = len(values) if isinstance(values, list | tuple) else values
        raise error(
            f"{name} must be a list of at most {most} entries, "
            f"got {shown(got)}"
        )


_CALLED: Mapping[type[Any], str] = {bool: "true or false", str: "text"}


@cache
def _kinds(kind: type[Any]) -> dict[str, type[Any]]:
    """Types of the attributes that are no numbers, by their defaults."""
    found = {}
    for field in fields(kind):
        default = field.default
        if field.default_factory is not MISSING:
            default = field.default_factory()
        own = isinstance(default, bool | str) or is_dataclass(default)
        if field.name not in ranges_of(kind) and own:
            found[field.name] = type(default)
    return found


SEEDS = Range(
    *(0, 2**128 - 1, "1"),
    "generators of random numbers take seeds of 128 bits",
    whole=True,
)
RUNTIME = Range(1e-3, 86400.0, "s", "from a step of the physics to a day")
