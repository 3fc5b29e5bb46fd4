"""What a robot was a moment ago, for sightings that arrive late."""

from collections import deque
from typing import Generic, TypeVar

KEPT = 2.0  # how long values are kept, in [s]

Value = TypeVar("Value")


class StateHistory(Generic[Value]):
    """Values of the last control ticks."""

    def __init__(self, tick: float) -> None:
        """Begin empty, for a clock with a given tick, in [s]."""
        self._values: deque[tuple[float, Value]] = deque(
            maxlen=max(1, round(KEPT / tick))
        )

    def note(self, time: float, value: Value) -> None:
        """Keep a value of a time, in [s]."""
        self._values.append((time, value))

    def at(self, time: float) -> Value:
        """Value at a time, in [s]; before memory begins, the first."""
        value = self._values[0][1]
        for past, candidate in reversed(self._values):
            if past <= time + 1e-9:
                return candidate
        return value
