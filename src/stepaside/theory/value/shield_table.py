"""Table of a solved shield game."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import pi, tau

import numpy as np
from numpy.typing import ArrayLike

from ...core.brief_repr import brief_repr
from ...core.poses import Array
from .outcomes import evaluate_motions
from .pose_grid import PoseGrid, least_within
from .shield_game import SEGMENTS, ShieldGame
from .solver import make_rules
from .table import interpolated

NUMBERS = ("outside", "response", "wait", "seconds")
NEAR = 1.1  # value over that outside, from which starts are not looked at
DISPLACED = 8  # directions of a displacement


@dataclass(frozen=True)
class ShieldTable:
    """Distance that the robot can keep for ever, by its state.

    Attributes:
        game: Game that was solved.
        grid: Grid of the tables.
        values: Guaranteed distance at each node, cut off, in [m]. Shape
            ``grid.shape``.
        eroded: Least value within the disturbance, likewise.
        standing: Guaranteed distance of a robot that stands for the wait, and
            then starts, likewise.
        starts: Guaranteed distance of a robot that starts with each motion of
            the game, at the nodes of the whole grid; empty without a
            response. Shape ``(n, *grid.whole().shape)``.
        outside: Guaranteed distance of every state outside the grid, in [m].
        response: Longest time from the decision of a standing robot until its
            motion begins, in [s].
        wait: Time until a standing robot decides again, in [s].
        seconds: Computing time, in [s].
    """

    game: ShieldGame
    grid: PoseGrid
    values: Array
    eroded: Array
    standing: Array
    starts: Array
    outside: float
    response: float
    wait: float
    seconds: float

    __repr__ = brief_repr

    def arrays(self) -> dict[str, Array]:
        """Return all of the table but its game, by name."""
        names = ("values", "eroded", "standing")
        found = {name: getattr(self, name) for name in names}
        numbers = [getattr(self, name) for name in NUMBERS]
        grid = [self.grid.left, self.grid.spacing]
        return found | {
            "starts": self.starts.astype(np.float32),
            "numbers": np.array([*grid, *numbers]),
        }

    @classmethod
    def from_arrays(
        cls, game: ShieldGame, arrays: Mapping[str, Array]
    ) -> "ShieldTable":
        """Return the table of a game from its :meth:`arrays`."""
        left, spacing, *numbers = arrays["numbers"].tolist()
        values, eroded = arrays["values"], arrays["eroded"]
        i, j, k = values.shape
        return cls(
            game,
            PoseGrid(left, spacing, (i, j, k)),
            values,
            eroded,
            arrays["standing"],
            arrays["starts"].astype(np.float64),
            *numbers,
        )

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
        """Return the guaranteed distance of a robot that stands on.

        Where it falls below what is required, the robot must start now.

        Args:
            poses: As in :meth:`value`.
        """
        states = np.atleast_2d(np.asarray(poses, dtype=np.float64))
        found = self._look_up(self.standing, states)
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
        ring = (
            radius
            / np.cos(pi / DISPLACED)
            * np.array([np.cos(angles), np.sin(angles), 0.0 * angles])
        )
        states = (later[:, None] + ring.T).reshape(-1, 3)
        best = self._starts(states).max(axis=0).reshape(len(poses), -1)
        worst: Array = best.min(axis=1)
        return worst

    def halting_value(
        self, poses: ArrayLike, duration: float, reach: float = 0.0
    ) -> float:
        """Return the guaranteed distance of a robot that halts.

        Args:
            poses: Poses of the robot in the frame of the person, of which the
                worst counts. Shape (m, 3).
            duration: Time until it stands and decides again, in [s].
            reach: Distance within which it comes to rest, in [m].
        """
        later, least = self._stood(poses, duration)
        lost = reach + self.game.loss_in(duration)
        found = self.standing_value(later) - lost
        # No state within the loss is on the grid: all count as safe.
        found[self._is_beyond(later, lost)] = self.outside
        return min(least - lost, float(found.min()))

    def _is_beyond(self, poses: Array, margin: float) -> Array:
        """Return whether states are farther from the grid than a margin."""
        x, y, _ = self.grid.axes()
        beyond: Array = (
            (poses[:, 0] < x[0] - margin)
            | (poses[:, 0] > x[-1] + margin)
            | (np.abs(poses[:, 1]) > y[-1] + margin)
        )
        return beyond

    def best_starts(self, poses: ArrayLike) -> Array:
        """Return the guaranteed distance of starts with each motion.

        Args:
            poses: As in :meth:`halting_value`.

        Returns:
            Distances, in [m]. Shape (n,) for n motions of the game.
        """
        if not len(self.starts):
            return self.outcomes(poses, self.game.motions, self.game.period)
        found: Array = self._starts(poses).min(axis=1)
        return found

    def _starts(self, poses: ArrayLike) -> Array:
        """Return the value of each start from each pose. Shape (n, m)."""
        grid = self.grid.whole()
        return np.array(
            [self._look_up(each, poses, grid) for each in self.starts]
        )

    def start_outcomes(
        self, poses: ArrayLike, motions: Array, duration: float
    ) -> Array:
        """Return the distance that remains guaranteed after a start.

        The motion begins after any part of the response, of which none, half
        and all are tried. The loss meanwhile is taken from distances on the
        way.

        Args:
            poses: As in :meth:`outcomes`.
            motions: As in :meth:`outcomes`.
            duration: As in :meth:`outcomes`.
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
        return least_within(self.eroded, self.grid, loss)

    def _stood(self, poses: ArrayLike, duration: float) -> tuple[Array, float]:
        """Return all poses after standing, and the least distance till then.

        Args:
            poses: Poses of the robot in the frame of the person. Shape
                (m, 3).
            duration: Time for which the robot stands, in [s].
        """
        states = np.atleast_2d(np.asarray(poses, dtype=np.float64))
        if duration == 0.0:
            return states, np.inf
        walks = self.game.person.walks(duration)
        x = states[:, None, None, 0] - walks[:, :, 0]
        y = states[:, None, None, 1] - walks[:, :, 1]
        least = np.hypot(x, y).min() - self.game.sag(duration)
        x, y, turned = x[:, :, -1], y[:, :, -1], walks[:, -1, 2]
        c, s = np.cos(turned), np.sin(turned)
        theta = states[:, None, 2] - turned
        later = np.stack([c * x + s * y, c * y - s * x, theta], axis=2)
        return later.reshape(-1, 3), float(least)

    def outcomes(
        self, poses: ArrayLike, motions: Array, duration: float
    ) -> Array:
        """Return the distance that remains guaranteed after a motion.

        Args:
            poses: Poses of the robot in the frame of the person, of which the
                worst counts. Shape (m, 3).
            motions: Motions of the robot; see
                :func:`.sub_poses`. Shape (n, parts, 3).
            duration: Their duration, in [s].

        Returns:
            Least distance on the way and value after it, at worst, in [m].
            Shape (n,).
        """
        return self._outcomes(self.eroded, poses, motions, duration)

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
            make_rules(self.grid, self.outside, sag=sag),
            found,
        )
        return found

    def _look_up(
        self, table: Array, poses: ArrayLike, grid: PoseGrid | None = None
    ) -> Array:
        rules = make_rules(grid or self.grid, self.outside)
        return interpolated(table, np.atleast_2d(poses), rules)
