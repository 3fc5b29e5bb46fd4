"""Recorded game as a value."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import cached_property
from itertools import combinations, product
from typing import Any

import numpy as np

from ..arena import Room
from ..core.player_identity import PlayerIdentity, Role
from ..core.poses import Array
from .game import Outcome
from .player_settings import EVADER, PURSUER, WALKER
from .summary import Summary
from .trajectory import Trajectory, angle_between, distance_between


@dataclass(frozen=True, eq=False, repr=False)
class Run:
    """Recorded game of any kind.

    Trajectories are in the world; those of a play are in the player's own
    odometry. There the opponent is at its last sighting and is drawn as a
    template that faces the player, as its heading is unknown.

    Attributes:
        name: Name of the run; that of its folder if it was read from one.
        settings: Settings of the game, with the initial poses filled in.
        outcome: How the game ended.
        message: Reason for the end, as text.
        duration: Simulated or recorded time, in [s].
        times: Times of the samples, in [s]. Shape (n,).
        tracks: Trajectory of each player, by name, in the order in which
            the players act.
        summary: Values measured in the game.
    """

    name: str
    settings: Any
    outcome: Outcome
    message: str
    duration: float
    times: Array
    tracks: Mapping[str, Trajectory]
    summary: Summary = Summary()

    def __repr__(self) -> str:
        """Describe the run in one line."""
        return (
            f"Run({self.name!r}, {self.message!r}, {len(self.times)} samples "
            f"of {' and '.join(self.players)})"
        )

    def uninterrupted(self) -> "Run":
        """Return the run.

        Raises:
            KeyboardInterrupt: If the user interrupted the game.
        """
        if self.outcome is Outcome.INTERRUPTED:
            raise KeyboardInterrupt
        return self

    @property
    def game(self) -> str:
        """Kind of game: "duel", "game", "walk", "play" or "experiment"."""
        kind: str = self.settings.game
        return kind

    @property
    def players(self) -> tuple[str, ...]:
        """Names of the players."""
        return tuple(self.tracks)

    @property
    def robots(self) -> tuple[str, ...]:
        """Names of the players with recorded joint angles."""
        return tuple(n for n, t in self.tracks.items() if t.qpos is not None)

    @property
    def persons(self) -> tuple[str, ...]:
        """Names of the players that are drawn as persons."""
        players = getattr(self.settings, "players", ())
        return tuple(p.name for p in players if p.body == "person")

    @property
    def deciding(self) -> tuple[str, ...]:
        """Names of the players that have a strategy, as far as is known."""
        players = getattr(self.settings, "players", None)
        if players is None:
            return self.players
        return tuple(p.name for p in players if p.decides)

    @property
    def identities(self) -> Mapping[str, PlayerIdentity]:
        """Identity of each player that has a role, by name."""
        known: dict[str, PlayerIdentity] = getattr(
            self.settings, "identities", {}
        )
        return known or {
            name: PlayerIdentity(name, Role(name), name)
            for name in self.players
            if name in [*Role]
        }

    @property
    def pursuer(self) -> Trajectory:
        """Trajectory of the pursuer."""
        return self.tracks[PURSUER]

    @property
    def evader(self) -> Trajectory:
        """Trajectory of the evader."""
        return self.tracks[EVADER]

    @property
    def walker(self) -> Trajectory:
        """Trajectory of the robot of a walk."""
        return self.tracks[WALKER]

    @cached_property
    def facing(self) -> tuple[tuple[str, str], ...]:
        """Names of each pursuer and evader."""
        roles = {name: own.role for name, own in self.identities.items()}
        return tuple(
            (one, other)
            for one, other in product(self.players, repeat=2)
            if roles.get(one) is Role.PURSUER
            and roles.get(other) is Role.EVADER
        )

    @cached_property
    def opponents(self) -> tuple[tuple[str, str], ...]:
        """Names of each pursuer and evader.

        Without such, of every pair of a player with a strategy and another,
        or of all. Empty with one player.
        """
        pairs, own = tuple(combinations(self.players, 2)), {*self.deciding}
        deciding = tuple(pair for pair in pairs if own & {*pair})
        return self.facing or deciding or pairs

    @property
    def pair(self) -> tuple[Trajectory, Trajectory] | None:
        """Trajectories of the first opponents; None with one player."""
        if not self.opponents:
            return None
        one, other = self.opponents[0]
        return self.tracks[one], self.tracks[other]

    @property
    def distance(self) -> Array:
        """Smallest distance between opponents' reference points, in [m].

        NaN with one player. Shape (n,).
        """
        if not self.opponents:
            return np.full(len(self.times), np.nan)
        tracks = {n: track.unicycle for n, track in self.tracks.items()}
        apart = [
            distance_between(tracks[one], tracks[other])
            for one, other in self.opponents
        ]
        nearest: Array = np.min(apart, axis=0)
        return nearest

    @property
    def has_orientation(self) -> bool:
        """Whether there are two players of known headings; not in a play."""
        return len(self.tracks) == 2 and self.game != "play"

    @property
    def orientation(self) -> Array:
        """Angle between the headings of two players, in [deg].

        NaN where it is unknown, see ``has_orientation``. Shape (n,).
        """
        if self.pair is None or not self.has_orientation:
            return np.full(len(self.times), np.nan)
        first, second = self.pair
        angle: Array = angle_between(first.unicycle, second.unicycle)
        return np.degrees(angle)

    @property
    def theory(self) -> tuple[float, float, float] | None:
        """Values on the circle of theory of a duel that has one.

        They are the radius of the evader [m], the distance between the
        players [m] and the angle between their headings [deg].
        """
        own = self.summary.theory
        if own is None or own.radius_m is None:
            return None
        angle = own.relative_orientation_deg or 0.0
        return own.radius_m, own.distance_m or 0.0, angle

    @property
    def plan(self) -> Room | None:
        """Room of the game; None on an open floor."""
        plan: Room | None = getattr(self.settings, "room", None)
        return plan

    def results(self) -> dict[str, Any]:
        """Return outcome and summary as ``--json`` prints them."""
        return {
            "outcome": self.outcome.value,
            "message": self.message,
            "seed": getattr(self.settings, "seed", None),
            "duration_s": self.duration,
            **asdict(self.summary),
        }

    def index_at(self, time: float) -> int:
        """Return the index of the first sample at or after a time, in [s]."""
        index = int(np.searchsorted(self.times, time - 1e-9))
        return min(index, len(self.times) - 1)

    def arrays(self) -> dict[str, Array]:
        """Return all arrays by name: ``times_s``, ``pursuer_com``, ..."""
        found = {"times_s": self.times}
        for name, track in self.tracks.items():
            found |= track.arrays(f"{name}_")
        return found
