"""How long an evader survived the hand, and how near the hand came."""

from math import inf
from threading import Lock
from typing import NamedTuple

KEPT = 8  # rounds of the table
NEAR = 0.75  # share of the safety radius below which an approach is close
WIDEST = 0.8  # safety radius of who has none, in [m]
LASTING = 0.3  # how long an approach is the closest one, in [s]
NOTICED = 1e-3  # by how much a closer one is closer, in [m]


class ScoreRound(NamedTuple):
    """One round of the game.

    Attributes:
        number: From 1 on.
        survived: Simulated time that it lasted, in [s].
        closest: Least distance, in [m].
        ended: How, in words.
    """

    number: int
    survived: float
    closest: float
    ended: str


class Scoreboard:
    """Rounds of one visit; whoever drives begins one."""

    def __init__(self) -> None:
        """Begin without a round."""
        self._lock = Lock()
        self._rounds: list[ScoreRound] = []
        self._number = 0
        self._clear()

    def _clear(self) -> None:
        self._began: float | None = None
        self._now = 0.0
        self._closest, self._closest_at = inf, -inf

    def begin(self, time: float) -> None:
        """Begin a round at a simulated time, in [s], unless one is on."""
        with self._lock:
            if self._began is None:
                self._clear()
                self._began = self._now = time
                self._number += 1

    def watch(self, time: float, distance: float) -> None:
        """See how far apart the robots are, in [m]."""
        with self._lock:
            if self._began is None:
                return
            self._now = max(time, self._began)
            if distance < self._closest - NOTICED:
                self._closest, self._closest_at = distance, self._now

    def end(self, how: str) -> None:
        """End the round, if one is on.

        Args:
            how: In words.
        """
        with self._lock:
            if self._began is not None and self._closest < inf:
                survived = self._now - self._began
                ended = ScoreRound(self._number, survived, self._closest, how)
                self._rounds = [*self._rounds, ended][-KEPT:]
            self._clear()

    def is_close(self, safety: float) -> bool:
        """Whether the closest approach of a round is being made.

        Args:
            safety: Radius of the evader's safety area, in [m].
        """
        with self._lock:
            near = self._closest < NEAR * min(safety, WIDEST)
            return near and self._now - self._closest_at < LASTING

    def words(self) -> str:
        """The round that is on, and a table of those before it."""
        with self._lock:
            said = ""
            if self._began is not None and self._closest < inf:
                said = (
                    f"round {self._number}: the evader survived "
                    f"{self._now - self._began:.1f} s; closest approach "
                    f"{self._closest:.2f} m\n\n"
                )
            return said + _table(self._rounds)


def _table(rounds: list[ScoreRound]) -> str:
    """Rounds as markdown; the closest of all is bold."""
    if not rounds:
        return ""
    best = min(each.closest for each in rounds)
    rows = ["| round | survived | closest | ended |", "|--|--|--|--|"]
    for number, survived, closest, ended in rounds:
        told = f"{closest:.2f} m"
        told = f"**{told}**" if closest == best else told
        rows.append(f"| {number} | {survived:.1f} s | {told} | {ended} |")
    return "\n".join(rows)
