r"""Game of a person and a robot that must never be touched.

The state is the pose of the robot in the frame of the person (x ahead, y to
the left). At each decision the robot commits to a motion for a period; the
person then walks at any speed up to :math:`V` and turns at any rate up to
:math:`V / R`; and at the end the state is displaced by up to a disturbance.
See docs/shield.md.
"""

from dataclasses import dataclass

import numpy as np

from ...core.errors import check_positive, check_within
from ...core.poses import Array
from .pose_grid import PARTS, sub_poses

TURNS = 11  # of a person who walks at full speed
SLOW_TURNS = 3  # of one who walks at half speed, or turns on the spot
SEGMENTS = 2  # of a response, between which the person changes its walk


@dataclass(frozen=True, slots=True)
class PersonModel:
    """What a person may do."""

    speed: float  # greatest speed, in [m/s]
    # Radius of the tightest turn at that speed, in [m]; the turning rate that
    # follows bounds slower walks, too.
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

        They are poses in the initial frame, for a duration in [s]. Shape (n,
        PARTS, 3).
        """
        most = self.turn
        twists = [
            (share * self.speed, 0.0, rate)
            for share, count in ((1.0, TURNS), (0.5, SLOW_TURNS), (0.0, 3))
            for rate in np.linspace(-most, most, count)
        ]
        return sub_poses(twists, duration)


@dataclass(frozen=True, slots=True, eq=False)
class ShieldGame:
    """Person, motions of the robot, and disturbance of a sampled game."""

    person: PersonModel  # what the person may do
    # Poses in the frame of the robot, see sub_poses; with each its mirror
    # image. Shape (n, PARTS, 3).
    motions: Array
    period: float  # time between two decisions of the robot, in [s]
    # Radius of the disturbance of the position per period, in [m].
    loss: float = 0.0
    # Radius of a further disturbance at each decision, in [m].
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

    @property
    def slowest(self) -> float:
        """Speed that losses leave the robot at least, in [m/s]."""
        return self.speed - self.disturbance / self.period

    def sag(self, duration: float) -> float:
        """Return the greatest deviation from the chord of a part, in [m]."""
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
