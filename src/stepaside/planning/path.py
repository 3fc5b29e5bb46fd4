"""Cartesian trajectory of the template unicycle (paper, Sec. III-B)."""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import check_bearing, check_positive
from ..core.poses import Array
from ..theory import laws


class Direction(Enum):
    """Sign of the driving velocity in eq. (7)."""

    FORWARD = 1  # pursuer
    BACKWARD = -1  # evader


@dataclass(frozen=True, slots=True)
class UnicycleTrajectory:
    r"""Arc of circle, then straight line, from the origin of its frame.

    Eqs. (9)-(14) with :math:`\omega` frozen at :math:`k \theta^*` until
    :math:`t_s = 1 / k`, less the factor sign(theta*) that the text prints
    in (10) and (11): integrating (8) yields none, and only without it does
    the arc join the line at :math:`t_s`.

    Attributes:
        bearing: Desired heading :math:`\theta^*` in the frame, in [rad].
        speed: Magnitude :math:`\bar{v}` of the driving velocity, in [m/s].
        gain: Steering gain :math:`k`, in [1/s].
        direction: Whether the robot walks forward or backward.
        saturated: Whether the turning rate is k sign(theta*), eq. (6),
            until theta* is reached, rather than k theta*, eq. (8).
    """

    bearing: float
    speed: float
    gain: float
    direction: Direction
    saturated: bool = False

    def __post_init__(self) -> None:
        """Check the parameters."""
        check_bearing(self.bearing, "bearing")
        check_positive(self.speed, "speed", "m/s")
        check_positive(self.gain, "gain", "1/s")

    def poses(self, times: ArrayLike) -> Array:
        r"""Evaluate the trajectory.

        Args:
            times: Times since planning, in [s]. Shape (n,).

        Returns:
            Poses (x [m], y [m], theta [rad]), columns. Shape (n, 3).
        """
        t = np.asarray(times, dtype=np.float64)
        rate = laws.proportional_rate(self.bearing, self.gain)
        arc = 1.0 / self.gain  # time spent on it, in [s]
        if self.saturated:
            rate = laws.saturated_rate(self.bearing, self.gain)
            arc *= abs(self.bearing)
        turning = np.minimum(t, arc)
        velocity = self.direction.value * self.speed
        return arc_then_line(turning, t - turning, rate, velocity)


def arc_then_line(
    turning: Array,
    straight: Array,
    rate: float | Array,
    velocity: float | Array,
) -> Array:
    """Return the poses after an arc of circle and a straight line.

    A chord of an arc has length sinc(theta / 2) of the arc's and points
    along theta / 2; this form has no singularity at theta = 0. The numbers
    may be traced.

    Args:
        turning: Times on the arc, in [s]. Shape (n,).
        straight: Times on the line, in [s]. Shape (n,).
        rate: Turning rate on the arc, in [rad/s].
        velocity: Driving velocity, negative backward, in [m/s].

    Returns:
        Poses (x [m], y [m], theta [rad]), columns. Shape (n, 3).
    """
    theta = turning * rate
    half = 0.5 * theta
    chord = (velocity * turning) * np.sinc(half / np.pi)
    along = velocity * straight
    x = chord * np.cos(half) + along * np.cos(theta)
    y = chord * np.sin(half) + along * np.sin(theta)
    return np.stack([x, y, theta], axis=-1)
