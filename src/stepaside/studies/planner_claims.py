"""Claims of Sec. III on paths and footsteps, measured on the planner."""

from typing import NamedTuple

import numpy as np

from ..core.poses import Array, wrap_angle, wrap_angles
from ..planning import (
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlanner,
    UnicycleTrajectory,
)
from .claims import Claim, Readings, most_deviating

BEARING = 0.9  # desired heading, in [rad]
GAIT = GaitSettings()
ARC = 1.0 / GAIT.gain  # path time on the arc, t_s, in [s]
CASES = tuple(
    (bearing, direction)
    for bearing in (BEARING, -BEARING)
    for direction in Direction
)
COUNT = 20  # footsteps: some on the arc, some on the straight line


def path_of(bearing: float, direction: Direction) -> UnicycleTrajectory:
    """Return the path of the gait to a desired heading, in [rad]."""
    return UnicycleTrajectory(bearing, GAIT.speed, GAIT.gain, direction)


def read_path() -> Readings:
    """Measure the trajectory (9)-(14) to both sides and in both directions."""
    deviations, lengths, headings, angles = [], [], [], []
    for bearing, direction in CASES:
        path = path_of(bearing, direction)
        velocity = direction.value * GAIT.speed
        arc = path.poses(np.linspace(0.0, ARC, 2001))
        # The centre is at v/omega to the left, with the signs of both.
        radius = velocity / (GAIT.gain * bearing)
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


PATH = (
    Claim(
        "arc",
        "until t_s the path is an arc of radius v/(k |theta*|), on the side "
        "of theta* (greatest distance from it)",
        "III-B",
        "closed form",
        0.0,
        "m",
        1e-9,
        as_printed="(10) has a factor sign(theta*) that bends every arc to "
        "one side",
    ),
    Claim(
        "way",
        "it is travelled at v (path length until t_s)",
        "III-B",
        "closed form",
        GAIT.speed * ARC,
        "m",
        1e-6,
    ),
    Claim(
        "heading",
        "at t_s the heading is theta* (ratio)",
        "III-B",
        "closed form",
        1.0,
        "1",
        1e-9,
        as_printed="(11) ends at sign(theta*) 1 rad",
    ),
    Claim(
        "line",
        "after it the path is a straight line along theta* (greatest angle "
        "between the path and theta*)",
        "III-B",
        "closed form",
        0.0,
        "rad",
        1e-9,
    ),
)


class FootstepOffset(NamedTuple):
    """Pose of a footstep relative to the path.

    Attributes:
        arc_length: Arc length of the path up to its nearest point, in [m].
        lateral: Offset from that point, positive to the left, in [m].
        heading: Heading minus that of the tangent, in [rad].
    """

    arc_length: float
    lateral: float
    heading: float


def footstep_offsets(
    bearing: float, direction: Direction
) -> list[FootstepOffset]:
    """Return the offsets of the footsteps of a plan from its path."""
    plan = ManeuverPlanner(GAIT).plan(
        bearing,
        direction,
        first_foot=Foot.LEFT,
        standing=True,
        count=COUNT,
    )
    path = path_of(bearing, direction)
    times = np.linspace(0.0, (COUNT + 4) * GAIT.path_interval, 4001)
    line = path.poses(times)[:, :2]
    # The path begins midway between the feet, in the frame of the right one.
    origin = np.array([0.0, 0.5 * GAIT.foot_spacing])
    chords = np.hypot(*np.diff(line, axis=0).T)
    lengths = np.concatenate([[0.0], chords.cumsum()])
    offsets = []
    for x, y, theta in plan.placements[2:].tolist():
        position = np.array([x, y]) - origin
        time, h = _nearest(path, times, position), 1e-5
        after, before = path.poses([time + h, time - h])[:, :2]
        tangent = direction.value * (after - before)
        tangent /= max(float(np.hypot(*tangent)), 1e-12)
        aside = position - path.poses([time])[0, :2]
        heading = float(np.arctan2(tangent[1], tangent[0]))
        offsets.append(
            FootstepOffset(
                float(np.interp(time, times, lengths)),
                float(tangent[0] * aside[1] - tangent[1] * aside[0]),
                wrap_angle(theta - heading),
            )
        )
    return offsets


def _nearest(path: UnicycleTrajectory, times: Array, point: Array) -> float:
    """Return the time at which a path is nearest to a point, in [s]."""
    for _ in range(3):  # refinements between the neighbouring samples
        differences = path.poses(times)[:, :2] - point
        best = int((differences**2).sum(axis=1).argmin())
        low, high = max(best - 1, 0), min(best + 1, len(times) - 1)
        times = np.linspace(times[low], times[high], 201)
    return float(times[100])


def read_footsteps() -> Readings:
    """Measure footsteps (Sec. III-C) to both sides and in both directions."""
    strides, laterals, headings = [], [], []
    sides = np.where(np.arange(COUNT) % 2 == 0, 1.0, -1.0)  # left foot first
    for bearing, direction in CASES:
        offsets = footstep_offsets(bearing, direction)
        lengths = [0.0, *(offset.arc_length for offset in offsets)]
        strides += np.diff(lengths).tolist()
        laterals += [
            s * o.lateral for s, o in zip(sides, offsets, strict=True)
        ]
        headings += [abs(offset.heading) for offset in offsets]
    return {
        "stepsize": most_deviating(strides, GAIT.stride),
        "sides": most_deviating(laterals, 0.5 * GAIT.foot_spacing),
        "tangent": max(headings),
    }


FOOTSTEPS = (
    Claim(
        "stepsize",
        "footsteps lie at a constant stepsize along the path (arc length "
        "between successive footsteps; the value farthest from the expected "
        "one)",
        "III-C",
        "planner",
        GAIT.stride,
        "m",
        1e-6,
    ),
    Claim(
        "sides",
        "displaced alternately to its left and right (lateral offset to the "
        "foot's side; the value farthest from the expected one)",
        "III-C",
        "planner",
        0.5 * GAIT.foot_spacing,
        "m",
        1e-6,
    ),
    Claim(
        "tangent",
        "with the orientation of its tangent (greatest angle to a finite "
        "difference of the path)",
        "III-C",
        "planner",
        0.0,
        "rad",
        1e-5,
    ),
)
