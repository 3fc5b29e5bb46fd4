"""Verification of a chauffeur table: closed forms and simulated games."""

from dataclasses import dataclass

import numpy as np

from ...core.errors import PlanError
from ...core.poses import arc, rotate
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
            way = arc(game.pursuer_speed * step, 0.0, angle)
            x, y = (position + velocity * step - way[:, :2]).T
            position = rotate(x, y, -angle).T
            velocity = rotate(velocity[:, 0], velocity[:, 1], -angle).T
            least = np.minimum(least, np.hypot(*position.T))
    return least
