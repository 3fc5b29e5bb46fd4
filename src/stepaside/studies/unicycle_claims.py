"""Claims of Sec. II, measured by simulation of unicycles."""

from dataclasses import replace
from math import pi, sin, sqrt

import numpy as np

from ..unicycle.laws import Game, TurningLaw, Unicycle
from ..unicycle.measure import Measured, measure, settling_time
from ..unicycle.relative import Start
from ..unicycle.sampled import simulate_sampled
from ..unicycle.simulate import Run, simulate
from .claims import Row

FIG_2 = Game(Unicycle(1.0, 0.5), Unicycle(1.0, 0.5))
START = Start(5.0, 0.4, -0.2)
ANGLES = tuple(np.radians([15.0, 30.0, 45.0, 60.0, 75.0, 90.0]).tolist())


def play(game: Game) -> Run:
    """Play a game until its last turn is the circle."""
    return simulate(game, START, settling_time(game))


def circle_rows() -> list[Row]:
    """Rows on the circle of Fig. 2."""
    seen = measure(play(FIG_2))
    v, k = 1.0, 0.5
    radius, distance = 4 * v / (pi * k), 4 * sqrt(2.0) * v / (pi * k)

    def row(claim: str, expected: float, measured: float, unit: str) -> Row:
        return Row(
            claim, "II-C, Fig. 2", "unicycles", expected, measured, 1e-3, unit
        )

    return [
        row(
            "the pursuer ends on a circle", radius, seen.radius_pursuer_m, "m"
        ),
        row("the evader ends on a circle", radius, seen.radius_evader_m, "m"),
        row("both circles are one", 0.0, seen.centers_apart_m, "m"),
        row("their distance settles", distance, seen.distance_m, "m"),
        row(
            "relative orientation becomes pi/2",
            pi / 2,
            seen.headings_apart_rad,
            "rad",
        ),
        row(
            "both travel at the same speed (ratio on the floor)",
            1.0,
            seen.radius_evader_m / seen.radius_pursuer_m,
            "1",
        ),
    ]


def saturated_rows() -> list[Row]:
    """Rows on the saturated law (6)."""
    seen = measure(play(replace(FIG_2, law=TurningLaw.SATURATED)))
    proportional = 4.0 / (pi * 0.5)
    return [
        Row(
            "with (6) the radius is v/k",
            "II-C",
            "unicycles",
            2.0,
            seen.radius_evader_m,
            1e-3,
            "m",
        ),
        Row(
            "and smaller than with (4)",
            "II-C",
            "unicycles",
            proportional,
            seen.radius_evader_m,
            0.0,
            "m",
            "<",
        ),
        Row(
            "the headings are then less than pi/2 apart",
            "II-C",
            "unicycles",
            pi / 2,
            seen.headings_apart_rad,
            0.0,
            "rad",
            "<",
            "relative orientation; the directions of motion are 2 rad apart",
        ),
        Row(
            "namely pi - 2",
            "II-C",
            "unicycles",
            pi - 2.0,
            seen.headings_apart_rad,
            1e-3,
            "rad",
        ),
    ]


def strategy_rows() -> list[Row]:
    """Rows on the family of strategies between moving back and aside."""
    seen: list[Measured] = [
        measure(play(replace(FIG_2, angle=angle))) for angle in ANGLES
    ]
    apart = max(
        abs(circle.motions_apart_rad - angle)
        for circle, angle in zip(seen, ANGLES, strict=True)
    )
    radii = [circle.radius_evader_m for circle in seen]
    growth = min(a / b for a, b in zip(radii, radii[1:], strict=False))
    small = 0.1
    limit = measure(play(replace(FIG_2, angle=small))).radius_evader_m
    back = play(replace(FIG_2, angle=0.0))
    ends, lasts = back.poses([back.end_time - 1.0, back.end_time])
    return [
        Row(
            "with an angle alpha the directions of motion end alpha apart",
            "II-C",
            "unicycles",
            0.0,
            apart,
            1e-4,
            "rad",
            as_printed="relative orientation alpha; headings: pi - alpha. "
            "(5) with alpha read literally walks into the pursuer",
        ),
        Row(
            "the radius grows as alpha falls (least ratio of neighbours)",
            "II-C",
            "unicycles",
            1.0,
            growth,
            0.0,
            "1",
            ">",
        ),
        Row(
            "without bound: the radius is 2 v/(k alpha), at alpha = 0.1",
            "II-C",
            "unicycles",
            2.0 / (0.5 * small),
            limit,
            0.04,
            "m",
        ),
        Row(
            "alpha = 0 moves straight back (turning rate at the end)",
            "II-C",
            "unicycles",
            0.0,
            float(abs(np.diff(lasts[:, 2])[0]) + abs(np.diff(ends[:, 2])[0])),
            1e-3,
            "rad/s",
        ),
    ]


def sampled_rows() -> list[Row]:
    """The circle of Sec. IV with turning rates held from step to step."""
    v, k, step = 0.1, 0.2, 0.4
    game = Game(Unicycle(v, k), Unicycle(v, k))
    run = simulate_sampled(game, Start(1.0, 0.3, -0.1), 400.0, step)
    turn = float(run.turning_rates[-1, 0])
    apart = run.evader[-1] - run.pursuer[-1]
    distance = float(np.hypot(apart[0], apart[1]))
    heading = float(np.abs((apart[2] + pi) % (2 * pi) - pi))
    section = "III-B, IV"
    return [
        Row(
            "holding the rate from step to step leaves the circle as it is",
            section,
            "sampled",
            4 * v / (pi * k),
            v / abs(turn),
            1e-3,
            "m",
        ),
        Row(
            "and the distance",
            section,
            "sampled",
            4 * v * sin(pi / 4) / (pi / 2 * k),
            distance,
            1e-3,
            "m",
        ),
        Row(
            "and the relative orientation",
            section,
            "sampled",
            pi / 2,
            heading,
            1e-3,
            "rad",
        ),
    ]
