"""Distances of moving outlines from solids, along a few directions.

Two convex sets lie apart by at least what separates them along any
direction, and by exactly that along the right one. So the largest separation
along some directions is never more than the distance: what it calls clear is
clear.
"""

from collections.abc import Sequence
from math import inf

import numpy as np

from ...poses import Array
from ...rooms import Disc, Obstacle

EVEN = 64  # directions all around, so that one is within 3 degrees


class Solids:
    """What stands on a floor, prepared for many questions.

    Attributes:
        known: The discs and polygons.
    """

    def __init__(self, known: Sequence[Obstacle]) -> None:
        """Prepare solids.

        Args:
            known: In one frame.
        """
        self.known = tuple(known)
        angles = np.arange(EVEN) * (2.0 * np.pi / EVEN)
        even = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        faces = [-s.normals for s in self.known if not isinstance(s, Disc)]
        # A long wall is only told exactly along its own normals.
        around = np.concatenate([even, *faces])
        self._directions: Array = np.unique(np.round(around, 12), axis=0).T
        self._directions /= np.hypot(*self._directions)
        self._nearest: Array = np.array(
            [self._least(solid) for solid in self.known]
        ).reshape(len(self.known), self._directions.shape[1])

    def _least(self, solid: Obstacle) -> Array:
        """How far a solid begins along each direction, in [m]."""
        if isinstance(solid, Disc):
            found: Array = np.array(solid.centre) @ self._directions
            return found - solid.radius
        least: Array = (solid.points @ self._directions).min(axis=0)
        return least

    def clearances(self, corners: Array) -> Array:
        """Distance that moving outlines keep from everything.

        Args:
            corners: Of the outline at instants; from one to the next its
                corners move straight. Shape (instants, corners, 2), in [m].

        Returns:
            Lower bounds of the distance between the hull of each two
            outlines that follow each other and the nearest solid, in [m];
            not positive if they may touch, infinite without solids. Shape
            (instants - 1,), or (1,) of one instant.
        """
        if not self.known:
            return np.full(max(1, len(corners) - 1), inf)
        reach = (corners @ self._directions).max(axis=1)
        if len(reach) > 1:
            reach = np.maximum(reach[:-1], reach[1:])
        apart = self._nearest[None, :, :] - reach[:, None, :]
        found: Array = apart.max(axis=2).min(axis=1)
        return found


NOTHING = Solids(())
"""An open floor."""
