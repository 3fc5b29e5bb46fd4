"""How high the bodies of a player reach, whatever its posture."""

from collections.abc import Iterable

import numpy as np

from ..core.poses import Array
from .visual_geoms import VisualGeom


class BodyHeights:
    """Boxes around the parts of each body, to find the highest point."""

    def __init__(self, parts: Iterable[VisualGeom]) -> None:
        """Keep the corners of the boxes, in their bodies."""
        found: dict[int, list[Array]] = {}
        for part in parts:
            found.setdefault(part.body, []).append(part.corners)
        self._corners = {b: np.concatenate(c) for b, c in found.items()}

    def of(
        self, bodies: Iterable[int], positions: Array, quaternions: Array
    ) -> float:
        """Height of the highest point of some bodies, in [m].

        Args:
            bodies: Their numbers; those without parts do not count.
            positions: Of all bodies, in the world, in [m]. Shape (bodies, 3).
            quaternions: (w, x, y, z). Shape (bodies, 4).
        """
        highest = -np.inf
        for body in bodies:
            if body in self._corners:
                w, x, y, z = quaternions[body].tolist()
                # Third row of the rotation: how high a corner is in the world.
                up = np.array(
                    [
                        2.0 * (x * z - w * y),
                        2.0 * (y * z + w * x),
                        1.0 - 2.0 * (x * x + y * y),
                    ]
                )
                over = positions[body, 2] + (self._corners[body] @ up).max()
                highest = max(highest, float(over))
        return highest
