"""Readings for the claims of Sec. II, by simulation of unicycles."""

from dataclasses import replace
from math import nan, pi

import numpy as np

from ..core.poses import Array, wrap_angle
from ..games.floor_games import play_unicycles
from ..games.unicycle_settings import PAPER
from ..theory.unicycle.adaptive_simulation import PlayedGame, simulate
from ..theory.unicycle.circle_fit import fit_circle, measure, settling_time
from ..theory.unicycle.unicycle_game import (
    Game,
    RelativeStart,
    TurningLaw,
    Unicycle,
)

FIG_2 = Game(Unicycle(1.0, 0.5), Unicycle(1.0, 0.5))
START = RelativeStart(5.0, 0.4, -0.2)
ANGLES = tuple(np.radians([15.0, 30.0, 45.0, 60.0, 75.0, 90.0]).tolist())
SMALL_ANGLE = 0.1  # evasion angle near "move back", in [rad]
NAO = Game(Unicycle(0.1, 0.2), Unicycle(0.1, 0.2))
NAO_START = RelativeStart(1.0, 0.3, -0.1)
STEP = 0.4  # path time of a step, in [s]


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
    saturated = measure(play(replace(FIG_2, law=TurningLaw.SATURATED)))
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


def read_sampled() -> dict[str, float]:
    """Measure the circle of Sec. IV with turning rates held between steps."""
    run = play_unicycles(NAO, NAO_START, PAPER, (400.0, STEP), 1e-6)
    turns = np.diff(run.pursuer[-200:, 2])
    last = max(2, round(2.0 * pi / max(abs(float(turns[-1])), 1e-3)))
    difference = run.evader[-1] - run.pursuer[-1]
    return {
        "radius": fit_circle(run.pursuer[-last:, :2])[1],
        "distance": float(np.hypot(difference[0], difference[1])),
        "orientation": abs(wrap_angle(float(difference[2]))),
    }
