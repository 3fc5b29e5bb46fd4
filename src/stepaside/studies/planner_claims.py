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
from .claims import Claim, Readings, farthest

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
    """Path of the gait to a desired heading, in [rad]."""
    return UnicycleTrajectory(bearing, GAIT.speed, GAIT.gain, direction)


def read_path() -> Readings:
    """The Cartesian trajectory (9)-(14), to both sides, forth and back."""
    off, ways, headings, bent = [], [], [], []
    for bearing, direction in CASES:
        path = path_of(bearing, direction)
        velocity = direction.value * GAIT.speed
        arc = path.poses(np.linspace(0.0, ARC, 2001))
        # The centre lies to the left, at v/omega, with the signs of both.
        radius = velocity / (GAIT.gain * bearing)
        to_centre = np.hypot(arc[:, 0], arc[:, 1] - radius)
        off.append(float(np.abs(to_centre - abs(radius)).max()))
        chords = np.diff(arc[:, :2], axis=0)
        ways.append(float(np.hypot(*chords.T).sum()))
        headings.append(float(arc[-1, 2]) / bearing)
        line = path.poses(np.linspace(ARC, ARC + 10.0, 101))
        steps = direction.value * np.diff(line[:, :2], axis=0)
        towards = np.arctan2(steps[:, 1], steps[:, 0])
        bent.append(float(np.abs(wrap_angles(towards - bearing)).max()))
    return {
        "arc": max(off),
        "way": farthest(ways, GAIT.speed * ARC),
        "heading": farthest(headings, 1.0),
        "line": max(bent),
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
        "it is travelled at v (way until t_s)",
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
        "between the way and theta*)",
        "III-B",
        "closed form",
        0.0,
        "rad",
        1e-9,
    ),
)


class FootstepOffset(NamedTuple):
    """Where a footstep stands beside the path.

    Attributes:
        way: Arc length of the path to the point nearest to it, in [m].
        aside: Distance from that point, positive to the left, in [m].
        turned: Its heading less that of the tangent there, in [rad].
    """

    way: float
    aside: float
    turned: float


def footholds(bearing: float, direction: Direction) -> list[FootstepOffset]:
    """Footsteps of a plan beside its path, found from their positions."""
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
    # It begins midway between the feet; the frame is the right foot's.
    beside = np.array([0.0, 0.5 * GAIT.foot_spacing])
    ways = np.concatenate([[0.0], np.hypot(*np.diff(line, axis=0).T).cumsum()])
    found = []
    for x, y, theta in plan.placements[2:].tolist():
        place = np.array([x, y]) - beside
        time, h = _nearest(path, times, place), 1e-5
        after, before = path.poses([time + h, time - h])[:, :2]
        tangent = direction.value * (after - before)
        tangent /= max(float(np.hypot(*tangent)), 1e-12)
        aside = place - path.poses([time])[0, :2]
        heading = float(np.arctan2(tangent[1], tangent[0]))
        found.append(
            FootstepOffset(
                float(np.interp(time, times, ways)),
                float(tangent[0] * aside[1] - tangent[1] * aside[0]),
                wrap_angle(theta - heading),
            )
        )
    return found


def _nearest(path: UnicycleTrajectory, times: Array, place: Array) -> float:
    """Time at which a path comes nearest to a place, in [s]."""
    for _ in range(3):  # each time between the neighbours found
        apart = path.poses(times)[:, :2] - place
        best = int((apart**2).sum(axis=1).argmin())
        low, high = max(best - 1, 0), min(best + 1, len(times) - 1)
        times = np.linspace(times[low], times[high], 201)
    return float(times[100])


def read_footsteps() -> Readings:
    """Footsteps of Sec. III-C, to both sides, forth and back."""
    strides, asides, turns = [], [], []
    sides = np.where(np.arange(COUNT) % 2 == 0, 1.0, -1.0)  # left foot first
    for bearing, direction in CASES:
        found = footholds(bearing, direction)
        ways = [0.0, *(foothold.way for foothold in found)]
        strides += np.diff(ways).tolist()
        asides += [s * f.aside for s, f in zip(sides, found, strict=True)]
        turns += [abs(foothold.turned) for foothold in found]
    return {
        "stepsize": farthest(strides, GAIT.stride),
        "sides": farthest(asides, 0.5 * GAIT.foot_spacing),
        "tangent": max(turns),
    }


FOOTSTEPS = (
    Claim(
        "stepsize",
        "footsteps lie at a constant stepsize along the path (arc length "
        "between neighbours, the one farthest off)",
        "III-C",
        "planner",
        GAIT.stride,
        "m",
        1e-6,
    ),
    Claim(
        "sides",
        "displaced alternately to the left and to the right of it (distance "
        "to the foot's own side, the one farthest off)",
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
