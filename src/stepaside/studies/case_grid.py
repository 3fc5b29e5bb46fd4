"""CaseGrid of cases that are computed when they are asked for."""

from collections.abc import Sequence
from math import prod
from typing import Any, overload


class CaseGrid(Sequence[tuple[Any, ...]]):
    """Product of axes, as a sequence that is not in memory.

    The last axis changes fastest, as in nested loops. A slice is a grid.
    """

    def __init__(
        self, *axes: Sequence[Any], numbers: range | None = None
    ) -> None:
        """Make the product of some axes.

        Args:
            axes: Values along each axis.
            numbers: Numbers of the items of the product; all by default.
        """
        self._axes = axes
        whole = range(prod(map(len, axes)))
        self._numbers = whole if numbers is None else numbers

    def __len__(self) -> int:
        """Return the number of items."""
        return len(self._numbers)

    @overload
    def __getitem__(self, at: int) -> tuple[Any, ...]: ...

    @overload
    def __getitem__(self, at: slice) -> "CaseGrid": ...

    def __getitem__(self, at: int | slice) -> "tuple[Any, ...] | CaseGrid":
        """Return an item: one value of each axis; or a part of the grid."""
        if isinstance(at, slice):
            return CaseGrid(*self._axes, numbers=self._numbers[at])
        number, values = self._numbers[at], []
        for axis in reversed(self._axes):
            number, i = divmod(number, len(axis))
            values.append(axis[i])
        return tuple(reversed(values))
