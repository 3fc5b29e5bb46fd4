"""Heights of the CoM that legs reach, found by trying."""

from collections.abc import Callable
from functools import cached_property

STRIDE = 0.05  # relative step from one height to the next that is tried
CLOSE = 2e-4  # within which the ends are found, in [m]


class ReachableHeights:
    """Heights in reach with the feet in one place."""

    def __init__(
        self, reaches: Callable[[float], bool], natural: float
    ) -> None:
        """Ask a body.

        Args:
            reaches: Whether it reaches a height, in [m].
            natural: Height at which to begin, in [m].
        """
        self._reaches, self._natural = reaches, natural

    @cached_property
    def greatest(self) -> float:
        """Greatest height in reach, in [m]; 0 if there is none."""
        return self._last(1.0 + STRIDE)

    @cached_property
    def least(self) -> float:
        """Least height in reach, in [m]; 0 if there is none."""
        return self._last(1.0 - STRIDE)

    def in_words(self, asked: float) -> str:
        """What is in reach, for somebody who asked for something else."""
        if self.greatest == 0.0:
            return "no height at all"
        if asked > self.greatest:
            return f"at most {self.greatest:.3f} m"
        return f"{self.least:.3f} m to {self.greatest:.3f} m"

    @cached_property
    def _some(self) -> float:
        """Some height in reach; 0 if there is none."""
        height = self._natural
        while height > 0.1 * self._natural:
            if self._reaches(height):
                return height
            height *= 1.0 - STRIDE
        return 0.0

    def _last(self, factor: float) -> float:
        """Last height in reach, in steps by a factor and then by halving."""
        inside = outside = self._some
        if inside == 0.0:
            return 0.0
        while self._reaches(outside) and outside > 0.1 * self._natural:
            inside, outside = outside, factor * outside
        while abs(outside - inside) > CLOSE:
            middle = 0.5 * (inside + outside)
            if self._reaches(middle):
                inside = middle
            else:
                outside = middle
        return inside
