"""The circle of a duel: theory's, and when the players are on it."""

from math import degrees, isfinite

import numpy as np

from ..core.poses import Array
from ..planning import GaitSettings
from ..theory.unicycle.circle_equations import Circle, find_circle
from .duel_settings import EVADER, PURSUER, DuelSettings

DISTANCE_BAND = 0.05  # of theory's distance
ORIENTATION_BAND = 5.0  # of theory's angle, in [deg]


def theory_of(settings: DuelSettings) -> Circle:
    """Circle that the unicycles of a duel end on (level 0).

    There is none where the game is another one; :func:`no_circle_because`
    says why.
    """
    if _differs(settings) is not None:
        return Circle(exists=False)
    circle = _circle_of(settings)
    if not circle.distance_m < settings.strategy.release_distance:
        return Circle(exists=False)
    return circle


def no_circle_because(settings: DuelSettings) -> str:
    """Say why the unicycles of a duel end on no circle.

    Args:
        settings: Of a duel of which :func:`theory_of` knows no circle.
    """
    differs = _differs(settings)
    if differs is not None:
        return f"no circle: {differs}"
    circle = _circle_of(settings)
    if not circle.exists:
        return "no circle: unicycles of these speeds and gains have none"
    return (
        f"no circle: evasion ends at {settings.strategy.release_distance:g} "
        f"m, and the circle would be {circle.distance_m:.3f} m wide"
    )


def _differs(settings: DuelSettings) -> str | None:
    """What makes a game another one than the paper's, or None."""
    person = settings.person
    if settings.room.plan is not None:
        return "the paper has no rooms"
    if not settings.is_of_the_paper:
        return "the strategies are not the paper's"
    if settings.strategy.trigger == "time":
        return "evasion begins and ends by the time to contact"
    if settings.pursuer == "person":
        if person.path != "steer" or isfinite(person.halt_after):
            return "the person does not keep steering at the evader"
        if person.backward:
            return "the person walks backward"
    return None


def _circle_of(settings: DuelSettings) -> Circle:
    """Circle of two unicycles that never cease to play."""
    strategy = settings.strategy
    gait = settings.robot_of(EVADER).gait
    speeds = gait.speed, gait.speed
    gains = gait.gain, gait.gain
    chasing = settings.robot_of(PURSUER).gait
    if settings.pursuer == "person":
        # A person lives in real time, the gait in its own.
        pace = pace_of(gait)
        person = settings.person
        speeds = person.speed, gait.speed * pace
        gains = person.gain, gait.gain * pace
    elif chasing != gait:
        # So do two gaits that differ.
        paces = pace_of(chasing), pace_of(gait)
        speeds = chasing.speed * paces[0], gait.speed * paces[1]
        gains = chasing.gain * paces[0], gait.gain * paces[1]
    return find_circle(
        *speeds,
        *gains,
        strategy.angle,
        "saturated" if strategy.saturated else "proportional",
    )


def pace_of(gait: GaitSettings) -> float:
    """How much of its path time a gait walks in a time, as a ratio."""
    return gait.path_interval / gait.step_duration


def distance_between(first: Array, second: Array) -> Array:
    """Distance between two players over time, in [m]. Shape (n,).

    Args:
        first: Place and heading of one, in [m] and [rad]. Shape (n, 3).
        second: Those of the other.
    """
    apart = second - first
    distance: Array = np.hypot(apart[:, 0], apart[:, 1])
    return distance


def angle_between(first: Array, second: Array) -> Array:
    """Angle between two headings over time, in [0, pi] [rad]. Shape (n,).

    Args:
        first: Place and heading of one, in [m] and [rad]. Shape (n, 3).
        second: Those of the other.
    """
    apart = second[:, 2] - first[:, 2]
    angle: Array = np.abs((apart + np.pi) % (2.0 * np.pi) - np.pi)
    return angle


def cycle_mean(values: Array, times: Array, period: float) -> Array:
    """Mean over a sliding gait cycle, which takes the sway out.

    Args:
        values: Samples. Shape (n,).
        times: Their times, evenly spaced, in [s]. Shape (n,).
        period: Duration of a gait cycle (two steps), in [s].
    """
    if len(times) < 3:
        return values
    width = max(1, round(period / float(times[1] - times[0])))
    if width >= len(values):
        return np.full_like(values, values.mean())
    kernel = np.ones(width)
    weight = np.convolve(np.ones_like(values), kernel, mode="same")
    mean: Array = np.convolve(values, kernel, mode="same") / weight
    return mean


def converged_at(
    times: Array,
    pursuer: Array,
    evader: Array,
    settings: DuelSettings,
    theory: Circle,
) -> float | None:
    """Time from which the robots stay on the circle, in [s].

    On the circle means: over a gait cycle the mean distance is within 5 %
    and the mean angle between the headings within 5 degrees of theory's,
    from then to the end, and for at least the last 5 s.

    Args:
        times: Of the samples, in [s]. Shape (n,).
        pursuer: Its place and heading, in [m] and [rad]. Shape (n, 3).
        evader: Those of the evader.
        settings: What decided the duel.
        theory: Circle of its unicycles.
    """
    if not theory.exists or len(times) < 3:
        return None
    period = settings.cycle
    distance = cycle_mean(distance_between(pursuer, evader), times, period)
    angle = np.degrees(
        cycle_mean(angle_between(pursuer, evader), times, period)
    )
    off = (
        np.abs(distance - theory.distance_m)
        > DISTANCE_BAND * theory.distance_m
    ) | (np.abs(angle - degrees(theory.headings_apart_rad)) > ORIENTATION_BAND)
    # A window that the end cuts is no gait cycle: the last whole one counts.
    half = round(period / float(times[1] - times[0])) // 2
    if 0 < half < len(off):
        off[-half:] = off[-half - 1]
    last = np.flatnonzero(off)
    start = 0 if last.size == 0 else int(last[-1]) + 1
    if start >= len(times):
        return None
    since = float(times[start])
    return since if times[-1] - since >= 5.0 else None
