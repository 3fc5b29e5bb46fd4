"""The table of a tournament, for the terminal."""

from typing import Any

from .terminal import echo


def print_rows(rows: list[dict[str, Any]]) -> None:
    """Print a line for each pairing, under what capture and circle mean."""
    if rows:
        echo(
            f"captured: distance <= {rows[0]['capture_distance_m']:.3f} m; "
            "circle: distance [m] on the circle of the paper, moving aside, "
            "at the pursuer's gain; touched: an obstacle"
        )
    echo(
        f"{'evader':<12}{'pursuer':<11}{'circle':>7}{'games':>6}"
        f"{'survived':>10}{'95 %':>14}{'captured':>10}{'contact':>9}"
        f"{'touched':>9}{'closest':>9}"
        f"{'of bound':>9}{'floor':>7}{'turning':>9}{'unseen':>8}{'ms':>7}"
    )
    for row in rows:
        low, high = row["survived_low"], row["survived_high"]
        echo(
            f"{row['evader'][-11:]:<12}{row['pursuer'][-10:]:<11}"
            f"{_circle(row['circle_distance_m']):>7}"
            f"{row['games']:>6}{100 * row['survived']:>8.1f} %"
            f"{100 * low:>7.1f}-{100 * high:<6.1f}"
            f"{100 * row['captured']:>8.1f} %"
            f"{_percent(row['contact']):>9}"
            f"{100 * row['touched_obstacle']:>7.1f} %"
            f"{row['mean_closest_m']:>7.3f} m{row['closest_over_bound']:>9.3f}"
            f"{row['floor_used_m2']:>7.2f}{row['turning_rad_s']:>9.3f}"
            f"{100 * row['out_of_view']:>6.1f} %{row['decision_ms']:>7.2f}"
        )


def _circle(distance: float | None) -> str:
    return "-" if distance is None else f"{distance:.3f}"


def _percent(share: float | None) -> str:
    return "-" if share is None else f"{100 * share:.1f} %"
