"""Match of a pursuer and an evader, with what its rules measure."""

from collections.abc import Sequence
from math import hypot

from ..core.constants import CAPTURE_DISTANCE
from ..locomotion.policy.network_pool import NetworkPool
from ..sim.ground_truth import torsos_apart
from ..sim.world import World
from .match import Match, MatchObserver
from .outcome import Outcome
from .player import Player


class PairMatch(Match):
    """Match of a pursuer and an evader.

    Attributes:
        min_distance: Smallest distance so far between the torsos, in [m].
        captured_at: Time at which that distance first was at most the
            capture distance, in [s]; None if it never was. The game goes on.
        triggered_at: Time at which the evader first moved in the game, in
            [s]; None before. Motion before ``started_at`` does not count.
        triggered_distance: Distance between the reference points then, in
            [m].
    """

    def __init__(
        self,
        world: World,
        players: Sequence[Player],
        observers: Sequence[MatchObserver] = (),
        *,
        has_things: bool = False,
        networks: NetworkPool | None = None,
    ) -> None:
        """Prepare a match.

        Args:
            world: The simulation, with both players in it.
            players: Pursuer and evader.
            observers: The observers.
            has_things: Whether there are obstacles besides the players.
            networks: Networks of players on learned legs, if any.
        """
        super().__init__(
            world,
            players,
            observers,
            has_things=has_things,
            networks=networks,
        )
        self.pursuer, self.evader = self.players
        self._reach = self.pursuer.truth.reach + self.evader.truth.reach
        self.min_distance = self.torsos_apart
        self._near = self.min_distance < self._reach
        self.captured_at: float | None = None
        self.triggered_at: float | None = None
        self.triggered_distance: float | None = None

    @property
    def distance(self) -> float:
        """True distance between the reference points, in [m]."""
        x, y = self.pursuer.truth.position_reference_in_world
        u, v = self.evader.truth.position_reference_in_world
        return hypot(u - x, v - y)

    @property
    def torsos_apart(self) -> float:
        """True distance between the torsos, in [m]."""
        return torsos_apart(self.pursuer.truth, self.evader.truth)

    def _judge(self) -> Outcome | None:
        """Apply the rules, and note distance, trigger and capture."""
        now, apart = self.world.time, self.torsos_apart
        if self.started_at is not None and self.triggered_at is None:
            if self.evader.is_moving:
                self.triggered_at = now
                self.triggered_distance = self.distance
        if apart < self.min_distance:
            self.min_distance = apart
        if self.captured_at is None and apart <= CAPTURE_DISTANCE:
            self.captured_at = now
        self._near = apart < self._reach
        return super()._judge()

    def _can_touch(self) -> bool:
        """Return whether a contact is possible."""
        return self._has_things or self._near
