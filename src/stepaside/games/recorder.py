"""The record of a game: a track of every player."""

from collections.abc import Sequence

import numpy as np

from ..core.poses import Array
from .match import Match
from .outcome import Outcome
from .player import Player
from .player_record import PlayerRecord
from .trajectory import PlanningTimes, Trajectory

PERIOD = 0.02  # between samples, in [s]


class Recorder:
    """Samples a game, and hands it out as tracks.

    Attributes:
        every: Control ticks between samples.
    """

    def __init__(
        self, players: Sequence[Player], *, tick: float, closely: bool = False
    ) -> None:
        """Record players.

        Args:
            players: Who play.
            tick: Control period, in [s].
            closely: Whether to keep how their feet stand, and what they
                believe of themselves.
        """
        self.every = max(1, round(PERIOD / tick))
        self._times: list[float] = []
        self._records = {
            player.name: PlayerRecord(closely) for player in players
        }

    @property
    def times(self) -> Array:
        """Times of the samples, in [s]. Shape (n,)."""
        return np.array(self._times)

    def before(self, match: Match) -> None:
        """Take a sample when one is due."""
        if match.world.ticks % self.every == 0:
            self._sample(match)

    def acted(self, match: Match) -> None:
        """Note the steps that begin."""
        for player in match.players:
            if player.begun is not None:
                self._records[player.name].begun.append(player.begun)

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Take the last sample, unless there is one of this instant."""
        for record in self._records.values():
            record.cut(len(self._times))  # an interrupt may have cut one short
        if not self._times or self._times[-1] < match.world.time:
            self._sample(match)

    def _sample(self, match: Match) -> None:
        for player in match.players:
            self._records[player.name].add(player.snapshot())
        self._times.append(match.world.time)

    def tracks(self) -> dict[str, Trajectory]:
        """Everything recorded so far, by name of the player."""
        return {name: rec.track() for name, rec in self._records.items()}

    def planning(self) -> dict[str, PlanningTimes]:
        """How everybody planned, by name of the player."""
        return {name: rec.planning() for name, rec in self._records.items()}
