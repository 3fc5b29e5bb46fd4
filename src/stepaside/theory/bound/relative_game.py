r"""Differential game in relative coordinates.

An evader that walks backwards is a car that drives forwards along its
direction of motion; in the coordinates of
:mod:`..unicycle.relative_coordinates`,

.. math::
    \dot r = v_e \cos\psi - v_p \cos a, \qquad
    \dot a = \Omega - u_p, \qquad \dot\psi = \Omega - u_e

with :math:`u_p = k a` (eq. (2)) or :math:`|u_p| \le \omega_p`, and
:math:`|u_e| \le \omega_e`. The evader maximises the least distance.
"""

from dataclasses import dataclass
from math import pi

from ...core.errors import check_not_negative, check_positive


@dataclass(frozen=True, slots=True)
class BoundGame:
    r"""Speeds and turning limits of the players.

    The pursuer turns by :math:`u_p = k a + d` with :math:`|d| \le \omega_p`,
    where :math:`a`, wrapped to :math:`[-\pi, \pi]`, is the bearing of the
    evader.

    Attributes:
        pursuer_speed: Speed of the pursuer, in [m/s].
        evader_speed: Speed of the evader, in [m/s].
        pursuer_gain: Gain :math:`k` of the pursuer's law, in [1/s]; zero for
            a pursuer without a law.
        pursuer_turn: Largest deviation :math:`\omega_p` of the pursuer from
            its law, in [rad/s]; zero for one that follows it.
        evader_turn: Largest turning rate of the evader, in [rad/s].
    """

    pursuer_speed: float
    evader_speed: float
    pursuer_gain: float
    pursuer_turn: float
    evader_turn: float

    def __post_init__(self) -> None:
        """Check the values."""
        check_positive(self.pursuer_speed, "pursuer_speed", "m/s")
        check_positive(self.evader_speed, "evader_speed", "m/s")
        check_not_negative(self.pursuer_gain, "pursuer_gain", "1/s")
        check_not_negative(self.pursuer_turn, "pursuer_turn", "rad/s")
        check_positive(self.evader_turn, "evader_turn", "rad/s")
        check_positive(
            self.pursuer_gain + self.pursuer_turn, "pursuer_turn", "rad/s"
        )

    @property
    def rate(self) -> float:
        """Slowest rate at which the game changes, in [1/s]."""
        if self.pursuer_gain > 0.0:
            return min(self.pursuer_gain, self.evader_turn)
        return min(self.pursuer_turn, self.evader_turn)

    @property
    def unit(self) -> float:
        """Unit of length: speed of the evader over that rate, in [m]."""
        return self.evader_speed / self.rate

    @property
    def identical(self) -> bool:
        """Whether this is the game of two identical cars."""
        return (
            self.pursuer_gain == 0.0
            and self.pursuer_speed == self.evader_speed
            and self.pursuer_turn == self.evader_turn
        )


def fixed_pursuit_game(
    pursuer_speed: float,
    evader_speed: float,
    gain: float,
    evader_turn: float | None = None,
) -> BoundGame:
    r"""Return the game of any evader against the pursuer of eqs. (1)-(2).

    Args:
        pursuer_speed: Speed of the pursuer, in [m/s].
        evader_speed: Speed of the evader, in [m/s].
        gain: Gain of the pursuer, in [1/s].
        evader_turn: Largest turning rate of the evader, in [rad/s]; by
            default :math:`k \pi`, the pursuer's own.

    Raises:
        PlanError: If a value is out of range.
    """
    check_positive(gain, "pursuer_gain", "1/s")
    turn = gain * pi if evader_turn is None else evader_turn
    return BoundGame(pursuer_speed, evader_speed, gain, 0.0, turn)


def two_car_game(
    pursuer_speed: float,
    evader_speed: float,
    pursuer_turn: float,
    evader_turn: float | None = None,
) -> BoundGame:
    """Return the game of any evader against any pursuer, of two cars.

    Args:
        pursuer_speed: Speed of the pursuer, in [m/s].
        evader_speed: Speed of the evader, in [m/s].
        pursuer_turn: Largest turning rate of the pursuer, in [rad/s].
        evader_turn: Largest turning rate of the evader, in [rad/s]; by
            default the pursuer's.

    Raises:
        PlanError: If a value is out of range.
    """
    turn = pursuer_turn if evader_turn is None else evader_turn
    return BoundGame(pursuer_speed, evader_speed, 0.0, pursuer_turn, turn)
