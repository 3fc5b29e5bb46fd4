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
SMALL = 0.1  # evasion angle near "move back", in [rad]
NAO = Game(Unicycle(0.1, 0.2), Unicycle(0.1, 0.2))
NAO_START = RelativeStart(1.0, 0.3, -0.1)
STEP = 0.4  # path time of a step, in [s]
RADIUS = 4.0 / (pi * 0.5)  # of Fig. 2, in [m]
NAO_RADIUS = 4.0 * 0.1 / (pi * 0.2)


def play(game: Game) -> PlayedGame:
    """Play a game until its last turn is the circle."""
    return simulate(game, START, settling_time(game))


def _speeds(run: PlayedGame) -> tuple[float, float]:
    """Speeds on the floor over the last tenth, in [m/s]."""
    times = np.linspace(0.9 * run.end_time, run.end_time, 2001)
    ways = [
        float(np.hypot(*np.diff(poses[:, :2], axis=0).T).sum())
        for poses in run.poses(times)
    ]
    return ways[0] / float(np.ptp(times)), ways[1] / float(np.ptp(times))


def read_circle() -> Readings:
    """The circle of Fig. 2."""
    run = play(FIG_2)
    seen = measure(run)
    pursuer, evader = _speeds(run)
    return {
        "pursuer_radius": seen.radius_pursuer_m,
        "evader_radius": seen.radius_evader_m,
        "one_circle": seen.centers_apart_m,
        "distance": seen.distance_m,
        "orientation": seen.headings_apart_rad,
        "pursuer_speed": pursuer,
        "same_speed": evader / pursuer if pursuer > 0.0 else nan,
    }


CIRCLE = tuple(
    Claim(key, text, "II-C, Fig. 2", "unicycles", expected, unit, 1e-3)
    for key, text, expected, unit in (
        ("pursuer_radius", "the pursuer settles on a circle", RADIUS, "m"),
        ("evader_radius", "the evader settles on a circle", RADIUS, "m"),
        ("one_circle", "it is one circle (distance of the centres)", 0, "m"),
        ("distance", "their distance settles", sqrt(2.0) * RADIUS, "m"),
        ("orientation", "their relative orientation is pi/2", pi / 2, "rad"),
        ("pursuer_speed", "the pursuer travels at 1 m/s", 1.0, "m/s"),
        ("same_speed", "both travel at the same speed (ratio)", 1.0, "1"),
    )
)


def read_saturated() -> Readings:
    """The saturated law (6) beside the proportional one."""
    seen = measure(play(replace(FIG_2, law=TurningLaw.SATURATED)))
    beside = measure(play(FIG_2))
    return {
        "radius": seen.radius_evader_m,
        "smaller": seen.radius_evader_m / beside.radius_evader_m,
        "less": seen.headings_apart_rad,
        "namely": seen.headings_apart_rad,
    }


SATURATED = (
    Claim(
        "radius",
        "with (6) the radius is v/k",
        "II-C",
        "unicycles",
        2.0,
        "m",
        1e-3,
    ),
    Claim(
        "smaller",
        "and smaller than with (4) (ratio of the radii)",
        "II-C",
        "unicycles",
        1.0,
        "1",
        relation="<",
    ),
    Claim(
        "less",
        "the headings are then less than pi/2 apart",
        "II-C",
        "unicycles",
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
        "unicycles",
        pi - 2.0,
        "rad",
        1e-3,
    ),
)


def read_strategies() -> Readings:
    """The family of strategies between moving back and moving aside."""
    seen: list[FittedCircle] = [
        measure(play(replace(FIG_2, angle=angle))) for angle in ANGLES
    ]
    radii = [circle.radius_evader_m for circle in seen]
    back = play(replace(FIG_2, angle=0.0))
    times = [back.end_time - 1.0, back.end_time]
    pursuer, evader = back.poses(times)
    return {
        "apart": max(
            abs(circle.motions_apart_rad - angle)
            for circle, angle in zip(seen, ANGLES, strict=True)
        ),
        "grows": min(a / b for a, b in zip(radii, radii[1:], strict=False)),
        "unbounded": measure(play(replace(FIG_2, angle=SMALL))).radius_evader_m
        * SMALL,
        "back": _off_line(pursuer, evader),
    }


def _off_line(pursuer: Array, evader: Array) -> float:
    """Angle between the evader's way and the line of sight, in [rad].

    Zero if it moves straight away from the pursuer.

    Args:
        pursuer: Its poses at two times. Shape (2, 3).
        evader: Likewise. Shape (2, 3).
    """
    sight = evader[0, :2] - pursuer[0, :2]
    way = evader[1, :2] - evader[0, :2]
    if not np.hypot(*way) > 0.5:
        return nan
    off = np.arctan2(way[1], way[0]) - np.arctan2(sight[1], sight[0])
    return abs(wrap_angle(float(off)))


STRATEGIES = (
    Claim(
        "apart",
        "with an angle alpha the directions of motion end alpha apart "
        "(greatest difference for six angles)",
        "II-C",
        "unicycles",
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
        "unicycles",
        1.0,
        "1",
        relation=">",
    ),
    Claim(
        "unbounded",
        "without bound: as 2 v/(k alpha) (radius times alpha, at alpha = 0.1)",
        "II-C",
        "unicycles",
        4.0,
        "m",
        4e-3,
    ),
    Claim(
        "back",
        "alpha = 0 moves back (angle between the evader's way and the line "
        "of sight, at the end)",
        "II-C",
        "unicycles",
        0.0,
        "rad",
        1e-3,
    ),
)


def read_sampled() -> Readings:
    """The circle of Sec. IV with turning rates held from step to step."""
    run: SampledRun = simulate_sampled(NAO, NAO_START, 400.0, STEP)
    turns = np.diff(run.pursuer[-200:, 2])
    last = max(2, round(2.0 * pi / max(abs(float(turns[-1])), 1e-3)))
    apart = run.evader[-1] - run.pursuer[-1]
    return {
        "radius": fit_circle(run.pursuer[-last:, :2])[1],
        "distance": float(np.hypot(apart[0], apart[1])),
        "orientation": abs(wrap_angle(float(apart[2]))),
    }


SAMPLED = tuple(
    Claim(key, text, "III-B, IV", "sampled", expected, unit, 1e-3)
    for key, text, expected, unit in (
        (
            "radius",
            "holding the turning rate from step to step leaves the circle "
            "as it is",
            NAO_RADIUS,
            "m",
        ),
        (
            "distance",
            "and the distance",
            4.0 * 0.1 * sin(pi / 4) / (pi / 2 * 0.2),
            "m",
        ),
        ("orientation", "and the relative orientation", pi / 2, "rad"),
    )
)
