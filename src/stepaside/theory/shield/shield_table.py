"""Table of a solved shield game."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ...core.brief_repr import brief_repr
from .shield_game import Array, PoseGrid, ShieldGame
from .shield_outcomes import evaluate_motions, look_up_all


@dataclass(frozen=True)
class ShieldTable:
    """Distance that the robot can keep for ever, by its state.

    Attributes:
        game: Game that was solved.
        grid: Grid of the tables.
        values: Guaranteed distance at each node, cut off, in [m]. Shape
            ``grid.shape``.
        eroded: Least value within the disturbance, likewise.
        standing: Guaranteed distance of a robot that stands for the response
            time first, likewise.
        outside: Guaranteed distance of every state outside the grid, in [m].
        response: The response time, in [s].
        seconds: Computing time, in [s].
    """

    game: ShieldGame
    grid: PoseGrid
    values: Array
    eroded: Array
    standing: Array
    outside: float
    response: float
    seconds: float

    __repr__ = brief_repr

    def value(self, poses: ArrayLike) -> Array:
        """Return the guaranteed distance of a walking robot.

        Args:
            poses: Poses of the robot in the frame of the person, in [m] and
                [rad]. Shape (n, 3).

        Returns:
            Distances, in [m]. Shape (n,).
        """
        return self._look_up(self.values, poses)

    def standing_value(self, poses: ArrayLike) -> Array:
        """Return the guaranteed distance of a robot that stands at first.

        Where it falls below what is required, the robot must start now.

        Args:
            poses: As in :meth:`value`.
        """
        return self._look_up(self.standing, poses)

    def outcomes(
        self, poses: ArrayLike, motions: Array, duration: float
    ) -> Array:
        """Return the distance that remains guaranteed after a motion.

        Args:
            poses: Poses of the robot in the frame of the person, of which the
                worst counts. Shape (m, 3).
            motions: Motions of the robot; see
                :func:`.shield_game.sub_poses`. Shape (n, parts, 3).
            duration: Their duration, in [s].

        Returns:
            Least distance on the way and value after it, at worst, in [m].
            Shape (n,).
        """
        walks = self.game.person.walks(duration, self.game.more_turn)
        found = np.full(len(motions), np.inf)
        out = np.empty(len(motions))
        for pose in np.atleast_2d(np.asarray(poses, dtype=np.float64)):
            evaluate_motions(
                self.eroded,
                pose,
                motions,
                walks,
                self.game.sag,
                self.grid,
                self.outside,
                out,
            )
            found = np.minimum(found, out)
        return found

    def _look_up(self, table: Array, poses: ArrayLike) -> Array:
        states = np.atleast_2d(np.asarray(poses, dtype=np.float64))
        out = np.empty(len(states))
        look_up_all(table, states, self.grid, self.outside, out)
        return out
