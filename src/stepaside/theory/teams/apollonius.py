"""Cells of points: where an evader arrives before all of its pursuers.

A point that moves in any direction at speed v reaches, before a pursuer of
speed w >= v, the inside of a circle of Apollonius; at equal speeds, a half
plane. The cell is the intersection over all pursuers. It is a baseline for
bodies that cannot turn at once: reaching a place first does not make it safe.
"""

from dataclasses import dataclass
from math import inf, tau

import numpy as np
from numpy.typing import ArrayLike

from ...core.errors import PlanError, check_within
from ...core.poses import Array


@dataclass(frozen=True, slots=True, eq=False)
class ApolloniusCell:
    """Region that an evader reaches before its pursuers.

    Attributes:
        evader: Position of the evader, in [m]. Shape (2,).
        pursuers: Positions of the pursuers, in [m]. Shape (n, 2).
        ratio: Speed of the evader over that of the pursuers, in (0, 1].
    """

    evader: Array
    pursuers: Array
    ratio: float = 1.0

    def __post_init__(self) -> None:
        """Validate the positions and the ratio.

        Raises:
            PlanError: If there is no pursuer, a position is not finite or
                that of the evader, or the ratio is out of range.
        """
        check_within(self.ratio, 1e-6, 1.0, "ratio", "1")
        offsets = np.asarray(self.pursuers) - np.asarray(self.evader)
        if offsets.ndim != 2 or offsets.shape[1:] != (2,) or not len(offsets):
            raise PlanError(
                "pursuers must be rows of x and y [m], got shape "
                f"{np.shape(self.pursuers)}"
            )
        if not np.isfinite(offsets).all() or not offsets.any(axis=1).all():
            raise PlanError(
                "pursuers must be finite and apart from the evader [m]"
            )

    def extent(self, directions: ArrayLike) -> Array:
        """Return how far the cell reaches from the evader, in [m].

        Args:
            directions: Directions in the world, in [rad]. Shape (m,).

        Returns:
            Distance to the edge; inf where there is none. Shape (m,).
        """
        angles = np.asarray(directions, dtype=np.float64)
        away = np.stack([np.cos(angles), np.sin(angles)])
        offsets = np.asarray(self.pursuers) - np.asarray(self.evader)
        along = offsets @ away  # shape (n, m)
        square = (offsets**2).sum(axis=1)[:, None]
        # |offset - s u| = s / ratio: a s^2 + 2 along s - square = 0.
        a = 1.0 / self.ratio**2 - 1.0
        root = np.sqrt(along**2 + a * square)
        with np.errstate(divide="ignore"):
            # This form of the positive root holds for a = 0, too.
            reach = square / np.maximum(along + root, 0.0)
        nearest: Array = reach.min(axis=0)
        return nearest

    @property
    def is_bounded(self) -> bool:
        """Whether the cell is bounded.

        At equal speeds it is if and only if the evader lies strictly inside
        the convex hull of the pursuers: no half plane through the evader is
        free of them.
        """
        if self.ratio < 1.0:
            return True
        offsets = np.asarray(self.pursuers) - np.asarray(self.evader)
        angles = np.sort(np.arctan2(offsets[:, 1], offsets[:, 0]))
        gaps = np.diff(np.append(angles, angles[0] + tau))
        return bool(gaps.max() < np.pi - 1e-12)

    def area(self, count: int = 3600) -> float:
        """Return the area of the cell, in [m^2]; inf if it is unbounded.

        Args:
            count: Number of directions of the quadrature.
        """
        if not self.is_bounded:
            return inf
        angles = tau * (np.arange(count) + 0.5) / count
        return float(0.5 * (self.extent(angles) ** 2).sum() * tau / count)
