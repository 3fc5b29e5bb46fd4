"""Scoreboard of teleoperation: survival time and closest approach."""

from math import inf
from threading import Lock
from typing import NamedTuple

MAX_ROUNDS = 8  # of the table
NEAR = 0.75  # fraction of the safety radius below which an approach is close
MAX_RADIUS = 0.8  # in place of an infinite or larger safety radius, in [m]
HOLD_TIME = 0.3  # time for which an approach counts as the closest, in [s]
TOLERANCE = 1e-3  # by which a closer approach must be closer, in [m]


class ScoreRound(NamedTuple):
    """Result of one round.

    Attributes:
        number: Number of the round, from 1.
        survived: Survival time of the evader, in [s].
        closest: Closest approach, in [m].
        ended: How the round ended, as text.
    """

    number: int
    survived: float
    closest: float
    ended: str


class Scoreboard:
    """Rounds of teleoperation since the page was started."""

    def __init__(self, survivor: str = "the evader") -> None:
        """Start without a round.

        Args:
            survivor: Who survives, in the texts.
        """
        self._survivor = survivor
        self._lock = Lock()
        self._rounds: list[ScoreRound] = []
        self._number = 0
        self._clear()

    def _clear(self) -> None:
        self._began: float | None = None
        self._now = 0.0
        self._closest, self._closest_at = inf, -inf

    def begin(self, time: float) -> None:
        """Begin a round, unless one has begun.

        Args:
            time: Simulated time, in [s].
        """
        with self._lock:
            if self._began is None:
                self._clear()
                self._began = self._now = time
                self._number += 1

    def update(self, time: float, distance: float) -> None:
        """Update the round with a distance.

        Args:
            time: Simulated time, in [s].
            distance: Between the players, in [m].
        """
        with self._lock:
            if self._began is None:
                return
            self._now = max(time, self._began)
            if distance < self._closest - TOLERANCE:
                self._closest, self._closest_at = distance, self._now

    def end(self, how: str) -> None:
        """End the round, if one has begun.

        Args:
            how: How it ended, as text.
        """
        with self._lock:
            if self._began is not None and self._closest < inf:
                survived = self._now - self._began
                ended = ScoreRound(self._number, survived, self._closest, how)
                self._rounds = [*self._rounds, ended][-MAX_ROUNDS:]
            self._clear()

    def is_close(self, safety: float) -> bool:
        """Return whether the closest approach of a round is happening.

        Args:
            safety: Safety radius of the evader, in [m].
        """
        with self._lock:
            near = self._closest < NEAR * min(safety, MAX_RADIUS)
            return near and self._now - self._closest_at < HOLD_TIME

    def text(self) -> str:
        """Return the current round and a table of past rounds in Markdown."""
        with self._lock:
            current = ""
            if self._began is not None and self._closest < inf:
                current = (
                    f"round {self._number}: {self._survivor} survived "
                    f"{self._now - self._began:.1f} s; closest approach "
                    f"{self._closest:.2f} m\n\n"
                )
            return current + _table(self._rounds)


def _table(rounds: list[ScoreRound]) -> str:
    """Return the rounds in Markdown; the closest approach is bold."""
    if not rounds:
        return ""
    best = min(each.closest for each in rounds)
    rows = [
        "| round | survival time | closest approach | ended by |",
        "|--|--|--|--|",
    ]
    for number, survived, closest, ended in rounds:
        cell = f"{closest:.2f} m"
        cell = f"**{cell}**" if closest == best else cell
        rows.append(f"| {number} | {survived:.1f} s | {cell} | {ended} |")
    return "\n".join(rows)
