"""Measures of steps, plans, references and tilt of an instrumented duel."""

from math import acos, degrees, inf, nan

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
    changes = np.flatnonzero(on[1:] != on[:-1]) + 1
    pairs = np.stack([changes[:-1], changes[1:]], axis=-1)
    swings: Array = ticks[pairs[~on[pairs[:, 0]]]]
    long = np.ptp(swings, axis=1) > SWING_FRACTION * single_support
    found: Array = swings[long]
    return found


def _swings(duel: InstrumentedDuel, name: str) -> list[Array]:
    """Return the swings of left and right foot."""
    single = duel.run.settings.gait.single_support
    return [
        swing_intervals(duel.ticks, load, single)
        for load in duel.loads[name].T
    ]


def step_times(duel: InstrumentedDuel, name: str) -> list[float]:
    """Return the times between landings of either foot, in [s], or [inf]."""
    landings = np.sort(np.concatenate(_swings(duel, name))[:, 1])
    intervals: list[float] = np.diff(landings).tolist()
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
    flights = np.concatenate(_swings(duel, name))
    lifts, landings = np.sort(flights, axis=0).T
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
    times = [
        later.first_sent_time
        - plan.first_sent_time
        - plan.from_standing * gait.start_support
        for plan, later in zip(plans, plans[1:], strict=False)
    ]
    time_scale = gait.path_interval / gait.step_duration
    return max(times, default=nan) * time_scale * gait.gain


def reference_jumps(duel: InstrumentedDuel, name: str) -> tuple[float, float]:
    """Return the largest jump of the CoM reference at a replan.

    Position and velocity on either side are those of polynomials through
    the references of the last ticks before and of the first ticks after the
    replan.

    Returns:
        Jumps of position, in [m], and velocity, in [m/s]; NaN without plans.
    """
    sent, ticks = duel.references[name], duel.ticks
    jumps = []
    for plan in duel.plans[name]:
        first = int(np.searchsorted(ticks, plan.start_time - 1e-9))
        if FIT_TICKS <= first <= len(ticks) - FIT_TICKS:
            before, after = (
                _extrapolate(ticks, sent, plan.start_time, number)
                for number in (first - FIT_TICKS, first)
            )
            jumps.append(np.abs(after - before).max(axis=1))
    if not jumps:
        return nan, nan
    position, velocity = np.max(jumps, axis=0).tolist()
    return position, velocity


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


def _samples_of_cycle(duel: InstrumentedDuel) -> int:
    """Return the number of samples in a gait cycle.

    Chords over a cycle have no sway.
    """
    times = duel.run.times
    return round(float(duel.run.settings.cycle) / float(times[1] - times[0]))


def walking_speed(duel: InstrumentedDuel, name: str) -> float:
    """Return the speed over the last third, in [m/s]; NaN if too short."""
    times, cycle = duel.run.times, _samples_of_cycle(duel)
    last = duel.run.tracks[name].unicycle[len(times) * 2 // 3 :, :2]
    if len(last) <= cycle:
        return nan
    chords = np.hypot(*(last[cycle:] - last[:-cycle]).T)
    return float(chords.mean() / (cycle * (times[1] - times[0])))


def distance_walked(duel: InstrumentedDuel, name: str) -> float:
    """Return the path length of the torso, in [m]."""
    positions = duel.run.tracks[name].torso[:, :2]
    corners = np.vstack(
        [positions[:: _samples_of_cycle(duel)], positions[-1:]]
    )
    return float(np.hypot(*np.diff(corners, axis=0).T).sum())


def largest_tilt(duel: InstrumentedDuel) -> float:
    """Return the largest angle of a torso from the vertical, in [deg]."""
    postures = [duel.run.tracks[name].qpos for name in PLAYERS]
    upward = min(
        float((1.0 - 2.0 * (qpos[:, 4:6] ** 2).sum(axis=1)).min())
        for qpos in postures
        if qpos is not None
    )
    return degrees(acos(max(-1.0, min(1.0, upward))))


def mean_foot_slip(duel: InstrumentedDuel) -> float:
    """Return the mean slip of a foot from landing to lift-off, in [m]."""
    slips = []
    for name in PLAYERS:
        for side, flights in enumerate(_swings(duel, name)):
            feet = duel.feet[name][:, side]
            landed = np.searchsorted(duel.ticks, flights[:-1, 1])
            lifted = np.searchsorted(duel.ticks, flights[1:, 0]) - 1
            slips.append(np.hypot(*(feet[lifted] - feet[landed]).T))
    distances = np.concatenate(slips)
    return float(distances.mean()) if len(distances) else nan
