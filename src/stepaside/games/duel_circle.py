"""Circle that a duel converges to in theory, and convergence of a run."""

from math import degrees, isfinite

import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array, wrap_angles
from ..planning import GaitSettings
from ..theory.unicycle.circles import Circle, find_circle
from .game_settings import GameSettings

DISTANCE_BAND = 0.05  # relative to the distance on the circle
ORIENTATION_BAND = 5.0  # around the orientation on the circle, in [deg]


def circle_of_theory(settings: GameSettings) -> Circle:
    """Compute the circle that the unicycles of a duel converge to.

    The circle does not exist where the game differs from that of the paper;
    :func:`missing_circle_reason` gives the reason.
    """
    settings = settings.resolved()
    if _differs(settings) is not None:
        return Circle(exists=False)
    circle = _circle_of(settings)
    if not circle.distance_m < settings.evader.evasion.release_distance:
        return Circle(exists=False)
    return circle


def missing_circle_reason(settings: GameSettings) -> str:
    """Return the reason why the unicycles of a duel reach no circle."""
    settings = settings.resolved()
    differs = _differs(settings)
    if differs is not None:
        return f"no circle: {differs}"
    circle = _circle_of(settings)
    if not circle.exists:
        return "no circle: unicycles of these speeds and gains have none"
    ends = settings.evader.evasion.release_distance
    return (
        f"no circle: evasion ends at {ends:g} "
        f"m, and the circle would be {circle.distance_m:.3f} m wide"
    )


def _differs(settings: GameSettings) -> str | None:
    """Return how a game differs from that of the paper, or None."""
    person = settings.pursuer.person
    if settings.room is not None:
        return "the paper has no rooms"
    if not settings.is_of_the_paper:
        return "the strategies are not the paper's"
    if settings.evader.evasion.trigger == "time":
        return "evasion begins and ends by the time to contact"
    if settings.pursuer.body == "person":
        if person.path != "steer" or isfinite(person.halt_after):
            return "the person does not keep steering at the evader"
        if person.feint_at > 0.0:
            return "the person feints"
        if person.turning_radius > 0.0:
            return "the turning radius of the person is limited"
        if person.backward:
            return "the person walks backward"
    return None


def _circle_of(settings: GameSettings) -> Circle:
    """Compute the circle of two unicycles that play without end."""
    strategy, gait = settings.evader.evasion, settings.evader.gait
    speeds = gait.speed, gait.speed
    gains = gait.gain, gait.gain
    chasing = settings.pursuer.gait
    if settings.pursuer.body == "person":
        # A person's speed is in real time, that of a gait in path time.
        pace = time_scale(gait)
        person = settings.pursuer.person
        speeds = person.speed, gait.speed * pace
        gains = person.gain, gait.gain * pace
    elif chasing != gait:
        # Path times of different gaits differ: compare in real time.
        paces = time_scale(chasing), time_scale(gait)
        speeds = chasing.speed * paces[0], gait.speed * paces[1]
        gains = chasing.gain * paces[0], gait.gain * paces[1]
    return find_circle(
        *speeds,
        *gains,
        strategy.angle,
        "saturated" if strategy.saturated else "proportional",
    )


def time_scale(gait: GaitSettings) -> float:
    """Return the path time that a gait walks per unit of real time."""
    return gait.path_interval / gait.step_duration


def last_third(times: Array) -> NDArray[np.bool_]:
    """Return the mask of the samples in the last third. Shape (n,)."""
    tail: NDArray[np.bool_] = times >= times[-1] * 2.0 / 3.0
    return tail


def distance_between(first: Array, second: Array) -> Array:
    """Return the distances, in [m], between poses. Shapes (n, 3), (n,)."""
    offset = second - first
    distance: Array = np.hypot(offset[:, 0], offset[:, 1])
    return distance


def angle_between(first: Array, second: Array) -> Array:
    """Return the angles between headings of poses (n, 3), in [0, pi]."""
    difference = second[:, 2] - first[:, 2]
    angle: Array = np.abs(wrap_angles(difference))
    return angle


def cycle_mean(values: Array, times: Array, period: float) -> Array:
    """Average over a sliding gait cycle, which removes the sway.

    The times are evenly spaced; the period is that of two steps, in [s].
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


def whole_cycles(values: Array, times: Array, period: float) -> Array:
    """Return :func:`cycle_mean`, with NaN where the cycle is not whole."""
    mean = cycle_mean(values, times, period).astype(float)
    if len(times) < 3:
        return np.full(len(times), np.nan)
    half = round(period / float(times[1] - times[0])) // 2
    mean[:half] = mean[max(len(mean) - half, 0) :] = np.nan
    return mean


def convergence_time(
    times: Array,
    pursuer: Array,
    evader: Array,
    settings: GameSettings,
    theory: Circle,
) -> float | None:
    """Find the time from which the robots stay on the circle.

    The robots are on the circle if, averaged over a gait cycle, their
    distance is within 5 % and the angle between their headings within 5
    degrees of the values on the circle, from then to the end, and for at
    least the last 5 s.

    Returns:
        Time, in [s]; None if the robots do not converge to the circle.
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
    # The last half cycle has truncated windows: use the last complete one.
    half = round(period / float(times[1] - times[0])) // 2
    if 0 < half < len(off):
        off[-half:] = off[-half - 1]
    last = np.flatnonzero(off)
    start = 0 if last.size == 0 else int(last[-1]) + 1
    if start >= len(times):
        return None
    since = float(times[start])
    return since if times[-1] - since >= 5.0 else None
