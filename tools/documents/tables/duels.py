"""Labels of duel values; duels on two floors; printed output."""

from collections.abc import Mapping
from typing import Any

from .markdown import interval, table

# Labels and decimals of duel values; others appear by their keys.
WORDS = {
    "pursuer_radius_m": ("pursuer radius [m]", 3),
    "evader_radius_m": ("evader radius [m]", 3),
    "distance_m": ("distance [m]", 3),
    "relative_orientation_deg": ("between headings [deg]", 1),
    "converged_at_s": ("on the circle since [s]", 1),
    "min_distance_m": ("closest approach [m]", 3),
    "min_zmp_margin_m": ("ZMP margin [m]", 4),
    "triggered_at_distance_m": ("evasion begins at [m]", 3),
    "misled_s": ("misled [s]", 2),
    "lost_s": ("lost [s]", 2),
    "detection_rate": ("detection rate", 3),
    "false_detections": ("false detections", 1),
    "speed_ratio": ("speed over planned", 3),
}


def words_of(key: str) -> tuple[str, int]:
    """Return label and decimals of a value."""
    return WORDS.get(key, (key.replace("_", " "), 3))


def floors(result: Mapping[str, Any]) -> str:
    """List duels on each floor: outcomes, and the circle."""
    head = (
        "floor",
        "duels of 120 s",
        "falls",
        "contacts",
        "radius [m]",
        "distance [m]",
        "between headings [deg]",
    )
    rows = []
    for floor, found in result["floors"].items():
        radius, away, angle = (
            found[key]
            for key in ("radius_m", "distance_m", "relative_orientation_deg")
        )
        rows.append(
            (
                floor,
                str(found["number"]),
                str(found["falls"]),
                str(found["contacts"]),
                interval(radius["least"], radius["greatest"]),
                interval(away["least"], away["greatest"]),
                interval(angle["least"], angle["greatest"], 1),
            )
        )
    return table(head, rows)


def printed(result: Mapping[str, Any]) -> str:
    """Return the printed output of a command, as a code fence."""
    return f"```\n{result['printed'].rstrip()}\n```"
