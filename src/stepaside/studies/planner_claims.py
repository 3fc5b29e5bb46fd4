"""Readings for the claims of Sec. III on paths, footsteps and the CoM."""

from collections.abc import Sequence
from math import degrees, inf, isfinite, nan
from time import process_time

import numpy as np

from ..core.poses import Array, wrap_angle, wrap_angles
from ..planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)
from ..planning.path import UnicycleTrajectory

BEARING = 0.9  # desired heading, in [rad]
GAIT = GaitSettings()
ARC = 1.0 / GAIT.gain  # path time on the arc, t_s, in [s]
CASES = tuple(
    (bearing, direction)
    for bearing in (BEARING, -BEARING)
    for direction in Direction
)
COUNT = 20  # footsteps: some on the arc, some on the straight line
REST = 4.0  # time after the last step that is evaluated, in [s]
PLANS = 400  # number of timed plans


def most_deviating(values: Sequence[float], expected: float) -> float:
    """Return the value farthest from an expected one; NaN without values."""
    return max(
        values,
        key=lambda v: abs(v - expected) if isfinite(v) else inf,
        default=nan,
    )


def _path_of(bearing: float, direction: Direction) -> UnicycleTrajectory:
    return UnicycleTrajectory(bearing, GAIT.speed, GAIT.gain, direction)


def _plan_of(bearing: float, direction: Direction) -> ManeuverPlan:
    return ManeuverPlanner(GAIT).plan(
        bearing, direction, first_foot=Foot.LEFT, standing=True, count=COUNT
    )


def read_path() -> dict[str, float]:
    """Measure the trajectory (9)-(14) to both sides and in both directions."""
    deviations, lengths, headings, angles = [], [], [], []
    for bearing, direction in CASES:
        path = _path_of(bearing, direction)
        arc = path.poses(np.linspace(0.0, ARC, 2001))
        # The centre is at v/omega to the left, with the signs of both.
        radius = direction.value * GAIT.speed / (GAIT.gain * bearing)
        to_centre = np.hypot(arc[:, 0], arc[:, 1] - radius)
        deviations.append(float(np.abs(to_centre - abs(radius)).max()))
        chords = np.diff(arc[:, :2], axis=0)
        lengths.append(float(np.hypot(*chords.T).sum()))
        headings.append(float(arc[-1, 2]) / bearing)
        line = path.poses(np.linspace(ARC, ARC + 10.0, 101))
        steps = direction.value * np.diff(line[:, :2], axis=0)
        towards = np.arctan2(steps[:, 1], steps[:, 0])
        angles.append(float(np.abs(wrap_angles(towards - bearing)).max()))
    return {
        "arc": max(deviations),
        "way": most_deviating(lengths, GAIT.speed * ARC),
        "heading": most_deviating(headings, 1.0),
        "line": max(angles),
    }


def _footstep_offsets(bearing: float, direction: Direction) -> Array:
    """Return the footsteps of a plan relative to its path.

    Returns:
        Rows of arc length up to the nearest point in [m], lateral offset
        from it in [m], positive to the left, and heading less that of the
        tangent in [rad]. Shape (COUNT, 3).
    """
    path = _path_of(bearing, direction)
    times = np.linspace(0.0, (COUNT + 4) * GAIT.path_interval, 4001)
    chords = np.diff(path.poses(times)[:, :2], axis=0)
    lengths = np.concatenate([[0.0], np.hypot(*chords.T).cumsum()])
    # The path begins midway between the feet, in the frame of the right one.
    origin = np.array([0.0, 0.5 * GAIT.foot_spacing])
    offsets = []
    for x, y, theta in _plan_of(bearing, direction).placements[2:].tolist():
        position = np.array([x, y]) - origin
        time, h = _nearest(path, times, position), 1e-5
        after, before = path.poses([time + h, time - h])[:, :2]
        tangent = direction.value * (after - before)
        tangent /= max(float(np.hypot(*tangent)), 1e-12)
        aside = position - path.poses([time])[0, :2]
        heading = float(np.arctan2(tangent[1], tangent[0]))
        offsets.append(
            (
                np.interp(time, times, lengths),
                tangent[0] * aside[1] - tangent[1] * aside[0],
                wrap_angle(theta - heading),
            )
        )
    return np.array(offsets, dtype=np.float64)


def _nearest(path: UnicycleTrajectory, times: Array, point: Array) -> float:
    """Return the time at which a path is nearest to a point, in [s]."""
    for _ in range(3):  # refinements between the neighbouring samples
        differences = path.poses(times)[:, :2] - point
        best = int((differences**2).sum(axis=1).argmin())
        low, high = max(best - 1, 0), min(best + 1, len(times) - 1)
        times = np.linspace(times[low], times[high], 201)
    return float(times[100])


def read_footsteps() -> dict[str, float]:
    """Measure footsteps (Sec. III-C) to both sides and in both directions."""
    found = np.array([_footstep_offsets(*case) for case in CASES])
    lengths, laterals, headings = np.moveaxis(found, 2, 0)
    strides = np.diff(lengths, axis=1, prepend=0.0)
    sides = np.where(np.arange(COUNT) % 2 == 0, 1.0, -1.0)  # left foot first
    half = 0.5 * GAIT.foot_spacing
    return {
        "stepsize": most_deviating(strides.ravel().tolist(), GAIT.stride),
        "sides": most_deviating((sides * laterals).ravel().tolist(), half),
        "tangent": float(np.abs(headings).max()),
    }


def read_com() -> dict[str, float]:
    """Measure the bounded CoM (15)-(17) of a plan, and its final heading."""
    left, right = (
        _plan_of(bearing, Direction.BACKWARD)
        for bearing in (BEARING, -BEARING)
    )
    samples = left.sample(np.arange(0.0, left.schedule.duration + REST, 0.01))
    ends = [
        degrees(float(left.placements[-1, 2])),
        -degrees(float(right.placements[-1, 2])),
    ]
    return {
        "bounded": float(np.hypot(*(samples.com - samples.zmp).T).max()),
        "pendulum": _pendulum_error(left),
        "integral": _quadrature_error(left),
        "reached": most_deviating(ends, degrees(BEARING)),
    }


def _pendulum_error(plan: ManeuverPlan) -> float:
    """Return the largest residual of x'' = eta^2 (x - z), in [m/s^2].

    By finite differences in the middle of each phase of the plan, where the
    CoM is smooth.
    """
    h = 1e-3
    starts = plan.schedule.starts
    middles = 0.5 * (starts[1:] + starts[:-1])
    before, here, after = (
        plan.sample(middles + shift) for shift in (-h, 0.0, h)
    )
    rate = (after.com - 2.0 * here.com + before.com) / h**2
    expected = GAIT.eta**2 * (here.com - here.zmp)
    return float(np.abs(rate - expected).max())


def _quadrature_error(plan: ManeuverPlan) -> float:
    """Return the largest difference of the DCM to (16), by midpoint rule."""
    h = 5e-4
    middles = np.arange(0.5 * h, plan.schedule.duration + REST, h)
    zmp = plan.sample(middles).zmp
    errors = []
    for time in (0.0, 1.0, 3.3, 7.1):
        ahead = middles > time
        weight = GAIT.eta * np.exp(-GAIT.eta * (middles[ahead] - time)) * h
        rest = np.exp(-GAIT.eta * (middles[-1] + 0.5 * h - time))
        integral = weight @ zmp[ahead] / (weight.sum() + rest)
        errors.append(np.abs(integral - plan.sample([time]).dcm).max())
    return float(max(errors))


def read_timing() -> dict[str, float]:
    """Measure the processor time of plans of a walking robot, in [ms]."""
    planner = ManeuverPlanner(GAIT)
    state = CenterState((0.0, 0.03), (0.05, -0.1))
    spent = []
    for bearing in np.linspace(-1.5, 1.5, PLANS).tolist():
        start = process_time()
        planner.plan(
            bearing, Direction.FORWARD, first_foot=Foot.LEFT, state=state
        )
        spent.append(process_time() - start)
    return {"planning": 1e3 * float(np.quantile(spent, 0.99))}
