"""Recent states of a robot, for sightings with latency."""

from collections import deque
from typing import Generic, TypeVar

DURATION = 2.0  # of the history, in [s]

Value = TypeVar("Value")


class StateHistory(Generic[Value]):
    """Values of the last control ticks."""

    def __init__(self, tick: float) -> None:
        """Begin empty, for a control period in [s]."""
        self._values: deque[tuple[float, Value]] = deque(
            maxlen=max(1, round(DURATION / tick))
        )

    def note(self, time: float, value: Value) -> None:
        """Store the value at a time, in [s]."""
        self._values.append((time, value))

    def at(self, time: float) -> Value:
        """Return the value at a time, in [s], or else the oldest one."""
        value = self._values[0][1]
        for past, candidate in reversed(self._values):
            if past <= time + 1e-9:
                return candidate
        return value
