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
    """Sensor with a rate, a latency and losses."""

    take: Callable[[float], T]  # function that returns a percept at a time
    period: float  # period of the exposures [s]
    latency: float  # delay from exposure to arrival [s]
    drop: float  # fraction of lost percepts
    generator: np.random.Generator  # random generator of the losses
    taken: int = 0  # number of exposures
    # times of arrival and percepts that have not arrived
    pending: deque[tuple[float, T]] = field(default_factory=deque)

    @property
    def due(self) -> float:
        """Time of the next exposure or arrival, in [s]."""
        due = self.taken * self.period
        if self.pending:
            due = min(due, self.pending[0][0])
        return due - 1e-9

    def read(self, now: float, exposed: list[T]) -> list[T]:
        """Return what has arrived; take and expose a percept when due."""
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
    """Sensors of one robot, and what they took before its latency."""

    def __init__(self, streams: Sequence[SensorStream[T]]) -> None:
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
