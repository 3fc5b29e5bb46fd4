"""Table of a solved game: values and decisions of both players."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.brief_repr import brief_repr
from ...core.poses import Array
from .outcomes import OutcomeRules, choose_all, look_up_all
from .pose_grid import PoseGrid

Numbers = NDArray[np.int64]
TIE = 1e-3  # weight of the value after a period where it decides nothing


@dataclass(frozen=True)
class ValueTable:
    """Distance that a robot can keep, by its pose in the opponent's frame.

    Attributes:
        grid: Grid of the poses.
        values: Distances of the nodes, in [m]. Shape ``grid.shape``.
        after: Least values within the disturbance, likewise.
        motions: Motions of the robot. Shape (n, parts, 3).
        answers: Motions of its opponent. Shape (m, parts, 3).
        rules: How outcomes are read from the values.
        seconds: Computing time, in [s].
    """

    grid: PoseGrid
    values: Array
    after: Array
    motions: Array
    answers: Array
    rules: OutcomeRules
    seconds: float

    __repr__ = brief_repr

    def value(self, poses: ArrayLike) -> Array:
        """Return the distance that the robot can keep.

        Args:
            poses: Poses of the robot in the frame of its opponent, in [m]
                and [rad]. Shape (..., 3).

        Returns:
            Distances, in [m], between those of the nodes and at most the
            present one. Shape (...).
        """
        return interpolated(self.values, poses, self.rules)

    def best_motion(self, poses: ArrayLike) -> Numbers:
        """Return the number of the motion that keeps the largest distance.

        Where it does not matter, the value after it decides.

        Args:
            poses: As in :meth:`value`.
        """
        chosen: Numbers = self.decisions(poses)[..., 0]
        return chosen

    def decisions(self, poses: ArrayLike) -> Numbers:
        """Return the numbers of best motions and of answers to them.

        Args:
            poses: As in :meth:`value`.

        Returns:
            Numbers. Shape (..., 2).
        """
        states = np.asarray(poses, dtype=np.float64)
        out = np.zeros((states.size // 3, 2), np.int64)
        choose_all(
            self.after,
            np.ascontiguousarray(states.reshape(-1, 3)),
            self.motions,
            self.answers,
            self.rules._replace(tie=TIE),
            out,
        )
        return out.reshape(*states.shape[:-1], 2)


def interpolated(
    values: Array, poses: ArrayLike, rules: OutcomeRules
) -> Array:
    """Interpolate values of nodes; see :meth:`ValueTable.value`."""
    states = np.asarray(poses, dtype=np.float64)
    out = np.empty(states.size // 3)
    rows = np.ascontiguousarray(states.reshape(-1, 3))
    look_up_all(values, rows, rules, out)
    return out.reshape(states.shape[:-1])
