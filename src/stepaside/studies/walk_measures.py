"""Measures of steps, plans, references and tilt of an instrumented duel."""

from math import acos, degrees, inf, nan
from typing import NamedTuple

import numpy as np

from ..core.poses import Array
from ..games.duel_settings import PLAYERS
from ..planning import GaitSettings
from .instrumented_duel import InstrumentedDuel, WalkedPlan

CONTACT_LOAD = 1.0  # load from which a foot is in contact, in [N]
SWING_FRACTION = 0.35  # least swing, as a fraction of the single support
# Time before lift-off at which the plan already unloads a foot, in [s].
UNLOADING = 0.03
FIT_TICKS = 6  # ticks on either side of a replan for the polynomial fit


def swing_intervals(ticks: Array, load: Array, single_support: float) -> Array:
    """Return the swings of a foot, from its load.

    Shorter times without load are bounces at landing or lift-off.

    Args:
        ticks: Times, in [s]. Shape (n,).
        load: Load of the foot, in [N]. Shape (n,).
        single_support: Planned duration of a swing, in [s].

    Returns:
        Rows (lift-off, landing), in [s]. Shape (m, 2).
    """
    on = load > CONTACT_LOAD
    least = SWING_FRACTION * single_support
    changes = np.flatnonzero(on[1:] != on[:-1]) + 1
    rows = [
        (ticks[a], ticks[b])
        for a, b in zip(changes, changes[1:], strict=False)
        if not on[a] and ticks[b] - ticks[a] > least
    ]
    return np.array(rows, dtype=np.float64).reshape(-1, 2)


def step_times(duel: InstrumentedDuel, name: str) -> list[float]:
    """Return the times between landings of either foot, in [s], or [inf]."""
    feet = duel.loads[name].T
    single = duel.settings.gait.single_support
    landings = np.concatenate(
        [swing_intervals(duel.ticks, load, single)[:, 1] for load in feet]
    )
    intervals: list[float] = np.diff(np.sort(landings)).tolist()
    return intervals or [inf]


def replanning_support(
    duel: InstrumentedDuel, name: str
) -> tuple[float, float]:
    """Measure the contact state at which plans are replaced.

    At the end of double support the plan completely unloads the foot that
    is about to swing: a foot unloaded just before still counts as in
    contact.

    Returns:
        Fraction of the plans that follow the previous one after exactly one
        landing, while both feet are in contact; and the longest time from a
        plan to the next lift-off, in [s]. NaN without plans.
    """
    single = duel.settings.gait.single_support
    feet = duel.loads[name].T
    flights = np.concatenate(
        [swing_intervals(duel.ticks, load, single) for load in feet]
    )
    lifts, landings = np.sort(flights[:, 0]), np.sort(flights[:, 1])
    sent = np.array([plan.first_sent_time for plan in duel.plans[name]])
    if not len(lifts):
        return nan, nan
    # A plan without a later lift-off cannot be evaluated.
    sent = sent[sent <= lifts[-1] + UNLOADING]
    if len(sent) < 2:
        return nan, nan
    in_air = (flights[:, 0] + UNLOADING <= sent[1:, None]) & (
        sent[1:, None] < flights[:, 1]
    )
    landed = np.diff(np.searchsorted(landings, sent))
    good = (landed == 1) & ~in_air.any(axis=1)
    next_lifts = lifts[np.searchsorted(lifts, sent[1:] - UNLOADING)]
    return float(good.mean()), float((next_lifts - sent[1:]).max())


def walked_arc_fraction(
    plans: tuple[WalkedPlan, ...], gait: GaitSettings
) -> float:
    """Return the largest fraction of its arc that a plan was walked.

    The gait walks along the path slower than the template drives it. NaN
    for fewer than two plans.
    """
    time_scale = gait.path_interval / gait.step_duration
    fractions = [
        (
            later.first_sent_time
            - plan.first_sent_time
            - plan.from_standing * gait.start_support
        )
        * time_scale
        * gait.gain
        for plan, later in zip(plans, plans[1:], strict=False)
    ]
    return max(fractions, default=nan)


class ReferenceJump(NamedTuple):
    """Jump of a reference.

    Attributes:
        position: Jump of the position, in [m].
        velocity: Jump of the velocity, in [m/s].
    """

    position: float
    velocity: float


def reference_jumps(duel: InstrumentedDuel, name: str) -> ReferenceJump:
    """Return the largest jump of the CoM reference at a replan.

    Position and velocity on either side are those of polynomials through
    the references of the last ticks before and of the first ticks after the
    replan. NaN without plans.
    """
    sent, ticks = duel.references[name], duel.ticks
    jumps = []
    for plan in duel.plans[name]:
        first = int(np.searchsorted(ticks, plan.start_time - 1e-9))
        if FIT_TICKS <= first <= len(ticks) - FIT_TICKS:
            start = plan.start_time
            before = _extrapolate(ticks, sent, start, first - FIT_TICKS)
            after = _extrapolate(ticks, sent, start, first)
            jumps.append(np.abs(after - before).max(axis=1))
    if not jumps:
        return ReferenceJump(nan, nan)
    position, velocity = np.max(jumps, axis=0).tolist()
    return ReferenceJump(position, velocity)


def _extrapolate(
    ticks: Array, sent: Array, instant: float, first: int
) -> Array:
    """Return position and velocity at an instant by a polynomial. (2, 2)."""
    period = float(ticks[1] - ticks[0])
    rows = slice(first, first + FIT_TICKS)
    powers = np.vander((ticks[rows] - instant) / period, increasing=True)
    values: Array = np.array(np.linalg.solve(powers, sent[rows])[:2])
    values[1] /= period
    return values


def walking_speed(duel: InstrumentedDuel, name: str) -> float:
    """Return the speed over the last third, in [m/s]; NaN if too short.

    The chords span a gait cycle, so that sway does not contribute.
    """
    times = duel.times
    period = float(times[1] - times[0])
    cycle = round(2.0 * duel.settings.gait.step_duration / period)
    positions = duel.tracks[name].unicycle[len(times) * 2 // 3 :, :2]
    if len(positions) <= cycle:
        return nan
    chords = np.hypot(*(positions[cycle:] - positions[:-cycle]).T)
    return float(chords.mean() / (cycle * period))


def distance_walked(duel: InstrumentedDuel, name: str) -> float:
    """Return the path length of the torso by chords of a cycle, in [m]."""
    times = duel.times
    period = float(times[1] - times[0])
    cycle = round(2.0 * duel.settings.gait.step_duration / period)
    positions = duel.tracks[name].torso[:, :2]
    corners = np.vstack([positions[::cycle], positions[-1:]])
    return float(np.hypot(*np.diff(corners, axis=0).T).sum())


def largest_tilt(duel: InstrumentedDuel) -> float:
    """Return the largest angle of a torso from the vertical, in [deg]."""
    postures = [duel.tracks[name].qpos for name in PLAYERS]
    upward = [
        1.0 - 2.0 * (qpos[:, 4:6] ** 2).sum(axis=1)
        for qpos in postures
        if qpos is not None
    ]
    return degrees(acos(max(-1.0, min(1.0, float(np.min(upward))))))


def mean_foot_slip(duel: InstrumentedDuel) -> float:
    """Return the mean slip of a foot from landing to lift-off, in [m]."""
    slips = []
    for name in PLAYERS:
        for side, load in enumerate(duel.loads[name].T):
            single = duel.settings.gait.single_support
            flights = swing_intervals(duel.ticks, load, single)
            feet = duel.feet[name][:, side]
            landed = np.searchsorted(duel.ticks, flights[:-1, 1])
            lifted = np.searchsorted(duel.ticks, flights[1:, 0]) - 1
            slips.append(np.hypot(*(feet[lifted] - feet[landed]).T))
    distances = np.concatenate(slips)
    return float(distances.mean()) if len(distances) else nan
