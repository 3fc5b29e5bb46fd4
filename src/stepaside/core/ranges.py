"""Ranges of numbers, with units and reasons."""

from typing import NamedTuple

from .errors import ConfigurationError, Kind, as_number, shown


class Range(NamedTuple):
    """Permitted values of a number, with the reason for the bounds."""

    low: float  # lower bound
    high: float  # upper bound
    unit: str  # unit of both; 1 for a ratio or a count
    why: str  # reason for the bounds, in a few words
    above: bool = False  # whether the lower bound is excluded
    whole: bool = False  # whether the value must be an integer
    # Further permitted values, such as infinity, zero, or None for a value
    # that is drawn at random.
    also: tuple[float | None, ...] = ()

    def check(
        self, value: object, name: str, error: Kind = ConfigurationError
    ) -> None:
        """Check that a value is a number in the range; a ``bool`` is not."""
        if not self.holds(value):
            raise error(f"{name} must {self.rule}, got {shown(value)}")

    @property
    def rule(self) -> str:
        """The rule for messages, like ``lie in [0, 1] [m]``."""
        kind = "be an integer" if self.whole else "lie"
        return f"{kind} in {self.text} [{self.unit}]"

    def scaled(self, factor: float, unit: str) -> "Range":
        """Return the range in another unit."""
        low, high = self.low * factor, self.high * factor
        return self._replace(low=low, high=high, unit=unit)

    def holds(self, value: object) -> bool:
        """Return whether a value is permitted."""
        number = as_number(value, whole=self.whole)
        if number is None:
            return value is None and None in self.also
        least = number > self.low if self.above else number >= self.low
        return (least and number <= self.high) or number in self.also

    @property
    def text(self) -> str:
        """The range in interval notation."""
        begin = "(" if self.above else "["
        return f"{begin}{self.low:g}, {self.high:g}]{self._more}"

    @property
    def words(self) -> str:
        """The range as written in docstrings and documents."""
        begin = "above " if self.above else ""
        return f"{begin}{self.low:g} to {self.high:g}{self._more}"

    @property
    def _more(self) -> str:
        named = ("none" if one is None else f"{one:g}" for one in self.also)
        return "".join(f" or {name}" for name in named)


SEEDS = Range(
    0, 2**128 - 1, "1", "random generators take seeds of 128 bits", whole=True
)
RUNTIME = Range(1e-3, 86400.0, "s", "from a physics step to a day")


def positive(unit: str, *also: float | None) -> Range:
    """Return the common range of positive numbers."""
    why = "outside this range squares and ratios overflow a double"
    return Range(1e-9, 1e9, unit, why, also=also)
