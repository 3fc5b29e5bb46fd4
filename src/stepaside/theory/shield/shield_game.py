r"""Game of a person and a robot that commits to a motion for a period.

The state is the pose of the robot in the frame of the person (x ahead, y to
the left, both in [m]; heading in [rad]). At each decision the robot commits
to a motion for a period; the person then walks at any speed up to
:math:`V` and turns at any rate up to :math:`V / R`; and at the end the state
is displaced by up to a disturbance. See docs/shield.md.
"""

from dataclasses import dataclass
from math import tau
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...core.errors import check_positive, check_within
from ...core.poses import Array, arc

PARTS = 4  # of a period, in which the distance is measured
TURNS = 11  # of a person who walks at full speed
CELLS = 10  # in the required distance
SEGMENTS = 2  # of a response, between which the person changes its walk
SLOW_TURNS = 3  # of one who walks at half speed, or turns on the spot


@dataclass(frozen=True, slots=True)
class PersonModel:
    """What a person may do.

    Attributes:
        speed: Greatest speed, in [m/s].
        turning_radius: Radius of the tightest turn at that speed, in [m]; the
            turning rate that follows bounds slower walks, too.
    """

    speed: float
    turning_radius: float

    def __post_init__(self) -> None:
        """Check the values."""
        check_positive(self.speed, "speed", "m/s")
        check_positive(self.turning_radius, "turning_radius", "m")

    @property
    def turn(self) -> float:
        """Greatest turning rate, in [rad/s]."""
        return self.speed / self.turning_radius

    def walks(self, duration: float) -> Array:
        """Return the walks that are tried against the robot.

        Args:
            duration: Duration, in [s].

        Returns:
            Poses in the initial frame. Shape (n, PARTS, 3).
        """
        most = self.turn
        twists = [
            (share * self.speed, 0.0, rate)
            for share, count in ((1.0, TURNS), (0.5, SLOW_TURNS), (0.0, 3))
            for rate in np.linspace(-most, most, count)
        ]
        return sub_poses(twists, duration)


def sub_poses(twists: ArrayLike, duration: float) -> Array:
    """Return poses along arcs at the ends of the parts of a duration.

    Args:
        twists: Velocities ahead [m/s], to the left [m/s] and turning [rad/s],
            held in the frame of the body. Shape (n, 3).
        duration: Duration, in [s].

    Returns:
        Poses in the initial frame, in [m] and [rad]. Shape (n, PARTS, 3).
    """
    rates = np.atleast_2d(np.asarray(twists, dtype=np.float64))
    times = duration * np.arange(1, PARTS + 1) / PARTS
    return arc(*(rates.T[:, :, None] * times))


@dataclass(frozen=True, slots=True, eq=False)
class ShieldGame:
    """Person, motions of the robot, and disturbance of a sampled game.

    Attributes:
        person: What the person may do.
        motions: Poses in the frame of the robot, see :func:`sub_poses`; with
            each its mirror image. Shape (n, PARTS, 3).
        period: Time between two decisions of the robot, in [s].
        loss: Radius of the disturbance of the position per period, in [m].
        jump: Radius of a further disturbance at each decision, in [m].
    """

    person: PersonModel
    motions: Array
    period: float
    loss: float = 0.0
    jump: float = 0.0

    def __post_init__(self) -> None:
        """Check the values."""
        check_positive(self.period, "period", "s")
        check_within(self.loss, 0.0, 100.0, "loss", "m")
        check_within(self.jump, 0.0, 10.0, "jump", "m")

    @property
    def speed(self) -> float:
        """Greatest speed of the robot, in [m/s]."""
        ends = self.motions[:, -1]
        return float(np.hypot(ends[:, 0], ends[:, 1]).max()) / self.period

    @property
    def turn(self) -> float:
        """Greatest turning rate of the robot, in [rad/s]."""
        return float(np.abs(self.motions[:, -1, 2]).max()) / self.period

    def sag(self, duration: float) -> float:
        """Return the greatest deviation from the chord of a part, in [m].

        Args:
            duration: Duration that is divided into parts, in [s].
        """
        part = duration / PARTS
        person = self.person.speed * self.person.turn
        return (person + self.speed * self.turn) * part**2 / 8.0

    @property
    def disturbance(self) -> float:
        """Radius of the disturbance from one decision to the next, in [m]."""
        return self.loss + self.jump

    def loss_in(self, duration: float) -> float:
        """Return the disturbance within a duration, in [m]."""
        return self.loss * duration / self.period


class PoseGrid(NamedTuple):
    """Grid over the poses of a robot in the frame of a person.

    Attributes:
        left: x of the first node, in [m].
        spacing: Spacing of positions, in [m].
        shape: Nodes along x, y and the heading.
        right: y of the first node, in [m]; from 0 on the values of the other
            half are those of the mirror image.
    """

    left: float
    spacing: float
    shape: tuple[int, int, int]
    right: float = 0.0

    def whole(self) -> "PoseGrid":
        """Return the grid of both halves."""
        i, j, k = self.shape
        right = -self.spacing * (j - 1)
        return PoseGrid(self.left, self.spacing, (i, 2 * j - 1, k), right)

    def axes(self) -> tuple[Array, Array, Array]:
        """Return the coordinates of the nodes, in [m], [m] and [rad]."""
        i, j, k = (np.arange(n, dtype=np.float64) for n in self.shape)
        x: Array = self.left + self.spacing * i
        y: Array = self.right + self.spacing * j
        theta: Array = tau / self.shape[2] * k
        return x, y, theta


class OutcomeRules(NamedTuple):
    """How the outcome of a motion is read from the values after it.

    Attributes:
        grid: Grid of the values.
        outside: Value outside the grid, in [m].
        sag: Deviation of the distance from that of chords, in [m].
    """

    grid: PoseGrid
    outside: float
    sag: float


def mirrored(values: Array) -> Array:
    """Return the values of mirrored poses, at nodes of a whole grid."""
    headings = -np.arange(values.shape[2]) % values.shape[2]
    return values[:, ::-1, headings]


def whole_values(values: Array) -> Array:
    """Return the values at the nodes of both halves of a grid."""
    return np.concatenate([mirrored(values)[:, :-1], values], axis=1)
