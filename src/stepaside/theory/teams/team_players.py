"""Players of a game of several unicycles."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

from ...core.errors import PlanError, check_positive, check_within
from ...core.poses import Array

NEAREST = -1  # target of a player that plays against its nearest opponent
MOST = 16  # players of a game


@dataclass(frozen=True, slots=True)
class TeamPlayer:
    """Unicycle of a game of several.

    Attributes:
        speed: Driving speed, in [m/s]; an evader drives backward.
        gain: Steering gain k, in [1/s].
        evades: Whether it evades; otherwise it pursues.
        angle: Evasion angle, in [0, pi], in [rad].
        target: Index of its target; ``NEAREST`` for the nearest player that
            evades if it pursues, and the reverse.
    """

    speed: float
    gain: float
    evades: bool = False
    angle: float = pi / 2
    target: int = NEAREST

    def __post_init__(self) -> None:
        """Validate the parameters."""
        check_positive(self.speed, "speed", "m/s")
        check_positive(self.gain, "gain", "1/s")
        check_within(self.angle, 0.0, pi, "angle", "rad")


def check_team(players: Sequence[TeamPlayer]) -> None:
    """Check the players of a game.

    Raises:
        PlanError: If there are fewer than two or too many, a target is not
            another player, or a player has no opponent.
    """
    count = len(players)
    if not 2 <= count <= MOST:
        raise PlanError(f"players must be 2 to {MOST}, got {count}")
    for number, player in enumerate(players):
        others = [n for n in range(count) if n != number]
        if player.target != NEAREST and player.target not in others:
            raise PlanError(
                f"target of player {number} must be another player, got "
                f"{player.target}"
            )
    for number, player in enumerate(players):
        if player.target == NEAREST and not _opponents(players, player):
            raise PlanError(f"player {number} must have an opponent, got none")


def _opponents(players: Sequence[TeamPlayer], own: TeamPlayer) -> list[int]:
    """Return the numbers of the players that evade if one pursues."""
    return [n for n, p in enumerate(players) if p.evades != own.evades]


@dataclass(frozen=True, slots=True, eq=False)
class TeamRules:
    """Parameters of all players as arrays, of shape (players,).

    Attributes:
        velocities: Driving velocities, negative for backward, in [m/s].
        gains: Steering gains, in [1/s].
        angles: Evasion angles, in [rad]; 0 of pursuers.
        targets: Targets, or ``NEAREST`` with several opponents.
        evades: Whether each evades.
    """

    velocities: Array
    gains: Array
    angles: Array
    targets: NDArray[np.int64]
    evades: NDArray[np.bool_]


def team_rules(players: Sequence[TeamPlayer]) -> TeamRules:
    """Return the parameters of players as arrays."""
    targets = [
        opposed[0] if p.target == NEAREST and len(opposed) == 1 else p.target
        for p, opposed in ((p, _opponents(players, p)) for p in players)
    ]
    return TeamRules(
        np.array([-p.speed if p.evades else p.speed for p in players]),
        np.array([p.gain for p in players]),
        np.array([p.angle if p.evades else 0.0 for p in players]),
        np.array(targets, dtype=np.int64),
        np.array([p.evades for p in players]),
    )
