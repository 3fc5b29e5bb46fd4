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
        radius, plane = self.game.turning_radius, self.plane
        x, y = np.broadcast_arrays(
            np.asarray(x, np.float64), np.asarray(y, np.float64)
        )
        u = (x / radius + plane.behind) / plane.spacing
        w = np.abs(y) / radius / plane.spacing
        last = np.array(plane.shape) - 1
        inside = (u >= 0.0) & (u <= last[0]) & (w <= last[1])
        i = np.clip(u.astype(np.int64), 0, last[0] - 1)
        j = np.clip(w.astype(np.int64), 0, last[1] - 1)
        s, t = np.clip(u - i, 0.0, 1.0), np.clip(w - j, 0.0, 1.0)
        v = self.values
        found = (1.0 - t) * ((1.0 - s) * v[i, j] + s * v[i + 1, j])
        found += t * ((1.0 - s) * v[i, j + 1] + s * v[i + 1, j + 1])
        found = radius * np.where(inside, found, v[-1, 0])
        value: Array = np.minimum(found, np.hypot(x, y))
        return value
