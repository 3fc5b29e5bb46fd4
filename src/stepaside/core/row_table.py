"""Table of floats that grows row by row."""

import numpy as np

from .poses import Array

FIRST_CAPACITY = 256  # rows


class RowTable:
    """Rows of floats in one array, which doubles when it is full."""

    def __init__(self, columns: int) -> None:
        """Begin without rows."""
        self.count = 0
        self._rows: Array = np.empty((FIRST_CAPACITY, columns))

    def append(self) -> Array:
        """Add a row, and return it to be filled. Shape (columns,)."""
        if self.count == len(self._rows):
            self._rows = np.concatenate(
                (self._rows, np.empty_like(self._rows))
            )
        self.count += 1
        row: Array = self._rows[self.count - 1]
        return row

    def truncate(self, count: int) -> None:
        """Keep only the first rows."""
        self.count = min(self.count, count)

    @property
    def rows(self) -> Array:
        """The rows, as a view. Shape (count, columns)."""
        view: Array = self._rows[: self.count]
        return view
