"""Theory of a duel: the game of its templates, and its circle."""

from collections import deque
from collections.abc import Mapping
from dataclasses import replace
from math import degrees, hypot, pi

from ..core.poses import Pose
from ..robots.description import load_robot
from ..sim.person_motion import PersonMotion, Place, template_approach
from ..sim.person_settings import PersonSettings
from ..strategies.registry import OBJECT
from ..theory.unicycle.unicycle_game import Unicycle
from .duel_circle import (
    circle_of_theory,
    convergence_time,
    missing_circle_reason,
    time_scale,
)
from .floor_games import play_template, strategy_of
from .game_settings import GameSettings
from .player_settings import EVADER, PURSUER
from .run import Run
from .summary import Summary, TheorySummary

MAX_DURATION = 600.0  # of a game of templates, in [s]
STEP = 0.05  # of its integration, in [s]
CIRCLE, LATER, CONTACT, NO_CIRCLE = "circle", "later", "contact", "no circle"

_latest: deque[tuple[GameSettings, TheorySummary]] = deque(maxlen=1)


def forecast(settings: GameSettings) -> TheorySummary:
    """Return the theory of a duel, with the initial poses filled in.

    Of two robots with the strategies of the paper the game of their unicycle
    templates is played: the evader decides step by step, as the robot does,
    with all settings of its strategy; the pursuer steers towards it at all
    times. Contact is expected if the templates come closer than
    ``start.least``, the distance at which bodies cannot overlap: below it,
    contact depends on their headings.
    """
    # A duel needs its forecast twice: before it and in its summary.
    if not _latest or _latest[-1][0] != settings:
        _latest.append((settings, _forecast(settings)))
    return _latest[-1][1]


def _forecast(settings: GameSettings) -> TheorySummary:
    circle, found = circle_of_theory(settings), TheorySummary()
    if circle.exists:
        found = TheorySummary(
            radius_m=circle.radius_evader_m,
            pursuer_radius_m=circle.radius_pursuer_m,
            distance_m=circle.distance_m,
            relative_orientation_deg=degrees(circle.headings_apart_rad),
        )
    else:
        found = TheorySummary(words=missing_circle_reason(settings))
    if settings.pursuer.body == "robot":
        if not settings.is_of_the_paper or settings.evader.pose is None:
            return found
        return _played(settings, found)
    return replace(found, min_distance_m=_approach_of_person(settings))


def _played(settings: GameSettings, found: TheorySummary) -> TheorySummary:
    """Play the templates of a duel of two robots."""
    least = settings.start.least
    chasing = settings.pursuer.gait
    pace = time_scale(chasing)
    steering = PersonSettings(
        "steer", chasing.speed * pace, chasing.gain * pace
    )

    def motion(pose: Pose, evader: Place) -> PersonMotion:
        return PersonMotion(steering, pose, evader)

    duration = min(settings.duration, MAX_DURATION)
    pursuer, evader = (Pose(*own.start) for own in settings.players)
    played = play_template(
        motion,
        pursuer,
        evader,
        settings.evader.evasion,
        settings.evader.gait,
        duration=duration,
        step=STEP,
    )
    paths = played.times, played.pursuer, played.evader
    since = convergence_time(*paths, settings, circle_of_theory(settings))
    closest = played.closest_distance
    if closest < least:
        expected, words = (
            CONTACT,
            f"contact likely: closest approach of the templates "
            f"{closest:.2f} m, bodies are clear of each other from "
            f"{least:.2f} m on",
        )
    elif found.radius_m is None:
        expected, words = NO_CIRCLE, found.words or ""
    elif since is None:
        expected, words = LATER, f"the circle, after {duration:.0f} s"
    else:
        expected, words = CIRCLE, f"the circle, from {since:.1f} s on"
    return replace(
        found,
        expected=expected,
        words=words,
        circle_since_s=since,
        min_distance_m=closest,
    )


def _approach_of_person(settings: GameSettings) -> float | None:
    """Return the closest approach of a person to the evader's template [m].

    None where the template is no model of the game.
    """
    start, own = settings.start, settings.evader
    gait, legs, strategy = own.gait, own.legs, own.evasion
    person = settings.pursuer.person
    if start.distance is None or own.strategy.startswith(OBJECT):
        return None
    if not (settings.is_of_the_paper or legs.walks):
        return None
    initial = (
        lambda pose, evader: PersonMotion(person, pose, evader),
        Pose(0.0, 0.0, start.pursuer_offset or 0.0),
        Pose(start.distance, 0.0, pi + (start.evader_offset or 0.0)),
    )
    if not legs.walks and strategy.trigger != "time":
        pace = time_scale(gait)
        return template_approach(
            *initial,
            unicycle=Unicycle(gait.speed * pace, gait.gain * pace),
            angle=strategy.angle,
            safety_radius=strategy.safety_radius,
            duration=settings.duration,
        )
    velocities = None
    if legs.walks:
        from ..locomotion.policy.policy_legs import load_legs

        robot, tick = load_robot(own.robot), settings.physics.tick
        velocities = load_legs(legs, robot, tick=tick).velocities
    return play_template(
        *initial,
        strategy_of(own),
        gait,
        duration=settings.duration,
        velocities=velocities,
    ).closest_distance


def evaluate_duel(
    run: Run, moves: Mapping[str, tuple[float, Mapping[str, Pose]]]
) -> Summary:
    """Return the summary of a duel with trigger, convergence and theory.

    Of each player the time and the poses of all are given at which it first
    moved.
    """
    settings, theory = run.settings, forecast(run.settings)
    paths = run.pursuer.unicycle, run.evader.unicycle
    circle = circle_of_theory(settings)
    converged = convergence_time(run.times, *paths, settings, circle)
    if theory.expected == CONTACT and converged is None:
        theory = TheorySummary(
            *(theory.expected, theory.words),
            *(theory.circle_since_s, theory.min_distance_m),
        )
    triggered, apart = None, None
    if EVADER in moves:
        triggered, poses = moves[EVADER]
        (x, y, _), (u, v, _) = poses[PURSUER], poses[EVADER]
        apart = hypot(u - x, v - y)
    return replace(
        run.summary,
        triggered_at_s=triggered,
        triggered_at_distance_m=apart,
        converged_at_s=converged,
        theory=theory,
    )
