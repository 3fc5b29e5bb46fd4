"""The circles of a game over the ratios of speeds and of gains."""

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .equilibria import GameParameters, find_rests, growth_rates
from .unicycle_game import TurningLaw

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class RatioMap:
    """Distances on circles that agree with the side behind the evader.

    Lengths are in units of the evader's speed over the pursuer's gain. The
    arrays over both ratios have shape (n, m); NaN where there is no such
    circle.

    Attributes:
        speed_ratios: Pursuer's over evader's speed. Shape (n,).
        gain_ratios: Evader's over pursuer's gain. Shape (m,).
        main: Distance on the slowest circle that turns the main way round.
        reversed_stable: Least distance on a stable reversed circle.
        reversed_unstable: Least distance on an unstable reversed circle.
    """

    speed_ratios: Array
    gain_ratios: Array
    main: Array
    reversed_stable: Array
    reversed_unstable: Array


def map_ratios(
    angle: float,
    law: TurningLaw | str,
    speed_ratios: ArrayLike,
    gain_ratios: ArrayLike,
) -> RatioMap:
    """Find the circles of all games on a grid of ratios.

    Args:
        angle: Evasion angle in [0, pi], in [rad].
        law: Turning law of the evader.
        speed_ratios: Pursuer's over evader's speed. Shape (n,).
        gain_ratios: Evader's over pursuer's gain. Shape (m,).

    Returns:
        The map.
    """
    speeds = np.asarray(speed_ratios, dtype=np.float64)
    gains = np.asarray(gain_ratios, dtype=np.float64)
    grid = np.meshgrid(speeds, gains, indexing="ij")
    vp, ke = (axis.ravel() for axis in grid)
    games = GameParameters.of(vp, 1.0, 1.0, ke, angle)
    saturated = TurningLaw(law) is TurningLaw.SATURATED
    rests = find_rests(games, saturated=saturated)
    growth = growth_rates(rests, games, saturated=saturated)
    bearing = rests.evader_error - angle
    behind = (bearing > -pi) & (bearing < 0.0)

    def least(which: NDArray[np.bool_], values: Array) -> Array:
        found = np.full(len(vp), np.inf)
        np.minimum.at(found, rests.game[which], values[which])
        found[np.isinf(found)] = np.nan
        return found

    onward = behind & (rests.turning_rate > 0.0)
    slowest = least(onward, rests.turning_rate)[rests.game]
    first = onward & (rests.turning_rate == slowest)
    backward = behind & (rests.turning_rate < 0.0)
    shape = (len(speeds), len(gains))
    return RatioMap(
        speeds,
        gains,
        least(first, rests.distance).reshape(shape),
        least(backward & (growth < 0.0), rests.distance).reshape(shape),
        least(backward & (growth >= 0.0), rests.distance).reshape(shape),
    )
