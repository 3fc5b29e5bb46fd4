"""What an evader can do about a close reversed circle.

The rule "behind" cannot be bettered by taking the side of the smaller error:
it is that rule. The desired bearings of the two sides, minus and plus the
angle, mirror each other in the evader's axis, so that the one on the
pursuer's own half is always the nearer.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf, pi, radians

from .basins import Array, Basins, find_basins
from .unicycle_game import Game, SideRule, TurningLaw

_ANGLES = (30.0, 60.0, 120.0, 150.0)  # tried instead, in degrees


@dataclass(frozen=True, slots=True)
class Remedy:
    """One thing that the evader can do, and what comes of it.

    Attributes:
        name: What is done.
        game: The game that is then played.
        basins: Where it leads to.
    """

    name: str
    game: Game
    basins: Basins

    @property
    def reversed_share(self) -> float:
        """Share of starts that end on a reversed circle, in [1]."""
        pairs = zip(self.basins.circles, self.basins.shares, strict=True)
        return sum(share for circle, share in pairs if circle.direction < 0)

    @property
    def end_distance_m(self) -> float:
        """Least distance on a circle that starts end on; inf for none."""
        pairs = zip(self.basins.circles, self.basins.shares, strict=True)
        reached = (c.distance_m for c, share in pairs if share > 0.0)
        return min(reached, default=inf)


def alternatives(game: Game) -> dict[str, Game]:
    """Give the games that an evader can make of a game, by name."""
    widest = min(game.angle, pi - game.angle)
    found = {
        "as it is": game,
        "keeps its side": replace(game, side_rule=SideRule.LATCHED),
        "widest hysteresis": replace(game, hysteresis=widest),
    }
    for degrees in _ANGLES:
        angle = radians(degrees)
        changed = replace(game, angle=angle, hysteresis=0.0)
        found[f"angle {degrees:g} deg"] = changed
    other = next(law for law in TurningLaw if law is not game.law)
    found[f"{other} law"] = replace(game, law=other)
    for factor in (0.25, 0.5, 2.0):
        evader = replace(game.evader, gain=factor * game.evader.gain)
        found[f"gain times {factor:g}"] = replace(game, evader=evader)
    return found


def try_remedies(
    game: Game,
    starts: Array,
    *,
    capture_distance: float = 1e-6,
    progress: Callable[[int], None] | None = None,
) -> tuple[Remedy, ...]:
    """Play every alternative from the same starts.

    Args:
        game: Parameters of the game as it is.
        starts: Rows of r [m], a, psi [rad]. Shape (n, 3).
        capture_distance: Distance at which a game ends, in [m].
        progress: Called with numbers of games done.

    Returns:
        What came of each, the game as it is first.
    """
    return tuple(
        Remedy(
            name,
            changed,
            find_basins(
                changed,
                starts,
                capture_distance=capture_distance,
                progress=progress,
            ),
        )
        for name, changed in alternatives(game).items()
    )
