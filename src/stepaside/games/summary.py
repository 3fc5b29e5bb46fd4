"""The figures of a duel, beside what theory says."""

from collections.abc import Mapping
from math import degrees, isfinite, pi
from typing import Any

import numpy as np

from ..poses import Array, Pose
from ..unicycle.circling import Circle, find_circle
from ..unicycle.measure import fit_circle
from ..world.person_motion import Motion, template_approach
from .duel import DuelResult
from .settings import DuelSettings

DISTANCE_BAND = 0.05  # of theory's distance
ORIENTATION_BAND = 5.0  # of theory's angle, in [deg]


def theory_of(settings: DuelSettings) -> Circle:
    """Circle that the unicycles of a duel end on (level 0)."""
    gait, strategy = settings.gait, settings.strategy
    speeds = gait.speed, gait.speed
    gains = gait.gain, gait.gain
    if settings.pursuer == "person":
        # A person lives in real time, the gait in its own.
        pace = gait.path_interval / gait.step_duration
        person = settings.person
        speeds = person.speed, gait.speed * pace
        gains = person.gain, gait.gain * pace
    return find_circle(
        *speeds,
        *gains,
        strategy.angle,
        "saturated" if strategy.saturated else "proportional",
    )


def distance_over_time(arrays: Mapping[str, Array]) -> Array:
    """Distance between the torsos, in [m]. Shape (n,)."""
    apart = arrays["evader_torso"] - arrays["pursuer_torso"]
    distance: Array = np.hypot(apart[:, 0], apart[:, 1])
    return distance


def orientation_over_time(arrays: Mapping[str, Array]) -> Array:
    """Angle between the headings, in [rad], in [0, pi]. Shape (n,)."""
    apart = arrays["evader_torso"][:, 2] - arrays["pursuer_torso"][:, 2]
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
    arrays: Mapping[str, Array], settings: DuelSettings, theory: Circle
) -> float | None:
    """Time from which the robots stay on the circle, in [s].

    On the circle means: over a gait cycle the mean distance is within 5 %
    and the mean angle between the headings within 5 degrees of theory's,
    from then to the end, and for at least the last 5 s.
    """
    times = arrays["times_s"]
    if not theory.exists or len(times) < 3:
        return None
    period = 2.0 * settings.gait.step_duration
    distance = cycle_mean(distance_over_time(arrays), times, period)
    angle = np.degrees(
        cycle_mean(orientation_over_time(arrays), times, period)
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


def _closest_approach(settings: DuelSettings) -> float | None:
    """Closest approach of a person to the evader's template, in [m]."""
    start, gait = settings.start, settings.gait
    if settings.pursuer == "robot" or start.distance is None:
        return None
    pace = gait.path_interval / gait.step_duration
    return template_approach(
        lambda pose, evader: Motion(settings.person, pose, evader),
        Pose(0.0, 0.0, start.pursuer_offset or 0.0),
        Pose(start.distance, 0.0, pi + (start.evader_offset or 0.0)),
        speed=gait.speed * pace,
        gain=gait.gain * pace,
        angle=settings.strategy.angle,
        safety_radius=settings.strategy.safety_radius,
        duration=settings.duration,
    )


def summarise(result: DuelResult) -> dict[str, Any]:
    """Figures of a duel, ready for JSON.

    Radii, distance and orientation are those of the last third.
    """
    arrays, settings = result.arrays, result.settings
    theory = theory_of(settings)
    times = arrays["times_s"]
    tail = times >= times[-1] * 2.0 / 3.0
    last = {
        name: values[tail]
        for name, values in arrays.items()
        if len(values) == len(times)
    }
    start = settings.start
    plans = np.sort(result.planning_times) * 1e6
    summary: dict[str, Any] = {
        "outcome": result.outcome.value,
        "message": result.message,
        "seed": settings.seed,
        "duration_s": round(result.duration, 9),
        "start": {
            "distance_m": start.distance,
            "pursuer_offset_rad": start.pursuer_offset,
            "evader_offset_rad": start.evader_offset,
        },
        "triggered_at_s": result.triggered_at,
        "triggered_at_distance_m": result.triggered_distance,
        "distance_m": float(distance_over_time(last).mean()),
        "relative_orientation_deg": degrees(
            float(orientation_over_time(last).mean())
        ),
        "min_distance_m": result.min_distance,
        "converged_at_s": converged_at(arrays, settings, theory),
        "replans": result.replans,
        "max_com_velocity_jump_m_s": result.velocity_jump,
        "min_zmp_margin_m": result.zmp_margin,
        "theory": {
            "closest_approach_m": _closest_approach(settings),
            "exists": theory.exists,
            "radius_m": _number(theory.radius_evader_m),
            "distance_m": _number(theory.distance_m),
            "relative_orientation_deg": _number(
                degrees(theory.headings_apart_rad)
            ),
        },
        "plan_time_us": {
            "median": _number(float(np.median(plans))) if len(plans) else None,
            "p99": _number(float(np.quantile(plans, 0.99)))
            if len(plans)
            else None,
        },
        "real_time_factor": result.duration / max(result.wall_time, 1e-9),
    }
    for name in ("pursuer", "evader"):
        radius = fit_circle(last[f"{name}_com"][:, :2])[1]
        summary[name] = {"radius_m": _number(radius)}
    if result.sight is not None:
        for key, value in result.sight.items():
            if isinstance(value, dict):
                summary[key] |= value
            else:
                summary[key] = value
    return summary


def _number(value: float) -> float | None:
    return value if isfinite(value) else None
