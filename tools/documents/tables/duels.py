"""Labels of duel values; duels on two floors; printed output."""

from collections.abc import Mapping
from typing import Any

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


def printed(result: Mapping[str, Any]) -> str:
    """Return the printed output of a command, as a code fence."""
    return f"```\n{result['printed'].rstrip()}\n```"
