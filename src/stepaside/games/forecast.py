"""Forecast of a duel by its templates."""

from collections import deque
from dataclasses import dataclass
from enum import StrEnum

from ..core.poses import Pose
from ..sim.person_motion import PersonMotion, Place
from ..sim.person_settings import PersonSettings
from .duel_circle import (
    circle_of_theory,
    convergence_time,
    missing_circle_reason,
    time_scale,
)
from .duel_settings import EVADER, PURSUER, DuelSettings
from .floor_games import play_template
from .initial_poses import initial_poses

MAX_DURATION = 600.0  # of a game of templates, in [s]
STEP = 0.05  # of its integration, in [s]


class ExpectedEnd(StrEnum):
    """How the game of the templates ends within the duration."""

    CIRCLE = "circle"
    LATER = "later"  # on the circle, but after the duration
    CONTACT = "contact"
    NO_CIRCLE = "no circle"


@dataclass(frozen=True, slots=True)
class Forecast:
    """Forecast of a duel.

    Attributes:
        expected: How the game of the templates ends.
        closest_m: Closest approach of the templates, in [m].
        circle_since_s: Time from which they are on the circle, in [s].
        words: The forecast as text.
    """

    expected: ExpectedEnd
    closest_m: float
    circle_since_s: float | None
    words: str


def forecast(settings: DuelSettings) -> Forecast | None:
    """Play the game of the unicycle templates of two robots.

    The evader decides step by step, as the robot does, with all settings of
    its strategy; the pursuer steers towards it at all times. Contact is
    expected if the templates come closer than ``start.least``, the distance
    at which bodies cannot overlap: below it, contact depends on their
    headings.

    Returns:
        The forecast; None with a person, a room or another strategy, for
        which the templates are no model.
    """
    start = settings.start
    drawn = (start.distance, start.pursuer_offset, start.evader_offset)
    if settings.pursuer != "robot" or not settings.is_of_the_paper:
        return None
    if None in drawn:
        return None
    # A duel needs its forecast twice: before it and in its summary.
    if _latest and _latest[-1][0] == settings:
        return _latest[-1][1]
    found = _play(settings)
    _latest.append((settings, found))
    return found


_latest: deque[tuple[DuelSettings, Forecast]] = deque(maxlen=1)


def _play(settings: DuelSettings) -> Forecast:
    """Play the templates of a duel of two robots."""
    start = settings.start
    chasing = settings.robot_of(PURSUER).gait
    pace = time_scale(chasing)
    steering = PersonSettings(
        "steer", chasing.speed * pace, chasing.gain * pace
    )

    def motion(pose: Pose, evader: Place) -> PersonMotion:
        return PersonMotion(steering, pose, evader)

    duration = min(settings.duration, MAX_DURATION)
    played = play_template(
        motion,
        *initial_poses(settings),
        settings.strategy,
        settings.robot_of(EVADER).gait,
        duration=duration,
        step=STEP,
    )
    circle, closest = circle_of_theory(settings), played.closest_distance
    since = convergence_time(
        played.times, played.pursuer, played.evader, settings, circle
    )
    if closest < start.least:
        expected, words = (
            ExpectedEnd.CONTACT,
            f"contact likely: closest approach of the templates "
            f"{closest:.2f} m, bodies are clear of each other from "
            f"{start.least:.2f} m on",
        )
    elif not circle.exists:
        expected, words = (
            ExpectedEnd.NO_CIRCLE,
            missing_circle_reason(settings),
        )
    elif since is None:
        expected, words = (
            ExpectedEnd.LATER,
            f"the circle, after {duration:.0f} s",
        )
    else:
        expected, words = (
            ExpectedEnd.CIRCLE,
            f"the circle, from {since:.1f} s on",
        )
    return Forecast(expected, closest, since, words)
