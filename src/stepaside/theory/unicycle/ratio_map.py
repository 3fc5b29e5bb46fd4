"""Map of the limit circles over the ratios of speeds and gains."""

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .circles import GameParameters, find_equilibria
from .unicycle_game import TurningLaw

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class RatioMap:
    """Distances on circles consistent with the side behind the evader.

    Lengths are in units of the evader's speed over the pursuer's gain. The
    arrays over both ratios have shape (n, m) and are NaN where no such
    circle exists.

    Attributes:
        speed_ratios: Pursuer's over evader's speed. Shape (n,).
        gain_ratios: Evader's over pursuer's gain. Shape (m,).
        main: Distance on the slowest circle with the main sense of rotation.
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
    """Compute the circles of all games on a grid of ratios.

    The evasion angle is in [rad]; ratios are those of :class:`RatioMap`.
    """
    speeds = np.asarray(speed_ratios, dtype=np.float64)
    gains = np.asarray(gain_ratios, dtype=np.float64)
    grid = np.meshgrid(speeds, gains, indexing="ij")
    vp, ke = (axis.ravel() for axis in grid)
    games = GameParameters.of(vp, 1.0, 1.0, ke, angle)
    saturated = TurningLaw(law) is TurningLaw.SATURATED
    equilibria = find_equilibria(games, saturated=saturated)
    modes = equilibria.eigenvalues(games, saturated=saturated)
    growth = modes.real.max(axis=-1)
    bearing = equilibria.evader_error - angle
    behind = (bearing > -pi) & (bearing < 0.0)

    def least(which: NDArray[np.bool_], values: Array) -> Array:
        found = np.full(len(vp), np.inf)
        np.minimum.at(found, equilibria.game[which], values[which])
        found[np.isinf(found)] = np.nan
        return found

    onward = behind & (equilibria.turning_rate > 0.0)
    slowest = least(onward, equilibria.turning_rate)[equilibria.game]
    first = onward & (equilibria.turning_rate == slowest)
    backward = behind & (equilibria.turning_rate < 0.0)
    shape = (len(speeds), len(gains))
    return RatioMap(
        speeds,
        gains,
        least(first, equilibria.distance).reshape(shape),
        least(backward & (growth < 0.0), equilibria.distance).reshape(shape),
        least(backward & (growth >= 0.0), equilibria.distance).reshape(shape),
    )
