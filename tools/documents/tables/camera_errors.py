"""Duels of robots with cameras."""

from collections.abc import Mapping
from typing import Any

from .markdown import number, table

ROWS = {
    "pursuer_bearing_error_median_deg": (
        "pursuer's bearing error, median [deg]"
    ),
    "pursuer_bearing_error_p95_deg": "the same, 95th percentile [deg]",
    "evader_bearing_error_median_deg": "evader's bearing error, median [deg]",
    "evader_bearing_error_p95_deg": "the same, 95th percentile [deg]",
    "evader_distance_error_median_m": "evader's distance error, median [m]",
    "detection_rate": "detection rate",
    "false_detections": "false detections",
    "pursuer_misled_s": "misled, pursuer [s]",
    "evader_misled_s": "misled, evader [s]",
    "triggered_at_distance_m": "triggered at [m], if begun beyond 0.85 m",
    "distance_m": "distance on the circle [m]",
    "relative_orientation_deg": "between headings [deg]",
    "converged_at_s": "on the circle since [s]",
    "min_distance_m": "closest approach [m]",
    "real_time_factor": "times real time",
}


def figures(result: Mapping[str, Any]) -> str:
    """List each value with its range over the duels."""
    summary = result["summary"]
    return table(
        ("what", "least", "mean", "greatest"),
        [
            (
                words,
                *(
                    number(summary[key][which])
                    for which in ("least", "mean", "greatest")
                ),
            )
            for key, words in ROWS.items()
        ],
    )
