"""What is going on, in words."""

from math import inf, isfinite, log

from ...control import Phase
from ...games.approach_forecast import CourseApproach, motion_words
from ...games.duel import Duel
from ...games.player import Player

NEAR_DISTANCE = 0.05  # of theory's distance, on the circle
NEAR_ANGLE = 5.0  # of theory's angle, on the circle, in [deg]
LONGEST = 600.0  # for which a straight course is believed, in [s]


def words_of(
    phases: tuple[Phase, Phase],
    distance: float,
    orientation: float,
    safety_radius: float,
    theory: tuple[float, float] | None,
    *,
    approach: CourseApproach | None = None,
) -> str:
    """Say what two robots are doing.

    Args:
        phases: Of pursuer and evader.
        distance: Between the torsos, in [m].
        orientation: Angle between the headings, in [deg].
        safety_radius: Of the evader, in [m].
        theory: Distance [m] and angle [deg] of the circle, if there is one.
        approach: Of the pursuer to the evader, where it is known.
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
        moves = motion_words(approach)
        return f"the pursuer {moves}; the evader is **standing**"
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
    approach: CourseApproach | None,
    theory: tuple[float, float] | None,
    settling: float | None,
) -> str:
    """Say what is expected next, and when.

    Args:
        distance: Between the torsos, in [m].
        phase: Of the evader.
        safety: Distance at which the evader begins to move, in [m].
        approach: Of the pursuer to the evader, where it is known.
        theory: Distance [m] and angle [deg] of the circle, if there is one.
        settling: Time in which what is off it shrinks by e, in [s], if it
            does.
    """
    if phase is Phase.STANDING:
        if not isfinite(safety):
            return ""
        told = f"The evader moves when the pursuer is within {safety:.2f} m"
        if approach is None or not approach.is_approaching:
            return f"{told}."
        left = approach.time_to(safety)
        if left is None:
            away = approach.closest
            return f"{told}; on this course it passes {away:.2f} m from it."
        return told + (f": in about {left:.0f} s." if left < LONGEST else ".")
    if theory is None or settling is None:
        return "Theory predicts no circle for this game."
    away, angle = theory
    told = (
        f"Theory: on a circle, {away:.2f} m and {angle:.0f}\u00b0 between the "
        "headings"
    )
    off = abs(distance - away) / away
    if off <= NEAR_DISTANCE:
        return f"{told}; the distance is within 5 % of it."
    return f"{told}, in about {settling * log(off / NEAR_DISTANCE):.0f} s."


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
