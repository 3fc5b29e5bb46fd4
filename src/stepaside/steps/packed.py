"""What stands on the floor, packed for compiled loops."""

from collections.abc import Sequence
from functools import lru_cache
from math import inf, sqrt
from typing import Any, NamedTuple

import numpy as np

from ..rooms import Disc, Obstacle
from ..unicycle.compiled import inlined


class Packed(NamedTuple):
    """Discs and convex polygons in arrays.

    Attributes:
        discs: Centre x, y and radius, in [m]. Shape (n, 3).
        edges: Of all polygons, one after the other: outward unit normal,
            offset [m], corner x, y where it begins [m], its length [m].
            Shape (m, 6).
        firsts: Where each polygon begins in them, and where the last ends.
            Shape (polygons + 1,).
        rounds: Centre x, y and radius of a circle around each polygon, in
            [m]. Shape (polygons, 3).
    """

    discs: Any
    edges: Any
    firsts: Any
    rounds: Any


@lru_cache(maxsize=64)
def pack(solids: tuple[Obstacle, ...]) -> Packed:
    """Pack what stands on the floor.

    Args:
        solids: In the frame in which it is asked for.
    """
    discs = [(s.x, s.y, s.radius) for s in solids if isinstance(s, Disc)]
    rows: list[Any] = []
    rounds: list[Any] = []
    firsts = [0]
    for solid in solids:
        if isinstance(solid, Disc):
            continue
        along = np.roll(solid.points, -1, axis=0) - solid.points
        lengths = np.hypot(along[:, 0], along[:, 1])
        rows.append(
            np.column_stack(
                [solid.normals, solid.offsets, solid.points, lengths]
            )
        )
        firsts.append(firsts[-1] + len(lengths))
        away = solid.points - solid.centre
        rounds.append((*solid.centre, np.hypot(*away.T).max()))
    return Packed(
        np.array(discs, dtype=np.float64).reshape(-1, 3),
        np.concatenate(rows) if rows else np.zeros((0, 6)),
        np.array(firsts, dtype=np.int64),
        np.array(rounds, dtype=np.float64).reshape(-1, 3),
    )


NOTHING = pack(())
"""An open floor."""


@inlined
def clearance_at(packed: Packed, x: float, y: float, enough: float) -> float:
    """Distance of a point to the nearest solid, as far as it matters.

    Args:
        packed: What stands there.
        x: Of the point, in [m].
        y: Of the point, in [m].
        enough: Distance from which on nothing matters, in [m].

    Returns:
        Signed distance, negative inside, at most ``enough``, in [m].
    """
    nearest = enough
    discs, edges, firsts = packed.discs, packed.edges, packed.firsts
    for i in range(discs.shape[0]):
        dx, dy = x - discs[i, 0], y - discs[i, 1]
        reach = nearest + discs[i, 2]
        square = dx * dx + dy * dy
        if square < reach * reach:
            nearest = min(nearest, sqrt(square) - discs[i, 2])
    for k in range(firsts.shape[0] - 1):
        dx, dy = x - packed.rounds[k, 0], y - packed.rounds[k, 1]
        reach = nearest + packed.rounds[k, 2]
        if dx * dx + dy * dy > reach * reach and reach > 0.0:
            continue
        beyond = -inf
        for i in range(firsts[k], firsts[k + 1]):
            height = edges[i, 0] * x + edges[i, 1] * y - edges[i, 2]
            if height > beyond:
                beyond = height
                if beyond >= nearest:
                    break
        if beyond >= nearest:
            continue
        if beyond > 0.0:
            square = inf
            for i in range(firsts[k], firsts[k + 1]):
                # The edge runs to the left of its normal.
                dx, dy = x - edges[i, 3], y - edges[i, 4]
                along = dy * edges[i, 0] - dx * edges[i, 1]
                along = min(max(along, 0.0), edges[i, 5])
                dx += along * edges[i, 1]
                dy -= along * edges[i, 0]
                square = min(square, dx * dx + dy * dy)
            beyond = sqrt(square)
        nearest = min(nearest, beyond)
    return nearest


def clearance_of(packed: Packed, points: Sequence[Any]) -> list[float]:
    """Signed distances of points to the nearest solid, in [m]."""
    return [clearance_at(packed, x, y, inf) for x, y in points]
