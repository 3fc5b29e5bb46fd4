"""What theory expects of a duel, as its settings are at this moment."""

from math import degrees
from typing import NamedTuple

from ...games.duel_circle import theory_of
from ...games.duel_settings import DuelSettings
from ..settling_report import settling_time


class LiveTheory(NamedTuple):
    """Circle of theory; None for each value that it does not have.

    Attributes:
        theory: Distance [m] and angle [deg] of the players on it.
        radius: Of the evader's way, in [m].
        settling: Time in which what is off it shrinks by e, in [s].
    """

    theory: tuple[float, float] | None
    radius: float | None
    settling: float | None


def expected_of(settings: DuelSettings) -> LiveTheory:
    """Find the circle of theory for some settings."""
    circle, settling = theory_of(settings), settling_time(settings)
    if not circle.exists:
        return LiveTheory(None, None, settling)
    theory = circle.distance_m, degrees(circle.headings_apart_rad)
    return LiveTheory(theory, circle.radius_evader_m, settling)
