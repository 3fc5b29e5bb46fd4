"""What is going on, in words."""

from math import inf

from ...control import Phase
from ...games.duel import Duel

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


def phases_of(duel: Duel) -> tuple[Phase, Phase]:
    """What both robots do; a true fall counts."""
    pursuer, evader = (
        Phase.FALLEN if robot.truth.has_fallen else scheme.phase
        for robot, scheme in zip(duel.robots, duel.schemes, strict=True)
    )
    return pursuer, evader
