r"""Cyclic pursuit of n unicycles: regular polygons and their stability.

Each unicycle drives at a fixed speed v and turns at k times the bearing of
the next one, eqs. (1)-(2) of the paper. In an equilibrium all drive on one
circle: with :math:`n` players and density :math:`d` the next player is seen
at the bearing :math:`\pi d / n`, so that

.. math:: \omega = k \pi d / n, \quad R = v / \omega, \quad
   s = 2 R \sin(\pi d / n).

For n = 2 this is the paper's game with the evasion angle pi. J. A. Marshall,
M. E. Broucke and B. A. Francis ("Formations of vehicles in cyclic pursuit",
IEEE Transactions on Automatic Control 49, 2004) found the polygons of this
law and their stability.
"""

from dataclasses import dataclass
from math import pi, sin, tau

import numpy as np
from numpy.typing import NDArray

from ...core.errors import PlanError, check_positive
from ...core.poses import Array

MARGIN = 1e-9  # real part, over the gain, below which a mode decays


@dataclass(frozen=True, slots=True)
class CyclicPolygon:
    """Equilibrium of n unicycles in cyclic pursuit: the polygon {n/d}.

    Attributes:
        count: Number n of players, at least 2.
        density: Turns d around the centre from the first player to itself,
            along the pursuit; below n.
        speed: Speed of all players, in [m/s].
        gain: Steering gain k of all players, in [1/s].
    """

    count: int
    density: int
    speed: float
    gain: float

    def __post_init__(self) -> None:
        """Validate the parameters."""
        if self.count < 2 or not 0 < self.density < self.count:
            raise PlanError(
                "density must lie between 0 and the count of at least 2, got "
                f"{self.density} of {self.count}"
            )
        check_positive(self.speed, "speed", "m/s")
        check_positive(self.gain, "gain", "1/s")

    @property
    def bearing(self) -> float:
        """Bearing of the next player, in [rad]."""
        return pi * self.density / self.count

    @property
    def rate(self) -> float:
        """Turning rate of all players, in [rad/s]."""
        return self.gain * self.bearing

    @property
    def radius(self) -> float:
        """Radius of the circle, in [m]."""
        return self.speed / self.rate

    @property
    def side(self) -> float:
        """Distance of each player to the next, in [m]."""
        return 2.0 * self.radius * sin(self.bearing)

    def poses(self) -> Array:
        """Return poses (x [m], y [m], heading [rad]). Shape (n, 3)."""
        angles = tau * self.density * np.arange(self.count) / self.count
        x, y = self.radius * np.cos(angles), self.radius * np.sin(angles)
        return np.column_stack([x, y, angles + 0.5 * pi])

    def eigenvalues(self) -> NDArray[np.complex128]:
        """Return the eigenvalues of the linearised shape, in [1/s].

        In the frame that turns with the polygon the linearisation is block
        circulant: one block of three states (radial and tangential
        displacement, heading) for each mode around the polygon. Turning the
        polygon about its centre and moving it on the floor do not change its
        shape; the three eigenvalues 0 and +-i omega of these motions are
        left out.

        Returns:
            Eigenvalues, the slowest first. Shape (3 n - 3,).
        """
        n, rate, gain = self.count, self.rate, self.gain
        turn = np.exp(2j * self.bearing)  # from one player to the next
        chord = self.radius * (turn - 1.0)
        own, other = 1.0 / chord, turn / chord
        # States: radial and tangential displacement [m], heading [rad].
        itself = np.array(
            [
                [0.0, rate, -self.speed],
                [-rate, 0.0, 0.0],
                [-gain * own.imag, -gain * own.real, -gain],
            ]
        )
        following = np.zeros((3, 3))
        following[2, :2] = gain * other.imag, gain * other.real
        modes = [
            np.linalg.eigvals(itself + np.exp(1j * tau * m / n) * following)
            for m in range(n)
        ]
        for mode, turns in ((0, 0), (self.density, 1), (-self.density, -1)):
            nearest = np.abs(modes[mode] - 1j * turns * rate).argmin()
            modes[mode] = np.delete(modes[mode], nearest)
        found = np.concatenate(modes)
        ordered: NDArray[np.complex128] = found[np.argsort(-found.real)]
        return ordered

    @property
    def is_stable(self) -> bool:
        """Whether small changes of the shape decay, by linearisation."""
        return bool(self.eigenvalues()[0].real < -MARGIN * self.gain)
