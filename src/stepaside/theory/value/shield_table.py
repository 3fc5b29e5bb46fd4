"""Table of a solved shield game."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import pi, tau

import numpy as np
from numpy.typing import ArrayLike

from ...core.brief_repr import brief_repr
from ...core.poses import Array, rotate
from .outcomes import evaluate_motions
from .pose_grid import PoseGrid, least_within
from .shield_game import SEGMENTS, ShieldGame
from .table import ValueTable, interpolated

NEAR = 1.1  # value over that outside, from which starts are not looked at
DISPLACED = 8  # directions of a displacement


@dataclass(frozen=True)
class ShieldTable:
    """Distance that the robot can keep for ever, by its state.

    Poses are those of the robot in the frame of the person, in [m] and
    [rad]. Shape (n, 3).
    """

    game: ShieldGame  # game that was solved
    walking: ValueTable  # guaranteed distance of a walking robot, cut off
    # That of a robot that stands for the wait, and then starts, at each node,
    # in [m]. Shape grid.shape.
    standing: Array
    # Guaranteed distance of a robot that starts with each motion of the game,
    # at the nodes of the whole grid; empty without a response. Shape (n,
    # *grid.whole().shape).
    starts: Array
    # Longest time from the decision of a standing robot until its motion
    # begins, in [s].
    response: float
    wait: float  # time until a standing robot decides again, in [s]

    __repr__ = brief_repr

    @property
    def grid(self) -> PoseGrid:
        """Grid of the tables."""
        return self.walking.grid

    @property
    def outside(self) -> float:
        """Guaranteed distance of every state outside the grid, in [m]."""
        return self.walking.rules.outside

    def arrays(self) -> dict[str, Array]:
        """Return all of the table but its game, by name."""
        return self.walking.arrays() | {
            "standing": self.standing,
            "starts": self.starts.astype(np.float32),
            "times": np.array([self.response, self.wait]),
        }

    @classmethod
    def from_arrays(
        cls, game: ShieldGame, arrays: Mapping[str, Array]
    ) -> "ShieldTable":
        """Return the table of a game from its :meth:`arrays`."""
        return cls(
            game,
            ValueTable.from_arrays(arrays),
            arrays["standing"],
            arrays["starts"].astype(np.float64),
            *arrays["times"].tolist(),
        )

    def value(self, poses: ArrayLike) -> Array:
        """Return the guaranteed distance of a walking robot, in [m]."""
        return self.walking.value(np.atleast_2d(poses))

    def standing_value(self, poses: ArrayLike) -> Array:
        """Return the guaranteed distance of a robot that stands on, in [m].

        Where it falls below what is required, the robot must start now.
        """
        states = np.atleast_2d(np.asarray(poses, dtype=np.float64))
        found = interpolated(self.standing, states, self.walking.rules)
        near = found < NEAR * self.outside
        if len(self.starts) and near.any():
            found[near] = np.minimum(found[near], self._waits(states[near]))
        return found

    def _waits(self, poses: Array) -> Array:
        """Return the value of the best start after the wait, at worst.

        The best starts at nodes are too good between nodes where different
        ones are best.
        """
        later, _ = self._stood(poses, self.wait)
        angles = tau / DISPLACED * np.arange(DISPLACED)
        radius = self.game.loss_in(self.wait) + self.game.jump
        ring = np.zeros((DISPLACED, 3))
        ring[:, :2] = rotate(radius / np.cos(pi / DISPLACED), 0.0, angles).T
        states = (later[:, None] + ring).reshape(-1, 3)
        best = self._starts(states).max(axis=0).reshape(len(poses), -1)
        worst: Array = best.min(axis=1)
        return worst

    def halting_value(
        self, poses: ArrayLike, duration: float, reach: float = 0.0
    ) -> float:
        """Return the guaranteed distance of a robot that halts, in [m].

        It stands and decides again after a duration, in [s], and comes to
        rest within a reach, in [m]. Of the poses the worst counts.
        """
        later, least = self._stood(poses, duration)
        lost = reach + self.game.loss_in(duration)
        found = self.standing_value(later) - lost
        # No state within the loss is on the grid: all count as safe.
        x, y, _ = self.grid.axes()
        ahead, aside = later[:, 0], np.abs(later[:, 1])
        beyond = (ahead < x[0] - lost) | (ahead > x[-1] + lost)
        found[beyond | (aside > y[-1] + lost)] = self.outside
        return min(least - lost, float(found.min()))

    def best_starts(self, poses: ArrayLike) -> Array:
        """Return the guaranteed distance of starts with each motion, in [m].

        The worst of the poses counts. Shape (n,) for n motions of the game.
        """
        if not len(self.starts):
            return self.outcomes(poses, self.game.motions, self.game.period)
        found: Array = self._starts(poses).min(axis=1)
        return found

    def _starts(self, poses: ArrayLike) -> Array:
        """Return the value of each start from each pose. Shape (n, m)."""
        whole = self.grid.whole()
        rules = self.walking.rules._replace(
            right=whole.right, rows=whole.shape[1]
        )
        states = np.atleast_2d(poses)
        return np.array(
            [interpolated(each, states, rules) for each in self.starts]
        )

    def start_outcomes(
        self, poses: ArrayLike, motions: Array, duration: float
    ) -> Array:
        """Return the distance that remains guaranteed after a start.

        As in :meth:`outcomes`, but the motion begins after any part of the
        response, of which none, half and all are tried. The loss meanwhile is
        taken from distances on the way.
        """
        found = self.outcomes(poses, motions, duration)
        if self.response == 0.0:
            return found
        later, least = np.atleast_2d(poses), np.inf
        loss = self.game.loss_in(self.response)
        for _ in range(SEGMENTS):
            later, closest = self._stood(later, self.response / SEGMENTS)
            least = min(least, closest)
            after = self._outcomes(
                self._eroded_at_start, later, motions, duration, loss
            )
            found = np.minimum(found, np.minimum(after, least - loss))
        return found

    @cached_property
    def _eroded_at_start(self) -> Array:
        """Least values within the disturbance of response and period."""
        loss = self.game.loss_in(self.response)
        return least_within(self.walking.after, self.grid, loss)

    def _stood(self, poses: ArrayLike, duration: float) -> tuple[Array, float]:
        """Return all poses after standing, and the least distance till then.

        Poses are those of the robot in the frame of the person. Shape (m, 3).
        """
        states = np.atleast_2d(np.asarray(poses, dtype=np.float64))
        if duration == 0.0:
            return states, np.inf
        walks = self.game.person.walks(duration)
        x = states[:, None, None, 0] - walks[:, :, 0]
        y = states[:, None, None, 1] - walks[:, :, 1]
        least = np.hypot(x, y).min() - self.game.sag(duration)
        turned = walks[:, -1, 2]
        later = np.stack(
            [
                *rotate(x[:, :, -1], y[:, :, -1], -turned),
                states[:, None, 2] - turned,
            ],
            axis=2,
        )
        return later.reshape(-1, 3), float(least)

    def outcomes(
        self, poses: ArrayLike, motions: Array, duration: float
    ) -> Array:
        """Return the distances that remain guaranteed after motions.

        Motions, of a duration in [s], are those of :func:`.sub_poses`. Of the
        poses the worst counts. Shape (n,), in [m].
        """
        return self._outcomes(self.walking.after, poses, motions, duration)

    def _outcomes(
        self,
        values: Array,
        poses: ArrayLike,
        motions: Array,
        duration: float,
        loss: float = 0.0,
    ) -> Array:
        """Return outcomes for values at the end; see :meth:`outcomes`.

        A loss before the begin reduces distances on the way.
        """
        found = np.full(len(motions), np.inf)
        sag = self.game.sag(duration) + loss
        evaluate_motions(
            values,
            np.atleast_2d(np.asarray(poses, dtype=np.float64)),
            motions,
            self.game.person.walks(duration),
            self.walking.rules._replace(sag=sag),
            found,
        )
        return found
