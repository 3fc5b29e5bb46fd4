r"""Game of a person and a robot that must never be touched.

The state is the pose of the robot in the frame of the person (x ahead, y to
the left). At each decision the robot commits to a motion for a period; the
person then walks at any speed up to :math:`V` and turns at any rate up to
:math:`V / R`; and at the end the state is displaced by up to a disturbance.
Outside the grid the value is just above the required one, if it is in a layer
along the edges that no single motion can jump over. See docs/shield-proof.md.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from math import ceil, cos, pi, sin, tau

import numpy as np
from numpy.typing import ArrayLike

from ...core.errors import check_positive
from ...core.poses import Array, rotate
from .chauffeur import guaranteed_distance
from .outcomes import PoseGrid, evaluate_motions
from .table import (
    PARTS,
    ValueTable,
    interpolated,
    least_within,
    mirrored,
    no_answer,
    solve_game,
    step_back,
    sub_poses,
)

TURNS = 7  # of a person who walks at full speed
OBLIQUE_TURNS = 3  # of one who walks beside the heading that is known
SLOW_TURNS = 3  # of one who walks at half speed, or turns on the spot
SEGMENTS = 2  # of a response, between which the person changes its walk
CELLS = 10  # in the required distance
HEADINGS = 24
STILL = 1e-4  # change in a period that counts as none, of the cut-off
CUT = 1.5  # cut-off of the values over the required distance
SAFE = 1.001  # value outside the grid over the required distance
GROWTH = 1.5  # of the grid, where states outside are not safe
TRIALS = 3
NEAR = 1.1  # value over that outside, from which starts are not looked at
DISPLACED = 8  # directions of a displacement


@dataclass(frozen=True, slots=True, eq=False)
class ShieldGame:
    """Person, motions of the robot, and disturbance of a sampled game."""

    person_speed: float  # greatest speed of the person, in [m/s]
    # Radius of its tightest turn at that speed, in [m]; the turning rate that
    # follows bounds slower walks, too.
    turning_radius: float
    # Poses in the frame of the robot, see sub_poses; with each its mirror
    # image. Shape (n, PARTS, 3).
    motions: Array
    period: float  # time between two decisions of the robot, in [s]
    # Radius of the disturbance of the position per period, in [m].
    loss: float = 0.0
    # Radius of a further disturbance at each decision, in [m].
    jump: float = 0.0
    # Greatest angle between the walk of the person and the heading by which
    # it is known, in [rad].
    heading_error: float = 0.0

    @property
    def person_turn(self) -> float:
        """Greatest turning rate of the person, in [rad/s]."""
        return self.person_speed / self.turning_radius

    @property
    def speed(self) -> float:
        """Greatest speed of the robot, in [m/s]."""
        ends = self.motions[:, -1]
        return float(np.hypot(ends[:, 0], ends[:, 1]).max()) / self.period

    @property
    def turn(self) -> float:
        """Greatest turning rate of the robot, in [rad/s]."""
        return float(np.abs(self.motions[:, -1, 2]).max()) / self.period

    @property
    def slowest(self) -> float:
        """Speed that losses leave the robot at least, in [m/s]."""
        return self.speed - self.disturbance / self.period

    @property
    def disturbance(self) -> float:
        """Radius of the disturbance from one decision to the next, in [m]."""
        return self.loss + self.jump

    def walks(self, duration: float) -> Array:
        """Return the walks that are tried against the robot.

        They are poses in the initial frame, for a duration in [s]. Shape (n,
        PARTS, 3).
        """
        most, speed = self.person_turn, self.person_speed
        twists = [
            (share * speed, 0.0, rate)
            for share, count in ((1.0, TURNS), (0.5, SLOW_TURNS), (0.0, 3))
            for rate in np.linspace(-most, most, count)
        ]
        for off in (-self.heading_error, self.heading_error):
            ahead, left = speed * cos(off), speed * sin(off)
            twists += [
                (ahead, left, rate)
                for rate in np.linspace(-most, most, OBLIQUE_TURNS)
                if off
            ]
        return sub_poses(twists, duration)

    def sag(self, duration: float) -> float:
        """Return the greatest deviation from the chord of a part, in [m]."""
        part = duration / PARTS
        person = self.person_speed * self.person_turn
        return (person + self.speed * self.turn) * part**2 / 8.0

    def loss_in(self, duration: float) -> float:
        """Return the disturbance within a duration, in [m]."""
        return self.loss * duration / self.period

    def approach(self, duration: float, grid: PoseGrid) -> float:
        """Return how far the person moves a state at most in a time, in [m].

        A turn of the person moves far states by more than near ones.
        """
        speed = self.person_speed + self.person_turn * grid.farthest
        return speed * duration

    def layer(self, stands: float, grid: PoseGrid) -> float:
        """Return the width of the layer that no motion jumps over, in [m].

        Before a motion the robot may stand for a time, in [s].
        """
        loss = self.disturbance + self.loss_in(stands)
        approach = self.approach(self.period + stands, grid)
        return approach + self.speed * self.period + loss


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

    @property
    def grid(self) -> PoseGrid:
        """Grid of the tables."""
        return self.walking.grid

    @property
    def outside(self) -> float:
        """Guaranteed distance of every state outside the grid, in [m]."""
        return self.grid.outside

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
        found = interpolated(self.standing, states, self.grid)
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
        best = self._starts((later[:, None] + ring).reshape(-1, 3)).max(axis=0)
        worst: Array = best.reshape(len(poses), -1).min(axis=1)
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
        found: Array = self._starts(np.atleast_2d(poses)).min(axis=1)
        return found

    def _starts(self, poses: Array) -> Array:
        """Return the value of each start from each pose. Shape (n, m)."""
        whole = self.grid.whole()
        return np.array([interpolated(v, poses, whole) for v in self.starts])

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
        walks = self.game.walks(duration)
        x = states[:, None, None, 0] - walks[:, :, 0]
        y = states[:, None, None, 1] - walks[:, :, 1]
        least = np.hypot(x, y).min() - self.game.sag(duration)
        turned = walks[:, -1, 2]
        moved = rotate(x[:, :, -1], y[:, :, -1], -turned)
        later = np.stack([*moved, states[:, None, 2] - turned], axis=2)
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
        evaluate_motions(
            values,
            np.atleast_2d(np.asarray(poses, dtype=np.float64)),
            motions,
            self.game.walks(duration),
            self.grid._replace(sag=self.game.sag(duration) + loss),
            found,
        )
        return found


def solve_shield(
    game: ShieldGame,
    least: float,
    *,
    response: float = 0.0,
    wait: float = 0.0,
    cells: int = CELLS,
    headings: int = HEADINGS,
) -> ShieldTable:
    """Compute the distance that the robot can keep from every state.

    Args:
        game: Person, motions and disturbance.
        least: Distance that is required, in [m]; values above 1.5 times it
            are cut off.
        response: Longest time from the decision of a standing robot until its
            motion begins, in [s].
        wait: Time until a standing robot decides again, in [s].
        cells: Number of cells in the required distance.
        headings: Number of headings.

    Returns:
        Tables. States outside the grid may turn out unsafe where the robot is
        too slow, or the required distance too large, for the person.
    """
    check_positive(least, "least", "m")
    stands, scale = response + wait, GROWTH
    still, ratio = STILL * CUT * least, game.slowest / game.person_speed
    hopeless = ratio <= 1e-6  # as it is for a point without turns
    if 1e-6 < ratio < 1.0:
        keepable = game.turning_radius * guaranteed_distance(ratio)
        hopeless = least >= keepable
    for _ in range(0 if hopeless else TRIALS):
        grid = _cover(game, least, scale * stands, scale, cells, headings)
        layer = game.layer(stands, grid)

        walking = solve_game(
            game.motions,
            game.walks(game.period),
            grid._replace(sag=game.sag(game.period)),
            disturbance=game.disturbance,
            until=still,
            most=CUT * least,
            # States outside are just safe if those along the edges are.
            outside=partial(_outside, least, layer, grid),
            reach=layer,
        )
        if walking.grid.outside and walking.change < still:
            standing, starts = _standing(game, walking, response, wait)
            most = game.approach(wait, grid) + game.loss_in(wait)
            if _edge(standing, most, grid) >= least:
                return ShieldTable(
                    game, walking, standing, starts, response, wait
                )
        scale *= GROWTH
    grid = PoseGrid(-least, least / cells, 2, 2, headings)
    nothing = solve_game(
        game.motions, no_answer(), grid, most=0.0, outside=lambda _: 0.0
    )
    starts = np.zeros((0, *grid.whole().shape))
    return ShieldTable(game, nothing, nothing.values, starts, response, wait)


def _outside(least: float, layer: float, grid: PoseGrid, v: Array) -> float:
    return SAFE * least * (_edge(v, layer, grid) >= least)


def _edge(v: Array, layer: float, grid: PoseGrid) -> float:
    """Return the least value of a layer along the edges, in [m]."""
    width = ceil(layer / grid.spacing) + 1
    return float(min(v[:width].min(), v[-width:].min(), v[:, -width:].min()))


def _cover(
    game: ShieldGame,
    least: float,
    response: float,
    scale: float,
    cells: int,
    headings: int,
) -> PoseGrid:
    """Return a grid over the states that can be unsafe, and a layer.

    The barrier of an omnidirectional robot reaches at most by its speed times
    the time of a turn by one radian ahead, and by the time that it needs to
    clear the distance; turning and standing come before.
    """
    speed, turn = game.person_speed, game.person_turn
    waits = response + 2.0 * game.period
    if game.turn > 0.0:
        waits += 0.5 * pi / game.turn
    clears = 1.5 * CUT * least / max(game.slowest, 1e-3)
    reach = min(clears, 1.0 / turn + 0.5 * waits) + waits
    top = CUT * least
    layer = game.speed * game.period + game.disturbance
    layer += speed * (game.period + response)
    swerves = 0.5 * turn * speed * waits**2
    ahead = top + scale * speed * reach + layer
    aside = top + min(scale * swerves, ahead) + layer
    turned = turn * (game.period + response) * (ahead + aside)
    return PoseGrid.covering(
        least / cells,
        ahead + turned,
        scale * top + layer + turned,
        aside + turned,
        headings,
    )


def _standing(
    game: ShieldGame, walking: ValueTable, response: float, wait: float
) -> tuple[Array, Array]:
    """Return the value of a robot that stands for a wait, and of its starts.

    A motion begins after any part of the response, of which none, half and
    all are tried. Starts without a response are motions, and are left out.
    """
    grid, after = walking.grid, walking.after
    whole, reach = grid.whole(), game.layer(response + wait, grid)
    still = sub_poses([(0.0, 0.0, 0.0)], 1.0)

    def before(
        values: Array, motions: Array, duration: float, grid: PoseGrid
    ) -> Array:
        grid = grid._replace(sag=game.sag(duration))
        return step_back(values, motions, game.walks(duration), grid, reach)

    def stood(
        values: Array, duration: float, grid: PoseGrid, jump: float = 0.0
    ) -> Array:
        if duration == 0.0:
            return values
        least = least_within(values, grid, game.loss_in(duration) + jump)
        return before(least, still, duration, grid)

    if response == 0.0:
        starts = np.zeros((0, *whole.shape))
        best = before(after, game.motions, game.period, grid)
        return stood(best, wait, grid, game.jump), starts
    found = list[Array]()
    ends = np.concatenate([mirrored(after)[:, :-1], after], axis=1)
    for number, motion in enumerate(game.motions):
        mirror = motion * [1.0, -1.0, -1.0]
        twins = np.abs(game.motions[:number] - mirror).max(axis=(1, 2))
        if (twins < 1e-9).any():
            found.append(mirrored(found[int(np.argmin(twins))]))
            continue
        least = later = before(ends, motion[None], game.period, whole)
        for _ in range(SEGMENTS):
            later = stood(later, response / SEGMENTS, whole)
            least = np.minimum(least, later)
        found.append(least)
    starts = np.array(found)
    best = starts.max(axis=0)[:, grid.rows - 1 :]
    best = np.ascontiguousarray(best)
    return stood(best, wait, grid, game.jump), starts
