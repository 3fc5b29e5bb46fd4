"""What the template says of a duel before it is played."""

from dataclasses import dataclass
from enum import StrEnum

from ..core.poses import Pose
from ..sim.person_motion import PersonMotion, Place
from ..sim.person_settings import PersonSettings
from .duel_circle import converged_at, no_circle_because, pace_of, theory_of
from .duel_settings import EVADER, PURSUER, DuelSettings
from .initial_poses import frames_of
from .template_approach import play_template

LONGEST = 600.0  # of a game of templates, in [s]
STEP = 0.05  # of its integration, in [s]


class ExpectedEnd(StrEnum):
    """How the template's game ends, as far as it is played."""

    CIRCLE = "circle"
    LATER = "later"  # on the circle, but not within the duration
    CONTACT = "contact"
    NO_CIRCLE = "no circle"


@dataclass(frozen=True, slots=True)
class Forecast:
    """What the template says of a duel.

    Attributes:
        expected: How its game ends.
        closest_m: Its closest approach, in [m].
        circle_since_s: Since when it is on its circle, in [s].
        words: The same, as a summary says it.
    """

    expected: ExpectedEnd
    closest_m: float
    circle_since_s: float | None
    words: str


def forecast(settings: DuelSettings) -> Forecast | None:
    """Play the templates of two robots: their unicycles, without bodies.

    The evader decides step by step, as the robot does, by all settings of
    its strategy; the pursuer steers at it at all times. Contact is expected
    where they come nearer than two bodies are sure not to overlap: near that
    distance it depends on how they are turned.

    Args:
        settings: What decides the duel, with the start that was drawn.

    Returns:
        The forecast; None where a person, a room or another strategy plays,
        of which the template says nothing.
    """
    start = settings.start
    drawn = (start.distance, start.pursuer_offset, start.evader_offset)
    if settings.pursuer != "robot" or not settings.is_of_the_paper:
        return None
    if None in drawn:
        return None
    chasing = settings.robot_of(PURSUER).gait
    pace = pace_of(chasing)
    steering = PersonSettings(
        "steer", chasing.speed * pace, chasing.gain * pace
    )

    def motion(pose: Pose, evader: Place) -> PersonMotion:
        return PersonMotion(steering, pose, evader)

    duration = min(settings.duration, LONGEST)
    played = play_template(
        motion,
        *frames_of(settings),
        settings.strategy,
        settings.robot_of(EVADER).gait,
        duration=duration,
        step=STEP,
    )
    circle, closest = theory_of(settings), played.closest_m
    since = converged_at(
        played.times, played.pursuer, played.evader, settings, circle
    )
    if closest < start.least:
        expected, words = (
            ExpectedEnd.CONTACT,
            f"contact likely: the template comes to {closest:.2f} m, bodies "
            f"are clear of each other from {start.least:.2f} m on",
        )
    elif not circle.exists:
        expected, words = ExpectedEnd.NO_CIRCLE, no_circle_because(settings)
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
