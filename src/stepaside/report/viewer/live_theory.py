"""What theory expects of a duel, as its settings are at this moment."""

from math import degrees
from typing import NamedTuple

from ...games.duel_circle import theory_of
from ...games.duel_settings import DuelSettings
from ..settling_report import settling_time


class Expected(NamedTuple):
    """Circle of theory; None for each value that it does not have.

    Attributes:
        theory: Distance [m] and angle [deg] of the players on it.
        radius: Of the evader's way, in [m].
        settling: Time in which what is off it shrinks by e, in [s].
    """

    theory: tuple[float, float] | None
    radius: float | None
    settling: float | None


def expected_of(settings: DuelSettings) -> Expected:
    """Find the circle of theory for some settings."""
    circle, settling = theory_of(settings), settling_time(settings)
    if not circle.exists:
        return Expected(None, None, settling)
    theory = circle.distance_m, degrees(circle.headings_apart_rad)
    return Expected(theory, circle.radius_evader_m, settling)
