r"""Grid of relative states, with its boundary conditions.

Angles are sampled at the centres of their cells, so that no node lies on
:math:`a = \pm\pi`, where the pursuer's law is discontinuous. By the symmetry
:math:`V(r, -a, -\psi) = V(r, a, \psi)` only :math:`a > 0` is stored.
"""

from dataclasses import dataclass
from math import pi, tau

import numpy as np
from numpy.typing import NDArray

from ...core.errors import PlanError, check_positive

Array = NDArray[np.float64]
Values = NDArray[np.float32]
PAD = 3  # ghost cells on each side
LEAST = 8  # cells along an angle, so that stencils do not overlap


@dataclass(frozen=True, slots=True)
class Grid:
    """Nodes along distance and both bearings.

    Attributes:
        near: Distance at which the game ends, in [m].
        far: Largest distance, in [m].
        distances: Number of nodes along the distance, both ends included.
        errors: Number of nodes along a over the whole circle; even.
        bearings: Number of nodes along psi.
    """

    near: float
    far: float
    distances: int
    errors: int
    bearings: int

    def __post_init__(self) -> None:
        """Check the values."""
        check_positive(self.near, "near", "m")
        check_positive(self.far - self.near, "far - near", "m")
        for name in ("distances", "errors", "bearings"):
            if getattr(self, name) < LEAST:
                raise PlanError(
                    f"{name} must be >= {LEAST}, got {getattr(self, name)}"
                )
        if self.errors % 2:
            raise PlanError(f"errors must be even, got {self.errors}")

    @classmethod
    def cube(cls, near: float, far: float, cells: int) -> "Grid":
        """Return a grid with about ``cells`` cells along every axis."""
        even = cells + cells % 2
        return cls(near, far, cells + 1, even, even)

    def coarser(self) -> "Grid":
        """Return the grid with half as many cells along every axis."""
        even = 2 * (self.errors // 4)
        return Grid(
            self.near,
            self.far,
            self.distances // 2 + 1,
            even,
            self.bearings // 2,
        )

    @property
    def spacings(self) -> tuple[float, float, float]:
        """Spacings along r [m], a and psi [rad]."""
        return (
            (self.far - self.near) / (self.distances - 1),
            tau / self.errors,
            tau / self.bearings,
        )

    @property
    def shape(self) -> tuple[int, int, int]:
        """Nodes along a > 0, r and psi: the layout of every table."""
        return self.errors // 2, self.distances, self.bearings

    def axes(self) -> tuple[Array, Array, Array]:
        """Return the nodes a > 0 [rad], r [m] and psi [rad]."""
        _, step_a, step_psi = self.spacings
        a: Array = (
            np.arange(self.errors // 2, dtype=np.float64) + 0.5
        ) * step_a
        psi: Array = (
            np.arange(self.bearings, dtype=np.float64) + 0.5
        ) * step_psi - pi
        return a, np.linspace(self.near, self.far, self.distances), psi


def fill_ghosts(v: Values) -> None:
    """Fill the ghost cells of an array in place.

    Beyond a and psi the values are periodic and mirrored; below the least
    distance they are constant; beyond the largest they are extrapolated
    linearly.

    Args:
        v: Values with ghosts. Shape (a + 6, r + 6, psi + 6).
    """
    inner = v[:, :, PAD:-PAD]
    last = v.shape[1] - PAD - 1
    slope = inner[:, last] - inner[:, last - 1]
    for j in range(1, PAD + 1):
        inner[:, PAD - j] = inner[:, PAD]
        inner[:, last + j] = inner[:, last] + np.float32(j) * slope
    for j in range(PAD):
        inner[PAD - 1 - j] = inner[PAD + j, :, ::-1]
        inner[-PAD + j] = inner[-PAD - 1 - j, :, ::-1]
    v[:, :, :PAD] = v[:, :, -2 * PAD : -PAD]
    v[:, :, -PAD:] = v[:, :, PAD : 2 * PAD]
