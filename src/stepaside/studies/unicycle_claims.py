"""Claims of Sec. II, measured by simulation of unicycles."""

from dataclasses import replace
from math import nan, pi, sin, sqrt

import numpy as np

from ..core.poses import Array, wrap_angle
from ..theory.unicycle.adaptive_simulation import PlayedGame, simulate
from ..theory.unicycle.circle_fit import (
    FittedCircle,
    fit_circle,
    measure,
    settling_time,
)
from ..theory.unicycle.relative_coordinates import RelativeStart
from ..theory.unicycle.sampled_game import SampledRun, simulate_sampled
from ..theory.unicycle.unicycle_game import Game, TurningLaw, Unicycle
from .claims import Claim, Readings

FIG_2 = Game(Unicycle(1.0, 0.5), Unicycle(1.0, 0.5))
START = RelativeStart(5.0, 0.4, -0.2)
ANGLES = tuple(np.radians([15.0, 30.0, 45.0, 60.0, 75.0, 90.0]).tolist())
SMALL_ANGLE = 0.1  # evasion angle near "move back", in [rad]
NAO = Game(Unicycle(0.1, 0.2), Unicycle(0.1, 0.2))
NAO_START = RelativeStart(1.0, 0.3, -0.1)
STEP = 0.4  # path time of a step, in [s]
RADIUS = 4.0 / (pi * 0.5)  # of Fig. 2, in [m]
NAO_RADIUS = 4.0 * 0.1 / (pi * 0.2)


def play(game: Game) -> PlayedGame:
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


def read_circle() -> Readings:
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


CIRCLE = tuple(
    Claim(key, text, "II-C, Fig. 2", "unicycle", expected, unit, 1e-3)
    for key, text, expected, unit in (
        ("pursuer_radius", "the pursuer settles on a circle", RADIUS, "m"),
        ("evader_radius", "the evader settles on a circle", RADIUS, "m"),
        (
            "one_circle",
            "both circles coincide (distance of the centres)",
            0,
            "m",
        ),
        ("distance", "their distance converges", sqrt(2.0) * RADIUS, "m"),
        ("orientation", "their relative orientation is pi/2", pi / 2, "rad"),
        ("pursuer_speed", "the pursuer travels at 1 m/s", 1.0, "m/s"),
        ("same_speed", "both travel at the same speed (ratio)", 1.0, "1"),
    )
)


def read_saturated() -> Readings:
    """Compare the saturated law (6) with the proportional one."""
    saturated = measure(play(replace(FIG_2, law=TurningLaw.SATURATED)))
    proportional = measure(play(FIG_2))
    return {
        "radius": saturated.radius_evader_m,
        "smaller": saturated.radius_evader_m / proportional.radius_evader_m,
        "less": saturated.headings_apart_rad,
        "namely": saturated.headings_apart_rad,
    }


SATURATED = (
    Claim(
        "radius",
        "with (6) the radius is v/k",
        "II-C",
        "unicycle",
        2.0,
        "m",
        1e-3,
    ),
    Claim(
        "smaller",
        "and smaller than with (4) (ratio of the radii)",
        "II-C",
        "unicycle",
        1.0,
        "1",
        relation="<",
    ),
    Claim(
        "less",
        "the headings are then less than pi/2 apart",
        "II-C",
        "unicycle",
        pi / 2,
        "rad",
        relation="<",
        as_printed="relative orientation; the directions of motion are "
        "2 rad apart",
    ),
    Claim(
        "namely",
        "namely pi - 2",
        "II-C",
        "unicycle",
        pi - 2.0,
        "rad",
        1e-3,
    ),
)


def read_strategies() -> Readings:
    """Measure the strategies between moving back and moving aside."""
    circles: list[FittedCircle] = [
        measure(play(replace(FIG_2, angle=angle))) for angle in ANGLES
    ]
    radii = [circle.radius_evader_m for circle in circles]
    small = measure(play(replace(FIG_2, angle=SMALL_ANGLE)))
    back = play(replace(FIG_2, angle=0.0))
    times = [back.end_time - 1.0, back.end_time]
    pursuer, evader = back.poses(times)
    return {
        "apart": max(
            abs(circle.motions_apart_rad - angle)
            for circle, angle in zip(circles, ANGLES, strict=True)
        ),
        "grows": min(a / b for a, b in zip(radii, radii[1:], strict=False)),
        "unbounded": small.radius_evader_m * SMALL_ANGLE,
        "back": _deviation_from_sight(pursuer, evader),
    }


def _deviation_from_sight(pursuer: Array, evader: Array) -> float:
    """Return the angle between the evader's motion and the line of sight.

    Zero if it moves straight away from the pursuer.

    Args:
        pursuer: Poses at two times. Shape (2, 3).
        evader: Poses at two times. Shape (2, 3).
    """
    sight = evader[0, :2] - pursuer[0, :2]
    motion = evader[1, :2] - evader[0, :2]
    if not np.hypot(*motion) > 0.5:
        return nan
    angle = np.arctan2(motion[1], motion[0]) - np.arctan2(sight[1], sight[0])
    return abs(wrap_angle(float(angle)))


STRATEGIES = (
    Claim(
        "apart",
        "with an angle alpha the directions of motion end alpha apart "
        "(greatest difference for six angles)",
        "II-C",
        "unicycle",
        0.0,
        "rad",
        1e-4,
        as_printed="relative orientation alpha; headings: pi - alpha. "
        "(5) with alpha read literally walks into the pursuer",
    ),
    Claim(
        "grows",
        "the radius grows as alpha falls (least ratio of neighbours)",
        "II-C",
        "unicycle",
        1.0,
        "1",
        relation=">",
    ),
    Claim(
        "unbounded",
        "without bound: as 2 v/(k alpha) (radius times alpha, at alpha = 0.1)",
        "II-C",
        "unicycle",
        4.0,
        "m",
        4e-3,
    ),
    Claim(
        "back",
        "alpha = 0 moves back (angle between the evader's direction of "
        "motion and the line of sight, at the end)",
        "II-C",
        "unicycle",
        0.0,
        "rad",
        1e-3,
    ),
)


def read_sampled() -> Readings:
    """Measure the circle of Sec. IV with turning rates held between steps."""
    run: SampledRun = simulate_sampled(NAO, NAO_START, 400.0, STEP)
    turns = np.diff(run.pursuer[-200:, 2])
    last = max(2, round(2.0 * pi / max(abs(float(turns[-1])), 1e-3)))
    difference = run.evader[-1] - run.pursuer[-1]
    return {
        "radius": fit_circle(run.pursuer[-last:, :2])[1],
        "distance": float(np.hypot(difference[0], difference[1])),
        "orientation": abs(wrap_angle(float(difference[2]))),
    }


SAMPLED = tuple(
    Claim(key, text, "III-B, IV", "sampled", expected, unit, 1e-3)
    for key, text, expected, unit in (
        (
            "radius",
            "holding the turning rate between steps does not change the "
            "circle",
            NAO_RADIUS,
            "m",
        ),
        (
            "distance",
            "nor the distance",
            4.0 * 0.1 * sin(pi / 4) / (pi / 2 * 0.2),
            "m",
        ),
        ("orientation", "nor the relative orientation", pi / 2, "rad"),
    )
)
