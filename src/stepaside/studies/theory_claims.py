"""Readings for the claims of Sec. II and III, on unicycles and plans."""

from collections.abc import Sequence
from dataclasses import replace
from math import degrees, inf, isfinite, nan, pi
from time import process_time

import numpy as np

from ..core.poses import Array, rotate, wrap_angle, wrap_angles
from ..games.game_settings import duel
from ..games.player_settings import EVASION, PURSUIT
from ..planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)
from ..planning.path import UnicycleTrajectory
from ..theory.unicycle.circles import fit_circle, settling_time
from ..theory.unicycle.simulation import (
    PlayedGame,
    RelativeStart,
    measure,
    simulate,
)
from ..theory.unicycle.unicycle_game import Unicycles
from .tournament import record_steps

FIG_2 = Unicycles(1.0, 1.0, 0.5, 0.5)
START = RelativeStart(5.0, 0.4, -0.2)
ANGLES = tuple(np.radians([15.0, 30.0, 45.0, 60.0, 75.0, 90.0]).tolist())
SMALL_ANGLE = 0.1  # evasion angle near "move back", in [rad]
NAO = Unicycles(0.1, 0.1, 0.2, 0.2)
NAO_START = RelativeStart(1.0, 0.3, -0.1)
ALWAYS = {"safety_radius": 100.0, "side_hysteresis": 0.0}
SAMPLED = duel(
    level="steps",
    duration=547.0,  # 1000 steps
    capture=1e-6,
    pursuer=PURSUIT,
    evader={"strategy": EVASION, "evasion": ALWAYS},
)


def play(game: Unicycles) -> PlayedGame:
    """Simulate a game until its last turn is the circle."""
    return simulate(game, START, settling_time(game))


def _speeds(run: PlayedGame) -> tuple[float, float]:
    """Return the speeds of both players over the last tenth, in [m/s]."""
    times = np.linspace(0.9 * run.end_time, run.end_time, 2001)
    lengths = [
        float(np.hypot(*np.diff(poses[:, :2], axis=0).T).sum())
        for poses in run.poses(times)
    ]
    duration = float(np.ptp(times))
    return lengths[0] / duration, lengths[1] / duration


def read_circle() -> dict[str, float]:
    """Measure the circle of Fig. 2."""
    run = play(FIG_2)
    circle = measure(run)
    pursuer, evader = _speeds(run)
    return {
        "pursuer_radius": circle.radius_pursuer_m,
        "evader_radius": circle.radius_evader_m,
        "one_circle": circle.centers_apart_m,
        "distance": circle.distance_m,
        "orientation": circle.headings_apart_rad,
        "pursuer_speed": pursuer,
        "same_speed": evader / pursuer if pursuer > 0.0 else nan,
    }


def read_saturated() -> dict[str, float]:
    """Compare the saturated law (6) with the proportional one."""
    saturated = measure(play(replace(FIG_2, law="saturated")))
    radius = saturated.radius_evader_m
    return {
        "radius": radius,
        "smaller": radius / measure(play(FIG_2)).radius_evader_m,
        "less": saturated.headings_apart_rad,
        "namely": saturated.headings_apart_rad,
    }


def read_strategies() -> dict[str, float]:
    """Measure the strategies between moving back and moving aside."""
    circles = [measure(play(replace(FIG_2, angle=angle))) for angle in ANGLES]
    apart = np.array([circle.motions_apart_rad for circle in circles])
    radii = np.array([circle.radius_evader_m for circle in circles])
    small = measure(play(replace(FIG_2, angle=SMALL_ANGLE)))
    back = play(replace(FIG_2, angle=0.0))
    return {
        "apart": float(np.abs(apart - ANGLES).max()),
        "grows": float((radii[:-1] / radii[1:]).min()),
        "unbounded": small.radius_evader_m * SMALL_ANGLE,
        "back": _deviation_from_sight(
            *back.poses([back.end_time - 1.0, back.end_time])
        ),
    }


def _deviation_from_sight(pursuer: Array, evader: Array) -> float:
    """Return the angle between the evader's motion and the line of sight.

    Poses at two times, (2, 3).
    """
    sight = evader[0, :2] - pursuer[0, :2]
    motion = evader[1, :2] - evader[0, :2]
    if not np.hypot(*motion) > 0.5:
        return nan
    angle = np.arctan2(motion[1], motion[0]) - np.arctan2(sight[1], sight[0])
    return abs(wrap_angle(float(angle)))


def read_sampled() -> dict[str, float]:
    """Measure the circle of Sec. IV with turning rates held between steps."""
    run = record_steps(SAMPLED.started_at(NAO_START.poses()))
    turns = np.diff(run.pursuer[-200:, 2])
    last = max(2, round(2.0 * pi / max(abs(float(turns[-1])), 1e-3)))
    difference = run.evader[-1] - run.pursuer[-1]
    return {
        "radius": fit_circle(run.pursuer[-last:, :2])[1],
        "distance": float(np.hypot(difference[0], difference[1])),
        "orientation": abs(wrap_angle(float(difference[2]))),
    }


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
    """Return the footsteps of a plan relative to its path. (3, COUNT).

    Arc length up to the nearest point in [m], lateral offset from it in [m],
    positive to the left, and heading less that of the tangent in [rad].
    """
    times = np.linspace(0.0, (COUNT + 4) * GAIT.path_interval, 200_001)
    places = _path_of(bearing, direction).poses(times)[:, :2]
    lengths = np.hypot(*np.diff(places, axis=0, prepend=places[:1]).T).cumsum()
    steps = _plan_of(bearing, direction).placements[2:]
    # The path begins midway between the feet, in the frame of the right one.
    feet = steps[:, :2] - (0.0, 0.5 * GAIT.foot_spacing)
    nearest = [((places - f) ** 2).sum(axis=1).argmin() for f in feet]
    x, y = direction.value * np.gradient(places, axis=0)[nearest].T
    heading = np.arctan2(y, x)
    dx, dy = (feet - places[nearest]).T
    dx, dy = rotate(dx, dy, -heading)
    # The nearest point lies between two samples.
    return np.array(
        [
            lengths[nearest] + direction.value * dx,
            dy,
            wrap_angles(steps[:, 2] - heading),
        ]
    )


def read_footsteps() -> dict[str, float]:
    """Measure footsteps (Sec. III-C) to both sides and in both directions."""
    found = np.array([_footstep_offsets(*case) for case in CASES])
    lengths, laterals, headings = np.moveaxis(found, 1, 0)
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
