"""Theory of a duel: its circle, the game of its templates, convergence."""

from dataclasses import replace
from math import degrees, isfinite
from typing import Any

import numpy as np

from ..core.poses import Array
from ..planning import GaitSettings
from ..theory.unicycle.circles import Circle, find_circle
from .floor_games import floor_of, play_floor
from .game import GameRules
from .game_settings import GameSettings
from .player_settings import EVADER, PURSUER
from .run import Run
from .summary import TheorySummary
from .trajectory import angle_between, distance_between, whole_cycles

MAX_DURATION = 600.0  # of a game of templates, in [s]
STEP = 0.05  # between its samples, in [s]
DISTANCE_BAND = 0.05  # relative to the distance on the circle
ORIENTATION_BAND = 5.0  # around the orientation on the circle, in [deg]
LEAST_TIME = 5.0  # on the circle at the end, in [s]


def circle_of_theory(settings: GameSettings) -> Circle:
    """Compute the circle that the unicycles of a duel converge to.

    It does not exist where the game differs from that of the paper. Its rates
    are in real time.
    """
    return circle_or_reason(settings)[0]


def circle_or_reason(settings: GameSettings) -> tuple[Circle, str]:
    """Return the circle, and why there is none; empty if there is one."""
    settings = settings.resolved()
    strategy, circle = settings.evader.evasion, _circle_of(settings)
    ends, person = strategy.release_distance, settings.pursuer.person
    steers = person.path == "steer" and not isfinite(person.halt_after)
    walks = settings.pursuer.body == "person"
    reasons = {
        "the paper has no rooms": settings.room is not None,
        "the strategies are not the paper's": not settings.is_of_the_paper,
        "evasion begins and ends by the time to contact": (
            strategy.trigger == "time"
        ),
        "the person does not keep steering at the evader": (
            walks and not steers
        ),
        "the person feints": walks and person.feint_at > 0.0,
        "the turning radius of the person is limited": (
            walks and person.turning_radius > 0.0
        ),
        "the person walks backward": walks and person.backward,
        "unicycles of these speeds and gains have none": not circle.exists,
        f"evasion ends at {ends:g} m, and the circle would be "
        f"{circle.distance_m:.3f} m wide": not circle.distance_m < ends,
    }
    found = (f"no circle: {why}" for why, holds in reasons.items() if holds)
    reason = next(found, "")
    return Circle(exists=False) if reason else circle, reason


def _circle_of(settings: GameSettings) -> Circle:
    """Compute the circle of two unicycles that play without end."""
    strategy, gait = settings.evader.evasion, settings.evader.gait
    pace, person = time_scale(gait), settings.pursuer.person
    chasing = settings.pursuer.gait
    # A person's speed is in real time, that of a gait in path time.
    scale = time_scale(chasing)
    chase = scale * chasing.speed, scale * chasing.gain
    if settings.pursuer.body == "person":
        chase = person.speed, person.gain
    return find_circle(
        *(chase[0], pace * gait.speed, chase[1], pace * gait.gain),
        strategy.angle,
        "saturated" if strategy.saturated else "proportional",
    )


def time_scale(gait: GaitSettings) -> float:
    """Return the path time that a gait walks per unit of real time."""
    return gait.path_interval / gait.step_duration


def convergence_time(
    times: Array,
    pursuer: Array,
    evader: Array,
    settings: GameSettings,
    theory: Circle,
) -> float | None:
    """Find the time [s] from which the robots stay on the circle, if they do.

    The robots are on the circle if, averaged over a gait cycle, their
    distance is within 5 % and the angle between their headings within 5
    degrees of the values on the circle, from then to the end, and for at
    least the last 5 s.
    """
    if not theory.exists:
        return None
    distance, angle = (
        whole_cycles(values, times, settings.cycle)
        for values in (
            distance_between(pursuer, evader),
            np.degrees(angle_between(pursuer, evader)),
        )
    )
    off = np.abs(distance / theory.distance_m - 1.0) > DISTANCE_BAND
    wanted = degrees(theory.headings_apart_rad)
    off |= np.abs(angle - wanted) > ORIENTATION_BAND
    on = times[np.append(np.flatnonzero(off)[-1:] + 1, 0)[0] :]
    return float(on[0]) if len(on) and np.ptp(on) >= LEAST_TIME else None


def forecast(settings: GameSettings) -> TheorySummary:
    """Return the theory of a duel, with the initial poses filled in.

    Of two robots with the strategies of the paper the game of their unicycle
    templates is played: they decide step by step, as the robots do. Contact
    is expected if the templates come closer than ``start.least``, the
    distance at which bodies cannot overlap: below it, contact depends on
    their headings.
    """
    circle, reason = circle_or_reason(settings)
    found = TheorySummary(words=reason)
    if circle.exists:
        found = TheorySummary(
            radius_m=circle.radius_evader_m,
            radius_pursuer_m=circle.radius_pursuer_m,
            distance_m=circle.distance_m,
            relative_orientation_deg=degrees(circle.headings_apart_rad),
        )
    if settings.pursuer.body != "robot":
        from .person_forecast import approach_of_person

        return replace(found, min_distance_m=approach_of_person(settings))
    if not settings.is_of_the_paper or settings.evader.pose is None:
        return found
    least = settings.start.least
    duration = min(settings.duration, MAX_DURATION)
    world = floor_of(settings, period=STEP)
    _, recorder = play_floor(world, GameRules(duration), STEP)
    poses = recorder.poses()
    paths = recorder.times, poses[PURSUER], poses[EVADER]
    since = convergence_time(*paths, settings, circle)
    closest = float(distance_between(*paths[1:]).min())
    expected, words = "circle", f"the circle, from {since or 0.0:.1f} s on"
    if closest < least:
        expected, words = (
            "contact",
            f"contact likely: closest approach of the templates "
            f"{closest:.2f} m, bodies are clear of each other from "
            f"{least:.2f} m on",
        )
    elif not circle.exists:
        expected, words = "no circle", found.words or ""
    elif since is None:
        expected, words = "later", f"the circle, not within {duration:.0f} s"
    return replace(
        found,
        expected=expected,
        words=words,
        circle_since_s=since,
        min_distance_m=closest,
    )


def evaluate_duel(run: Run, triggered: float | None) -> dict[str, Any]:
    """Return trigger, convergence and theory of a duel, by name.

    The evader first moved at a time, in [s].
    """
    settings, theory = run.settings, forecast(run.settings)
    paths = run.pursuer.unicycle, run.evader.unicycle
    circle = circle_of_theory(settings)
    converged = convergence_time(run.times, *paths, settings, circle)
    if theory.expected == "contact" and converged is None:
        unknown = ("radius_m", "radius_pursuer_m", "distance_m")
        theory = replace(
            theory, relative_orientation_deg=None, **dict.fromkeys(unknown)
        )
    apart = None
    if triggered is not None:
        apart = float(np.interp(triggered, run.times, run.distance))
    return {
        "triggered_at_s": triggered,
        "triggered_at_distance_m": apart,
        "converged_at_s": converged,
        "theory": theory,
    }
