"""Table of a solved chauffeur's game: value and strategies."""

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import ArrayLike

from ...core.brief_repr import brief_repr
from .chauffeur_game import Array, ChauffeurGame


@dataclass(frozen=True, slots=True)
class HalfPlane:
    """Square grid over the left half plane of the pursuer, in radii.

    Attributes:
        spacing: Spacing of the nodes.
        behind: Distance of the first node behind the pursuer.
        shape: Nodes along x (ahead) and along y >= 0 (to the left).
    """

    spacing: float
    behind: float
    shape: tuple[int, int]

    @classmethod
    def covering(
        cls, spacing: float, ahead: float, behind: float, aside: float
    ) -> "HalfPlane":
        """Return the grid with a node at the pursuer and these edges."""
        back = ceil(behind / spacing)
        nodes = back + ceil(ahead / spacing) + 1, ceil(aside / spacing) + 1
        return cls(spacing, back * spacing, nodes)

    def axes(self) -> tuple[Array, Array]:
        """Return the coordinates x and y of the nodes."""
        columns, rows = (np.arange(n, dtype=np.float64) for n in self.shape)
        x: Array = self.spacing * columns - self.behind
        y: Array = self.spacing * rows
        return x, y


@dataclass(frozen=True)
class ChauffeurTable:
    """Guaranteed distance over the positions of the evader.

    Positions are in the frame of the pursuer: x ahead, y to its left.

    Attributes:
        game: The game that was solved.
        plane: Grid, in turning radii.
        values: Guaranteed distances of the nodes, in radii.
            Shape ``plane.shape``.
        period: Time for which the evader holds a velocity, in [s].
        seconds: Computing time, in [s].
    """

    game: ChauffeurGame
    plane: HalfPlane
    values: Array
    period: float
    seconds: float

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        """Freeze the table."""
        self.values.flags.writeable = False

    @property
    def guaranteed(self) -> float:
        """Distance that is guaranteed from afar, in [m]."""
        return float(self.values[-1, 0]) * self.game.turning_radius

    def value(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Interpolate the guaranteed distance linearly.

        Args:
            x: Position of the evader ahead of the pursuer, in [m].
            y: Position to its left, in [m].

        Returns:
            Values, in [m], of the broadcast shape; outside the table the
            distance that is guaranteed from afar.
        """
        from scipy.ndimage import map_coordinates

        radius, plane = self.game.turning_radius, self.plane
        x, y = np.broadcast_arrays(
            np.asarray(x, np.float64), np.asarray(y, np.float64)
        )
        places = x / radius + plane.behind, np.abs(y) / radius
        found = map_coordinates(
            self.values,
            np.reshape(places, (2, -1)) / plane.spacing,
            order=1,
            cval=self.values[-1, 0],
        )
        found = radius * found.reshape(x.shape)
        value: Array = np.minimum(found, np.hypot(x, y))
        return value
