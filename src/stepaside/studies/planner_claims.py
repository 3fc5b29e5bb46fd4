"""Claims of Sec. III, measured on the maneuver planner."""

from math import degrees
from time import process_time

import numpy as np

from ..planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
    UnicycleTrajectory,
)
from ..planning.footsteps import place_footsteps
from .claims import Row

BEARING = 0.9
GAIT = GaitSettings()


def path_rows() -> list[Row]:
    """Rows on the Cartesian trajectory (9)-(14)."""
    path = UnicycleTrajectory(
        -BEARING, GAIT.speed, GAIT.gain, Direction.FORWARD
    )
    end = 1.0 / GAIT.gain
    arc = path.poses(np.linspace(0.0, end, 200))
    radius = GAIT.speed / (GAIT.gain * BEARING)
    centre = np.array([0.0, -radius])
    off = np.abs(np.hypot(*(arc[:, :2] - centre).T) - radius).max()
    line = path.poses([end, end + 10.0])
    chord = line[1, :2] - line[0, :2]
    section = "III-B"
    return [
        Row(
            "until t_s the path is an arc of radius v/(k |theta*|)",
            section,
            "closed form",
            0.0,
            float(off),
            1e-9,
            "m",
            as_printed="(10) has a factor sign(theta*) that bends every arc "
            "to one side",
        ),
        Row(
            "at t_s the heading is theta*",
            section,
            "closed form",
            -BEARING,
            float(arc[-1, 2]),
            1e-9,
            "rad",
            as_printed="(11) ends at sign(theta*) 1 rad",
        ),
        Row(
            "after it the path is a straight line along theta*",
            section,
            "closed form",
            -BEARING,
            float(np.arctan2(chord[1], chord[0])),
            1e-9,
            "rad",
        ),
    ]


def footstep_rows() -> list[Row]:
    """Rows on footsteps (Sec. III-C)."""
    path = UnicycleTrajectory(
        BEARING, GAIT.speed, GAIT.gain, Direction.BACKWARD
    )
    steps = place_footsteps(
        path,
        count=12,
        stride=GAIT.stride,
        foot_spacing=GAIT.foot_spacing,
        first_foot=Foot.LEFT,
    )
    times = GAIT.path_interval * np.arange(1, 13)
    poses = path.poses(times)
    middle = steps[:, :2] - (0.0, 0.5 * GAIT.foot_spacing)
    aside = np.hypot(*(middle - poses[:, :2]).T)
    h = 1e-5
    ahead, behind = path.poses(times + h), path.poses(times - h)
    speed = np.hypot(*(ahead - behind)[:, :2].T) / (2 * h)
    return [
        Row(
            "footsteps lie at a constant stepsize along the path",
            "III-C",
            "closed form",
            GAIT.stride,
            float(np.abs(speed * GAIT.path_interval).max()),
            1e-6,
            "m",
        ),
        Row(
            "displaced to the right and to the left of it",
            "III-C",
            "closed form",
            0.5 * GAIT.foot_spacing,
            float(aside.max()),
            1e-9,
            "m",
        ),
        Row(
            "with the orientation of its tangent (greatest difference)",
            "III-C",
            "closed form",
            0.0,
            float(np.abs(steps[:, 2] - poses[:, 2]).max()),
            1e-9,
            "rad",
        ),
    ]


def com_rows() -> list[Row]:
    """Rows on the bounded CoM (15)-(17) and on planning time."""
    planner = ManeuverPlanner(GAIT)
    plan = planner.plan(
        BEARING,
        Direction.BACKWARD,
        first_foot=Foot.LEFT,
        standing=True,
        count=20,
    )
    duration = plan.schedule.duration
    samples = plan.sample(np.arange(0.0, duration, 0.01))
    astray = np.hypot(*(samples.com - samples.zmp).T).max()
    state = CenterState((0.0, 0.03), (0.05, -0.1))
    spent = []
    for bearing in np.linspace(-1.5, 1.5, 400).tolist():
        start = process_time()
        planner.plan(
            bearing, Direction.FORWARD, first_foot=Foot.LEFT, state=state
        )
        spent.append(process_time() - start)
    turned = GAIT.path_interval * GAIT.gain
    return [
        Row(
            "the CoM is bounded (its greatest distance from the ZMP)",
            "III-D",
            "planner",
            GAIT.foot_spacing,
            float(astray),
            0.0,
            "m",
            "<",
        ),
        Row(
            "x_u is the integral (16) (greatest difference to quadrature)",
            "III-D",
            "planner",
            0.0,
            _quadrature_error(plan),
            1e-6,
            "m",
        ),
        Row(
            "the straight part is never travelled (share of t_s walked)",
            "III-E",
            "planner",
            1.0,
            turned,
            0.0,
            "1",
            "<",
        ),
        Row(
            "planning takes less than 10 ms (99th percentile)",
            "IV",
            "planner",
            10.0,
            1e3 * float(np.quantile(spent, 0.99)),
            0.0,
            "ms",
            "<",
        ),
        Row(
            "desired headings are reached exactly (last footstep)",
            "III-B",
            "planner",
            degrees(BEARING),
            degrees(float(plan.placements[-1, 2])),
            1e-9,
            "deg",
        ),
    ]


def _quadrature_error(plan: ManeuverPlan) -> float:
    """Greatest difference of the DCM to (16), by a fine midpoint rule."""
    h = 1e-4
    middles = np.arange(0.5 * h, plan.schedule.duration + 4.0, h)
    zmp = plan.sample(middles).zmp
    worst = 0.0
    for time in (0.0, 1.0, 3.3, 7.1):
        ahead = middles > time
        weight = GAIT.eta * np.exp(-GAIT.eta * (middles[ahead] - time)) * h
        weight /= weight.sum() + np.exp(
            -GAIT.eta * (middles[-1] + 0.5 * h - time)
        )
        integral = weight @ zmp[ahead]
        worst = max(
            worst, float(np.abs(integral - plan.sample([time]).dcm).max())
        )
    return worst
