"""Past values with their times."""

from bisect import insort
from collections import deque
from collections.abc import Callable
from typing import Generic, TypeVar

Value = TypeVar("Value")
CLOSE = 1e-9  # times that differ by less are one, in [s]


class History(Generic[Value]):
    """Values of the last moments, for sensors with latency."""

    def __init__(self, span: float) -> None:
        """Begin empty, and drop values older than a span, in [s]."""
        self._span = span
        self._values: deque[tuple[float, Value]] = deque()

    def note(self, time: float, value: Value) -> None:
        """Store a value; its time, in [s], may be earlier than the latest."""
        values = self._values
        if values and time < values[-1][0]:
            insort(values, (time, value), key=lambda entry: entry[0])
            return
        values.append((time, value))
        while values[0][0] < time - self._span:
            values.popleft()

    @property
    def latest(self) -> Value | None:
        """Latest value; None before the first."""
        return self._values[-1][1] if self._values else None

    def at(
        self,
        time: float,
        mix: Callable[[Value, Value, float], Value] | None = None,
    ) -> Value:
        """Return the value at a time, in [s], or else the oldest one.

        Between two values it is the earlier one, or their mix by the share of
        the second.
        """
        later: tuple[float, Value] | None = None
        for entry in reversed(self._values):
            if entry[0] <= time + CLOSE:
                if mix is None or later is None or time <= entry[0]:
                    return entry[1]
                share = (time - entry[0]) / (later[0] - entry[0])
                return mix(entry[1], later[1], share)
            later = entry
        return self._values[0][1]
