"""Verification of a chauffeur table: closed forms and simulated games."""

from dataclasses import dataclass
from math import pi

import numpy as np

from ...core.errors import PlanError
from .chauffeur_game import Array, chauffeur_barrier
from .chauffeur_table import ChauffeurTable
from .sampled_value import decide


@dataclass(frozen=True, slots=True)
class BarrierErrors:
    """Distance of a table's barrier from the closed form.

    Attributes:
        points: Points of the closed form, x and y, in [m]. Shape (n, 2).
        errors: Distance of the table's barrier from each along the normal,
            in [m]; positive outside. Shape (n,).
        spacing: Spacing of the grid, in [m].
    """

    points: Array
    errors: Array
    spacing: float


def check_chauffeur_barrier(
    table: ChauffeurTable, capture: float, count: int = 41
) -> BarrierErrors:
    """Locate the table's barrier along the normals of the closed form.

    Args:
        table: Table of an evader with one speed in every direction.
        capture: Capture distance, in [m].
        count: Number of points; the ends, where the normal of the grid is
            undefined, are left out.

    Raises:
        PlanError: If there is no closed form; see
            :func:`.chauffeur_game.chauffeur_barrier`.
    """
    line = chauffeur_barrier(table.game, capture, count)
    tangent = np.gradient(line, axis=0)[1:-1]
    points = line[1:-1]
    normal = np.column_stack([-tangent[:, 1], tangent[:, 0]])
    normal /= np.hypot(*normal.T)[:, None]
    spacing = table.plane.spacing * table.game.turning_radius
    offsets = np.linspace(-8.0, 8.0, 641) * spacing
    paths = points[:, None] + offsets[:, None] * normal[:, None]
    captured = table.value(paths[..., 0], paths[..., 1]) < capture
    changes = captured[:, :-1] != captured[:, 1:]
    middle = 0.5 * (offsets[:-1] + offsets[1:])
    far = np.where(changes, np.abs(middle), np.inf)
    nearest = far.argmin(axis=1)
    errors = np.where(changes.any(axis=1), middle[nearest], np.inf)
    return BarrierErrors(points, errors, spacing)


def play_chauffeur(
    table: ChauffeurTable,
    starts: Array,
    *,
    duration: float,
    pursuer: str = "optimal",
    parts: int = 8,
) -> Array:
    """Simulate games in which the evader decides by the table.

    Args:
        table: Table of the game.
        starts: Positions x, y of the evader in the frame of the pursuer, in
            [m]. Shape (n, 2).
        duration: Duration of the games, in [s].
        pursuer: "optimal": answers each velocity by the table; or "direct":
            turns towards the evader as fast as it can, and reacts within a
            period.
        parts: Parts of a period in which the distance is measured.

    Returns:
        Closest approach of each game, in [m]. Shape (n,).

    Raises:
        PlanError: If there is no such pursuer.
    """
    if pursuer not in ("optimal", "direct"):
        raise PlanError(
            f"pursuer must be optimal or direct, got {pursuer!r:.40}"
        )
    game = table.game
    position = np.array(starts, dtype=np.float64)
    least: Array = np.hypot(*position.T)
    step = table.period / parts
    for _ in range(round(duration / table.period)):
        velocity, turn = decide(table, *position.T)
        for _ in range(parts):
            if pursuer == "direct":
                aim = np.arctan2(position[:, 1], position[:, 0])
                turn = np.clip(aim / step, -game.turn, game.turn)
            angle = turn * step
            way = game.pursuer_speed * step
            position = position + velocity * step
            position[:, 0] -= way * np.sinc(angle / pi)
            half = np.sinc(0.5 * angle / pi)
            position[:, 1] -= 0.5 * way * angle * half**2
            position = _turned(position, -angle)
            velocity = _turned(velocity, -angle)
            least = np.minimum(least, np.hypot(*position.T))
    return least


def _turned(vectors: Array, angle: Array) -> Array:
    """Return vectors turned to the left by angles. Shape (n, 2)."""
    c, s = np.cos(angle), np.sin(angle)
    x, y = vectors.T
    return np.column_stack([c * x - s * y, s * x + c * y])
