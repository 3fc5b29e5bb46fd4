"""Sensors with a rate, a latency and losses."""

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Generic, TypeVar

import numpy as np

from ..perception.images import AnyPercept

T = TypeVar("T", bound=AnyPercept)


@dataclass(slots=True, eq=False)
class SensorStream(Generic[T]):
    """Sensor with a rate, a latency and losses.

    Attributes:
        take: Function that returns a percept at a time.
        period: Period of the exposures, in [s].
        latency: Delay from exposure to arrival, in [s].
        drop: Fraction of lost percepts.
        generator: Random generator of the losses.
        taken: Number of exposures.
        pending: Times of arrival and percepts that have not arrived.
    """

    take: Callable[[float], T]
    period: float
    latency: float
    drop: float
    generator: np.random.Generator
    taken: int = 0
    pending: deque[tuple[float, T]] = field(default_factory=deque)

    @property
    def due(self) -> float:
        """Time of the next exposure or arrival, in [s]."""
        due = self.taken * self.period
        if self.pending:
            due = min(due, self.pending[0][0])
        return due - 1e-9

    def read(self, now: float, exposed: list[T]) -> list[T]:
        """Return percepts that have arrived; take one when it is due.

        Args:
            now: Time, in [s].
            exposed: List to which a new percept is appended.
        """
        if now >= self.taken * self.period - 1e-9:
            self.taken += 1
            if self.drop == 0.0 or self.generator.random() >= self.drop:
                percept = self.take(now)
                exposed.append(percept)
                self.pending.append((now + self.latency, percept))
        arrived = []
        while self.pending and self.pending[0][0] <= now + 1e-9:
            arrived.append(self.pending.popleft()[1])
        return arrived


class StreamedSensors(Generic[T]):
    """Sensors of one robot.

    Attributes:
        exposed: Percepts taken at the last tick, before their latency.
    """

    def __init__(self, streams: Sequence[SensorStream[T]]) -> None:
        """Read some sensors."""
        self._streams, self._due = streams, 0.0
        self.exposed: list[T] = []

    def read(self, now: float) -> tuple[T, ...]:
        """Return the percepts that arrive at a tick."""
        self.exposed.clear()
        if now < self._due:
            return ()
        arrived: list[T] = []
        for stream in self._streams:
            arrived += stream.read(now, self.exposed)
        self._due = min(stream.due for stream in self._streams)
        return tuple(arrived)

    def close(self) -> None:
        """Release graphics, if any."""


def period_of(rate: float, tick: float) -> float:
    """Return the multiple of a tick [s] that is nearest to a rate [1/s]."""
    return max(1, round(1.0 / rate / tick)) * tick
