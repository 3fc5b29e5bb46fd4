"""What is going on, in words."""

from math import inf, isfinite, log

from ...control import Phase
from ...games.duel import Duel
from ...games.player import Player

NEAR_DISTANCE = 0.05  # of theory's distance, on the circle
NEAR_ANGLE = 5.0  # of theory's angle, on the circle, in [deg]


def words_of(
    phases: tuple[Phase, Phase],
    distance: float,
    orientation: float,
    safety_radius: float,
    theory: tuple[float, float] | None,
) -> str:
    """Say what two robots are doing.

    Args:
        phases: Of pursuer and evader.
        distance: Between the torsos, in [m].
        orientation: Angle between the headings, in [deg].
        safety_radius: Of the evader, in [m].
        theory: Distance [m] and angle [deg] of the circle, if there is one.
    """
    pursuer, evader = phases
    if Phase.FALLEN in phases:
        names = [
            name
            for name, phase in zip(("pursuer", "evader"), phases, strict=True)
            if phase is Phase.FALLEN
        ]
        return f"**{' and '.join(names)} fell**"
    if evader is Phase.STANDING:
        if pursuer is Phase.STANDING:
            return "both robots are **standing**"
        if safety_radius < inf and distance < safety_radius:
            return "the evader is **triggered**: the pursuer came too near"
        return "the pursuer comes; the evader is **standing**"
    if evader is Phase.HALTING:
        return "the evader comes to rest"
    if theory is not None:
        away, angle = theory
        if (
            abs(distance - away) < NEAR_DISTANCE * away
            and abs(orientation - angle) < NEAR_ANGLE
        ):
            return "both robots are **on the circle**"
    return "the evader is **evading**"


def outlook(
    distance: float,
    phase: Phase,
    *,
    safety: float,
    speed: float,
    theory: tuple[float, float] | None,
    settling: float | None,
) -> str:
    """Say what is expected next, and when.

    Args:
        distance: Between the torsos, in [m].
        phase: Of the evader.
        safety: Radius of its safety area, in [m].
        speed: With which the pursuer comes, in [m/s].
        theory: Distance [m] and angle [deg] of the circle, if there is one.
        settling: Time in which what is off it shrinks by e, in [s], if it
            does.
    """
    if phase is Phase.STANDING:
        if not isfinite(safety) or speed <= 0.0:
            return ""
        left = max(0.0, (distance - safety) / speed)
        return (
            f"The evader moves when the pursuer is within {safety:.2f} m: "
            f"in about {left:.0f} s."
        )
    if theory is None or settling is None:
        return "Theory has no circle on which this ends."
    away, angle = theory
    told = f"Theory ends {away:.2f} m apart, headings {angle:.0f}\u00b0 apart"
    off = abs(distance - away) / away
    if off <= NEAR_DISTANCE:
        return f"{told}: so it is, within 5 %."
    return f"{told}: about {settling * log(off / NEAR_DISTANCE):.0f} s more."


def phases_of(duel: Duel) -> tuple[Phase, Phase]:
    """What both players do; a true fall counts."""
    pursuer, evader = (phase_of(player) for player in duel.players)
    return pursuer, evader


def phase_of(player: Player) -> Phase:
    """What a player does; who has no phases of its own walks."""
    if player.has_fallen:
        return Phase.FALLEN
    walk = player.snapshot().walk
    return Phase.WALKING if walk is None else walk.phase
