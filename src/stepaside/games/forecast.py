"""Theory of a duel: the game of its templates, and its circle."""

from collections import deque
from collections.abc import Mapping
from dataclasses import replace
from math import degrees, hypot

from ..core.poses import Pose
from ..robots.description import load_robot
from ..strategies.registry import OBJECT
from .duel_circle import (
    circle_of_theory,
    convergence_time,
    distance_between,
    missing_circle_reason,
)
from .floor_games import floor_of, play_floor
from .game import GameRules
from .game_settings import GameSettings
from .player_settings import EVADER, PURSUER
from .run import Run
from .summary import Summary, TheorySummary

MAX_DURATION = 600.0  # of a game of templates, in [s]
STEP = 0.05  # between its samples, in [s]
SHORT = 0.01  # between decisions of a person, in [s]
CIRCLE, LATER, CONTACT, NO_CIRCLE = "circle", "later", "contact", "no circle"

_latest: deque[tuple[GameSettings, TheorySummary]] = deque(maxlen=1)


def forecast(settings: GameSettings) -> TheorySummary:
    """Return the theory of a duel, with the initial poses filled in.

    Of two robots with the strategies of the paper the game of their unicycle
    templates is played: they decide step by step, as the robots do. Contact
    is expected if the templates come closer than ``start.least``, the
    distance at which bodies cannot overlap: below it, contact depends on
    their headings.
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
    duration = min(settings.duration, MAX_DURATION)
    world = floor_of(settings, period=STEP)
    _, recorder = play_floor(world, GameRules(duration), STEP)
    poses = recorder.poses()
    paths = recorder.times, poses[PURSUER], poses[EVADER]
    since = convergence_time(*paths, settings, circle_of_theory(settings))
    closest = float(distance_between(*paths[1:]).min())
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
    own, velocities = settings.evader, None
    if own.strategy.startswith(OBJECT):
        return None
    if own.legs.walks:
        from ..locomotion.policy.policy_legs import load_legs

        robot, tick = load_robot(own.robot), settings.physics.tick
        velocities = load_legs(own.legs, robot, tick=tick).velocities
    elif not settings.is_of_the_paper:
        return None
    world = floor_of(settings, period=SHORT, velocities=velocities)
    rules = GameRules(settings.duration, identities=settings.identities)
    game, _ = play_floor(world, rules)
    return game.closest[EVADER, PURSUER]


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
