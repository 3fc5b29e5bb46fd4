"""Modifications of the evader against a close reversed circle.

Choosing the side of the smaller error is not among them, because it is the
rule "behind": the desired bearings of the two sides, minus and plus the
angle, mirror each other in the evader's axis, so that the one in the
pursuer's half plane is always nearer.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf, pi, radians

from .basins import Array, Basins, find_basins
from .unicycle_game import Game, SideRule, TurningLaw

_ANGLES_DEG = (30.0, 60.0, 120.0, 150.0)  # evasion angles that are tried


@dataclass(frozen=True, slots=True)
class Remedy:
    """One modification of the evader and its basins.

    Attributes:
        name: Name of the modification.
        game: Modified game.
        basins: Fractions of the initial states that lead to each circle.
    """

    name: str
    game: Game
    basins: Basins

    @property
    def reversed_share(self) -> float:
        """Fraction of games that end on a reversed circle, in [1]."""
        pairs = zip(self.basins.circles, self.basins.shares, strict=True)
        return sum(share for circle, share in pairs if circle.direction < 0)

    @property
    def end_distance_m(self) -> float:
        """Least distance on a circle that games end on, in [m], or inf."""
        pairs = zip(self.basins.circles, self.basins.shares, strict=True)
        reached = (c.distance_m for c, share in pairs if share > 0.0)
        return min(reached, default=inf)


def alternatives(game: Game) -> dict[str, Game]:
    """Return the modified games by name, the unmodified game first."""
    widest = min(game.angle, pi - game.angle)
    found = {
        "as it is": game,
        "keeps its side": replace(game, side_rule=SideRule.LATCHED),
        "widest hysteresis": replace(game, hysteresis=widest),
    }
    for degrees in _ANGLES_DEG:
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
    """Play every alternative from the same initial states.

    Args:
        game: Parameters of the unmodified game.
        starts: Rows of r [m], a, psi [rad]. Shape (n, 3).
        capture_distance: Distance at which a game ends, in [m].
        progress: Called with the number of games finished since the last
            call.

    Returns:
        Results of each, the unmodified game first.
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
