"""Circles fitted to the final part of a simulated game."""

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

from ...core.poses import wrap_angle
from .adaptive_simulation import PlayedGame
from .batch import circle_deviations, circle_states
from .circles import Circle, circles_of
from .relative_motion import NEAR
from .unicycle_game import Game

Array = NDArray[np.float64]
PRECISION = 1e-6  # to which a deviation from the circle has decayed
SAMPLES = 361  # of a path


@dataclass(frozen=True, slots=True)
class FittedCircle:
    """Circles fitted to two paths, with the quantities of ``Circle``.

    The distance is the final one, the turning rate the pursuer's mean.
    """

    radius_pursuer_m: float
    radius_evader_m: float
    distance_m: float
    turning_rate_rad_s: float
    headings_apart_rad: float
    motions_apart_rad: float
    centers_apart_m: float


def fit_circle(points: Array) -> tuple[Array, float]:
    """Fit centre (2,) and radius of a circle to points (n, 2), in [m].

    Linear least squares.
    """
    origin = points.mean(axis=0)
    local = points - origin
    matrix = np.column_stack([2.0 * local, np.ones(len(local))])
    squares = (local**2).sum(axis=1)
    (x, y, rest), *_ = np.linalg.lstsq(matrix, squares, rcond=None)
    return origin + (x, y), float(np.sqrt(rest + x * x + y * y))


def circle_at(
    circles: tuple[Circle, ...], state: Array, side: int
) -> Circle | None:
    """Find the circle that a state r, a, psi is on, to 2 % and 0.02 rad."""
    if not circles:
        return None
    errors = circle_deviations(circle_states(circles), state[None], [side])
    nearest = int(errors[:, 0].argmin())
    return circles[nearest] if errors[nearest, 0] <= NEAR else None


def settling_time(game: Game) -> float:
    """Return the duration after which the last turn is a circle, in [s]."""
    gain = min(game.pursuer.gain, game.evader.gain)
    ends = [
        -np.log(PRECISION) * circle.time_constant_s
        + 2.0 * pi / abs(circle.turning_rate_rad_s)
        for circle in circles_of(game)
        if circle.stable
    ]
    return float(30.0 / gain + max(ends, default=30.0 / gain))


def measure(run: PlayedGame) -> FittedCircle:
    """Fit circles to the last turn of a game, or its last tenth if shorter."""
    last = run.states([run.end_time])[0, :3]
    circle = circle_at(circles_of(run.game), last, run.sides[-1])
    span = 0.1 * run.end_time
    if circle is not None:
        turn = 2.0 * pi / abs(circle.turning_rate_rad_s)
        span = min(turn, 0.5 * run.end_time)
    times = np.linspace(run.end_time - span, run.end_time, SAMPLES)
    pursuer, evader = run.poses(times)
    center_p, radius_p = fit_circle(pursuer[:, :2])
    center_e, radius_e = fit_circle(evader[:, :2])
    heading = float(pursuer[-1, 2] - evader[-1, 2])
    return FittedCircle(
        radius_p,
        radius_e,
        float(np.hypot(*(evader[-1, :2] - pursuer[-1, :2]))),
        float(pursuer[-1, 2] - pursuer[0, 2]) / span,
        abs(wrap_angle(heading)),
        abs(wrap_angle(heading + pi)),
        float(np.hypot(*(center_p - center_e))),
    )
