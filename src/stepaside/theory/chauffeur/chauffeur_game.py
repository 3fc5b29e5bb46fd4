r"""Game of a car and an omnidirectional point, with its closed forms.

A person who walks at speed :math:`V` and turns no tighter than a radius
:math:`R` chases a robot that moves in any direction: the homicidal chauffeur
of Isaacs (Differential Games, 1965). In the frame of the person, x ahead and
y to the left, the robot at :math:`(x, y)` with velocity :math:`w` obeys

.. math::
    \dot x = w_x - V + u y, \qquad \dot y = w_y - u x, \qquad |u| \le V / R

and maximises the least distance.
"""

from dataclasses import dataclass
from math import acos, asin, sin, sqrt, tau

import numpy as np
from numpy.typing import NDArray

from ...core.errors import PlanError, check_positive, check_within

Array = NDArray[np.float64]
ROUND = 1e-9  # relative difference of speeds that count as equal


@dataclass(frozen=True, slots=True)
class SpeedEllipse:
    """Velocities of a robot that faces its pursuer.

    The set is bounded by two half ellipses through the three speeds; that
    of a disc has equal ones. Any smaller velocity is possible, too.

    Attributes:
        forward: Largest speed towards the pursuer, in [m/s].
        backward: Largest speed away from it, in [m/s].
        sideways: Largest speed across the line of sight, in [m/s].
    """

    forward: float
    backward: float
    sideways: float

    def __post_init__(self) -> None:
        """Check the speeds."""
        check_positive(self.forward, "forward", "m/s")
        check_positive(self.backward, "backward", "m/s")
        check_positive(self.sideways, "sideways", "m/s")

    @classmethod
    def disc(cls, speed: float) -> "SpeedEllipse":
        """Return the set with one speed in every direction, in [m/s]."""
        return cls(speed, speed, speed)

    @property
    def largest(self) -> float:
        """Largest speed in any direction, in [m/s]."""
        return max(self.forward, self.backward, self.sideways)

    @property
    def smallest(self) -> float:
        """Radius of the largest disc within the set, in [m/s]."""
        return min(self.forward, self.backward, self.sideways)

    @property
    def is_disc(self) -> bool:
        """Whether the speed is the same in every direction."""
        return self.largest - self.smallest <= ROUND * self.largest

    def boundary(self, count: int) -> Array:
        """Return velocities on the boundary, and zero.

        Args:
            count: Number of velocities on the boundary.

        Returns:
            Velocities away from the pursuer and to the left of the line of
            sight from the pursuer, in [m/s]; the last is zero.
            Shape (count + 1, 2).
        """
        angles = tau * np.arange(count) / count
        along, across = np.cos(angles), np.sin(angles)
        speed = np.where(along < 0.0, self.forward, self.backward)
        edge = np.column_stack([speed * along, self.sideways * across])
        return np.concatenate([edge, np.zeros((1, 2))])


@dataclass(frozen=True, slots=True)
class ChauffeurGame:
    """Speeds of both players and the agility of the pursuer.

    Attributes:
        pursuer_speed: Speed of the pursuer, in [m/s].
        turning_radius: Tightest radius of its turns, in [m].
        velocities: Velocities of the evader.
    """

    pursuer_speed: float
    turning_radius: float
    velocities: SpeedEllipse

    def __post_init__(self) -> None:
        """Check the values.

        Raises:
            PlanError: If a value is out of range, or the evader is not
                slower: it then escapes from any start on an open floor.
        """
        check_positive(self.pursuer_speed, "pursuer_speed", "m/s")
        check_positive(self.turning_radius, "turning_radius", "m")
        if not self.velocities.largest < self.pursuer_speed:
            raise PlanError(
                "evader_speed must be < pursuer_speed, "
                f"{self.pursuer_speed:g} [m/s]: an evader that is as fast "
                f"can always run away, got {self.velocities.largest:g}"
            )

    @property
    def turn(self) -> float:
        """Largest turning rate of the pursuer, in [rad/s]."""
        return self.pursuer_speed / self.turning_radius

    @property
    def ratio(self) -> float:
        """Largest speed of the evader over that of the pursuer."""
        return self.velocities.largest / self.pursuer_speed

    @property
    def guaranteed_distance(self) -> float | None:
        """Closed form of the guaranteed distance, in [m]; None if not round.

        A capture distance below it is avoidable from every start outside
        the barrier; one above it from none.
        """
        if not self.velocities.is_disc:
            return None
        return self.turning_radius * guaranteed_distance(self.ratio)


def guaranteed_distance(ratio: float) -> float:
    r"""Return the largest distance that a point can keep, in turning radii.

    Against the full turn of the car the evader runs straight along the
    normal of the capture circle. Both barriers close ahead of the car where
    they are tangential to its axis, which for a speed ratio :math:`\gamma`
    gives

    .. math::
        \sqrt{1 - \gamma^2} + \gamma \arcsin \gamma - 1
        \quad (\gamma \arcsin \gamma \le 1), \qquad
        \sqrt{1 + \gamma^2 - 2 \gamma \sin(1 / \gamma)}

    above, where the evader can circle with the car.

    Args:
        ratio: Speed of the evader over that of the car, in (0, 1).

    Raises:
        PlanError: If the ratio is out of range.
    """
    check_within(ratio, 1e-6, 1.0, "ratio", "1")
    if ratio * asin(ratio) <= 1.0:
        return sqrt(1.0 - ratio**2) + ratio * asin(ratio) - 1.0
    return sqrt(1.0 + ratio**2 - 2.0 * ratio * sin(1.0 / ratio))


def chauffeur_barrier(
    game: ChauffeurGame, capture: float, count: int = 60
) -> Array:
    """Return the left half of the barrier of a point with one speed.

    Args:
        game: Game of an evader with the same speed in every direction.
        capture: Capture distance below the guaranteed one, in [m].
        count: Number of points.

    Returns:
        Points (x, y) in the frame of the pursuer, from the circle of
        capture to where both halves meet, in [m]. Shape (count, 2).

    Raises:
        PlanError: If the velocities are not a disc, the speed ratio is in
            the second regime, or the barrier does not close.
    """
    limit = game.guaranteed_distance
    ratio = game.ratio
    if limit is None or ratio * asin(ratio) > 1.0:
        raise PlanError(
            "the barrier is known for one speed in every direction, up to "
            f"0.897 of the pursuer's, got {ratio:g}"
        )
    check_within(capture, 0.0, limit, "capture", "m")
    c, s = capture / game.turning_radius, acos(ratio)

    def aside(t: Array) -> Array:
        side: Array = (c - ratio * t) * np.sin(s + t) + 1.0 - np.cos(t)
        return side

    fine = np.linspace(0.0, asin(ratio), 20_000)
    end = fine[np.argmax(aside(fine) <= 0.0)] if c > 0.0 else 0.0
    t = np.linspace(0.0, end, count)
    ahead = (c - ratio * t) * np.cos(s + t) + np.sin(t)
    return game.turning_radius * np.column_stack([ahead, aside(t)])
