"""Steps, plans, references and falls in a watched duel."""

from math import acos, degrees, inf, nan
from typing import NamedTuple

import numpy as np

from ..core.poses import Array
from ..games.duel_settings import PLAYERS
from ..planning import GaitSettings
from .watched_duel import WalkedPlan, WatchedDuel

BEARS = 1.0  # load from which a foot counts as on the floor, in [N]
SWING = 0.35  # of a single support: a foot that is off it longer swings
LEAVES = 0.03  # a foot is unloaded this near the end of double support, [s]
ENDS = 6  # ticks on either side of a replan, for velocities there


def swings(ticks: Array, load: Array, single_support: float) -> Array:
    """When a foot left the floor and came down again, by its load.

    Shorter times without load belong to a foot that comes down or lifts off.

    Args:
        ticks: Times, in [s]. Shape (n,).
        load: Load of the foot, in [N]. Shape (n,).
        single_support: How long a swing shall last, in [s].

    Returns:
        Rows (lift-off, landing), in [s]. Shape (m, 2).
    """
    on, least = load > BEARS, SWING * single_support
    changes = np.flatnonzero(on[1:] != on[:-1]) + 1
    rows = [
        (ticks[a], ticks[b])
        for a, b in zip(changes, changes[1:], strict=False)
        if not on[a] and ticks[b] - ticks[a] > least
    ]
    return np.array(rows, dtype=np.float64).reshape(-1, 2)


def steps_of(duel: WatchedDuel, name: str) -> list[float]:
    """Times between landings, whichever foot's, in [s]; inf if none."""
    feet = duel.loads[name].T
    lasts = duel.settings.gait.single_support
    found = [swings(duel.ticks, load, lasts)[:, 1] for load in feet]
    landings = np.concatenate(found)
    between: list[float] = np.diff(np.sort(landings)).tolist()
    return between or [inf]


def both_feet(duel: WatchedDuel, name: str) -> tuple[float, float]:
    """Whether plans are replaced as the paper says, by the foot forces.

    At the end of a double support the plan leaves nothing on the foot that
    is about to swing: one that lost its load only just before still counts
    as on the floor.

    Returns:
        Share of the plans that follow exactly one landing after the one
        before, while both feet are on the floor; and the longest time from
        such a plan to the next lift-off, in [s]. NaN without such plans.
    """
    lasts = duel.settings.gait.single_support
    feet = duel.loads[name].T
    found = [swings(duel.ticks, load, lasts) for load in feet]
    flights = np.concatenate(found)
    lifts, landings = np.sort(flights[:, 0]), np.sort(flights[:, 1])
    sent = np.array([plan.sent for plan in duel.plans[name]])
    if not len(lifts):
        return nan, nan
    # A plan that no lift-off follows came too late to tell.
    sent = sent[sent <= lifts[-1] + LEAVES]
    if len(sent) < 2:
        return nan, nan
    in_air = (flights[:, 0] + LEAVES <= sent[1:, None]) & (
        sent[1:, None] < flights[:, 1]
    )
    landed = np.diff(np.searchsorted(landings, sent))
    good = (landed == 1) & ~in_air.any(axis=1)
    late = lifts[np.searchsorted(lifts, sent[1:] - LEAVES)] - sent[1:]
    return float(good.mean()), float(late.max())


def plan_share(plans: tuple[WalkedPlan, ...], gait: GaitSettings) -> float:
    """Greatest share of its arc that a plan was walked; NaN without any.

    The gait plays the path slower than the template drives it.
    """
    pace = gait.path_interval / gait.step_duration
    shares = [
        (later.sent - plan.sent - plan.from_rest * gait.start_support)
        * pace
        * gait.gain
        for plan, later in zip(plans, plans[1:], strict=False)
    ]
    return max(shares, default=nan)


class ReferenceJump(NamedTuple):
    """Jump of a reference, in [m], and of its velocity, in [m/s]."""

    place: float
    velocity: float


def reference_jumps(duel: WatchedDuel, name: str) -> ReferenceJump:
    """Greatest jump of the CoM reference where a plan replaces another.

    Place and velocity at that instant are those of the polynomials through
    the references that were sent in the last ticks before it and in the
    first ones after it. NaN without plans.
    """
    sent, ticks = duel.references[name], duel.ticks
    jumps = []
    for plan in duel.plans[name]:
        first = int(np.searchsorted(ticks, plan.started - 1e-9))
        if ENDS <= first <= len(ticks) - ENDS:
            before = _at_instant(ticks, sent, plan.started, first - ENDS)
            after = _at_instant(ticks, sent, plan.started, first)
            jumps.append(np.abs(after - before).max(axis=1))
    if not jumps:
        return ReferenceJump(nan, nan)
    place, velocity = np.max(jumps, axis=0).tolist()
    return ReferenceJump(place, velocity)


def _at_instant(
    ticks: Array, sent: Array, instant: float, first: int
) -> Array:
    """Place and velocity at an instant, by some ticks. Shape (2, 2)."""
    period = float(ticks[1] - ticks[0])
    rows = slice(first, first + ENDS)
    powers = np.vander((ticks[rows] - instant) / period, increasing=True)
    found: Array = np.array(np.linalg.solve(powers, sent[rows])[:2])
    found[1] /= period
    return found


def walking_speed(duel: WatchedDuel, name: str) -> float:
    """Speed over the last third, in [m/s].

    Chords of a gait cycle, so that the sway does not count as way.
    """
    times = duel.times
    period = float(times[1] - times[0])
    cycle = round(2.0 * duel.settings.gait.step_duration / period)
    place = duel.tracks[name].unicycle[len(times) * 2 // 3 :, :2]
    if len(place) <= cycle:
        return nan
    way = np.hypot(*(place[cycle:] - place[:-cycle]).T)
    return float(way.mean() / (cycle * period))


def distance_walked(duel: WatchedDuel, name: str) -> float:
    """Way of the torso in chords of a gait cycle, in [m]."""
    times = duel.times
    period = float(times[1] - times[0])
    cycle = round(2.0 * duel.settings.gait.step_duration / period)
    place = duel.tracks[name].torso[:, :2]
    corners = np.vstack([place[::cycle], place[-1:]])
    return float(np.hypot(*np.diff(corners, axis=0).T).sum())


def greatest_tilt(duel: WatchedDuel) -> float:
    """Greatest angle of a torso from the vertical, in [deg]."""
    postures = [duel.tracks[name].qpos for name in PLAYERS]
    upward = [
        1.0 - 2.0 * (qpos[:, 4:6] ** 2).sum(axis=1)
        for qpos in postures
        if qpos is not None
    ]
    return degrees(acos(max(-1.0, min(1.0, float(np.min(upward))))))


def mean_slide(duel: WatchedDuel) -> float:
    """Mean way of a foot from its landing to its next lift-off, in [m]."""
    ways = []
    for name in PLAYERS:
        for side, load in enumerate(duel.loads[name].T):
            lasts = duel.settings.gait.single_support
            flights = swings(duel.ticks, load, lasts)
            feet = duel.feet[name][:, side]
            landed = np.searchsorted(duel.ticks, flights[:-1, 1])
            lifted = np.searchsorted(duel.ticks, flights[1:, 0]) - 1
            ways.append(np.hypot(*(feet[lifted] - feet[landed]).T))
    every = np.concatenate(ways)
    return float(every.mean()) if len(every) else nan
