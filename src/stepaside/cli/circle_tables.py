"""Output of ``stepaside circle``: JSON values and printed tables."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from ..theory.unicycle.circles import Circle
from ..theory.unicycle.unicycle_game import Game
from .tables import format_value, print_columns, print_table, table_rows
from .terminal import echo
from .unicycle_options import finite

Progress = Callable[[int], None]


def describe_circles(
    game: Game,
    starts: int,
    seed: int,
    body: float,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Return every circle of a game and the fraction of starts ending on it.

    Args:
        game: Parameters of the game.
        starts: Number of random initial poses to simulate; 0 for none.
        seed: Random seed of the initial poses.
        body: Capture distance, in [m].
        progress: Called with the number of further finished games.

    Returns:
        Values for JSON; fractions are None without simulation.
    """
    from ..theory.unicycle.basins import find_basins, random_starts
    from ..theory.unicycle.circles import circles_of

    if starts == 0:
        found = [describe_one(c, None) for c in circles_of(game)]
        return {"circles": found, "starts": None}
    drawn = random_starts(game, starts, seed=seed)
    basins = find_basins(game, drawn, capture_distance=body, progress=progress)
    pairs = zip(basins.circles, basins.shares, strict=True)
    return {
        "circles": [describe_one(circle, share) for circle, share in pairs],
        "starts": {
            "number": starts,
            "seed": seed,
            "nearest_m": float(drawn[:, 0].min()),
            "farthest_m": float(drawn[:, 0].max()),
            "duration_s": basins.duration,
            "body_m": body,
            "captured_share": basins.captured,
            "unsettled_share": basins.unsettled,
            "mean_closest_distance_m": basins.closest_distance,
        },
    }


def describe_one(circle: Circle, share: float | None) -> dict[str, Any]:
    """Return one circle for JSON."""
    return {
        "exists": circle.exists,
        "direction": circle.direction,
        "side_rule": "behind" if circle.behind else "latched",
        "distance_m": circle.distance_m,
        "radius_pursuer_m": circle.radius_pursuer_m,
        "radius_evader_m": circle.radius_evader_m,
        "turning_rate_rad_s": circle.turning_rate_rad_s,
        "headings_apart_rad": circle.headings_apart_rad,
        "motions_apart_rad": circle.motions_apart_rad,
        "pursuer_error_rad": circle.pursuer_error_rad,
        "evader_error_rad": circle.evader_error_rad,
        "bearing_rad": circle.bearing_rad,
        "sliding": circle.sliding,
        "stable": circle.stable,
        "time_constant_s": finite(circle.time_constant_s),
        "eigenvalues_per_s": [[v.real, v.imag] for v in circle.eigenvalues],
        "share": share,
    }


_COLUMNS = {
    "direction": "direction",
    "side_rule": "side rule",
    "distance_m": "distance",
    "radius_evader_m": "evader's radius",
    "stable": "stable",
    "time_constant_s": "time constant",
    "starts_share": "basin",
}
_DIRECTIONS = {1: "main", -1: "reversed"}


def print_circles(result: dict[str, Any]) -> None:
    """Print the result as tables."""
    lists = ("circles", "game", "starts")
    if result["exists"]:
        print_table(table_rows(result, (k for k in result if k not in lists)))
    else:
        which = "main circle" if result["circles"] else "circle"
        echo(f"There is no {which} for these speeds, gains and angle.")
    circles = [
        circle
        | {
            "direction": _DIRECTIONS.get(circle["direction"]),
            "starts_share": circle["share"],
        }
        for circle in result["circles"]
    ]
    if circles:
        echo()
        _print_rows(circles, _COLUMNS)
    if result["starts"] is not None:
        echo("\n  games that did not end on a circle")
        names = ("captured_share", "unsettled_share")
        print_table(table_rows(result["starts"], names))


def _print_rows(
    rows: Iterable[Mapping[str, Any]], columns: Mapping[str, str]
) -> None:
    """Print rows of values; heads of the columns are by name of the value."""
    cells = [
        [format_value(name, row[name]) for name in columns] for row in rows
    ]
    heads, left = list(columns.values()), range(len(columns))
    print_columns(heads, cells, left=left, indent="  ")
