"""Range of CoM heights that the legs reach, by bisection."""

from collections.abc import Callable
from functools import cached_property

STEP = 0.05  # relative step of the search before bisection
RESOLUTION = 2e-4  # to which the ends are found, in [m]


class ReachableHeights:
    """Range of CoM heights in reach for one stance, evaluated lazily."""

    def __init__(
        self, reaches: Callable[[float], bool], natural: float
    ) -> None:
        """Set up the search.

        Args:
            reaches: Predicate: whether a height, in [m], is reached.
            natural: Height at which the search begins, in [m].
        """
        self._reaches, self._natural = reaches, natural

    @cached_property
    def greatest(self) -> float:
        """Greatest height in reach, in [m]; 0 if there is none."""
        return self._search_end(1.0 + STEP)

    @cached_property
    def least(self) -> float:
        """Least height in reach, in [m]; 0 if there is none."""
        return self._search_end(1.0 - STEP)

    def describe(self, requested: float) -> str:
        """Return the range in reach as text, for an error message.

        Args:
            requested: Height that is out of reach, in [m].
        """
        if self.greatest == 0.0:
            return "no height at all"
        if requested > self.greatest:
            return f"at most {self.greatest:.3f} m"
        return f"{self.least:.3f} m to {self.greatest:.3f} m"

    @cached_property
    def _initial(self) -> float:
        """A height in reach, from which both ends are searched; 0 if none."""
        height = self._natural
        while height > 0.1 * self._natural:
            if self._reaches(height):
                return height
            height *= 1.0 - STEP
        return 0.0

    def _search_end(self, factor: float) -> float:
        """Return an end of the range: step by a factor, then bisect."""
        inside = outside = self._initial
        if inside == 0.0:
            return 0.0
        while self._reaches(outside) and outside > 0.1 * self._natural:
            inside, outside = outside, factor * outside
        while abs(outside - inside) > RESOLUTION:
            middle = 0.5 * (inside + outside)
            if self._reaches(middle):
                inside = middle
            else:
                outside = middle
        return inside
