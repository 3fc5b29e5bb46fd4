"""Fit of a pursuer model to the path that was seen: its heading and error."""

from math import atan2, cos, hypot, sin
from typing import Any

import numpy as np

from ...core.compilation import compiled, inlined
from .step_motion import PlayerPair, PursuerModel, Rules, pursuer_turn

ITERATIONS = 4  # of Gauss-Newton; without noise the error is below 1e-9 m
STEP = 1e-4  # of the finite difference, in [rad]


@inlined
def follow_model(
    path: Any, heading: float, model: PursuerModel, rules: Rules, off: Any
) -> tuple[float, float, float]:
    """Walk along a path as a model turns; return the pose at its end.

    Args:
        path: As in :func:`fit_heading`.
        heading: Heading at the beginning, in [rad].
        model: Model of the pursuer.
        rules: Rules of the steps.
        off: Output: positions on the path less those of the model, and less
            their mean, in [m]. Shape (n, 2).
    """
    x = y = mean_x = mean_y = 0.0
    for k in range(len(path)):
        off[k, 0], off[k, 1] = path[k, 3] - x, path[k, 4] - y
        mean_x += off[k, 0] / len(path)
        mean_y += off[k, 1] / len(path)
        if k + 1 < len(path):
            both = PlayerPair(
                path[k, 0],
                path[k, 1],
                cos(path[k, 2]),
                sin(path[k, 2]),
                path[k, 3],
                path[k, 4],
                cos(heading),
                sin(heading),
            )
            dx, dy, steps = path[k + 1, 3:] - path[k, 3:]
            turn = steps * pursuer_turn(both, model, rules)
            way = hypot(dx, dy)
            x += way * cos(heading + 0.5 * turn)
            y += way * sin(heading + 0.5 * turn)
            heading += turn
    for k in range(len(path)):
        off[k, 0] -= mean_x
        off[k, 1] -= mean_y
    return x + mean_x, y + mean_y, heading


@compiled
def fit_heading(
    path: Any, model: PursuerModel, rules: Rules
) -> tuple[tuple[float, float, float], float]:
    """Fit initial heading and position of a model to a path.

    The turn of each step follows from the model, its length from the path.

    Args:
        path: Poses (x [m], y [m], theta [rad]) of the evader, positions of
            the pursuer [m] and times [steps], in a frame whose origin is the
            centre of the room. Shape (n, 6), n > 1.
        model: Model of the pursuer.
        rules: Rules of the steps.

    Returns:
        Pose (x [m], y [m], theta [rad]) of the pursuer at the end of the
        path, and the mean squared distance from the path, in [m^2].
    """
    n = len(path)
    off, other = np.empty((n, 2)), np.empty((n, 2))
    begin = atan2(path[1, 4] - path[0, 4], path[1, 3] - path[0, 3])
    end = follow_model(path, begin, model, rules, off)
    for _ in range(ITERATIONS):
        follow_model(path, begin + STEP, model, rules, other)
        slope = square = 0.0
        for k in range(n):
            for i in range(2):
                change = (other[k, i] - off[k, i]) / STEP
                slope += change * off[k, i]
                square += change * change
        if square > 0.0:
            begin -= min(max(slope / square, -0.5), 0.5)
        end = follow_model(path, begin, model, rules, off)
    return end, float((off * off).sum()) / n
