"""Past headings of the torso, for sightings that arrive late."""

from collections import deque

MEMORY = 2.0  # how long they are kept, in [s]


class HeadingMemory:
    """Headings of the torso in odometry at the last control ticks."""

    def __init__(self, tick: float) -> None:
        """Begin empty, for a clock with a given tick, in [s]."""
        self._headings: deque[tuple[float, float]] = deque(
            maxlen=max(1, round(MEMORY / tick))
        )

    def note(self, time: float, heading: float) -> None:
        """Keep a heading, in [rad], of a time, in [s]."""
        self._headings.append((time, heading))

    def at(self, time: float) -> float:
        """Heading at a time, in [rad]; before memory begins, the first."""
        heading = self._headings[0][1]
        for past, candidate in reversed(self._headings):
            if past <= time + 1e-9:
                return candidate
        return heading
