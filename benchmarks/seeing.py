"""Play duels of robots that see and print docs/sensing.md's table.

Usage: python benchmarks/seeing.py [plain | degraded] [first seed] [number]

Degraded means 30 % of the images dropped, 100 ms more latency, and boxes
and a figure standing in the room.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import sys
from typing import Any

import numpy as np

from stepaside.simulation import DuelSettings, run_duel
from stepaside.simulation.camera_settings import (
    CLUTTER,
    CameraSettings,
    RoomSettings,
)
from stepaside.simulation.summary import summarise

ROWS = {
    "pursuer's bearing error, median [deg]": (
        "pursuer",
        "bearing_error_deg",
        "median",
    ),
    "the same, 95th percentile [deg]": ("pursuer", "bearing_error_deg", "p95"),
    "evader's bearing error, median [deg]": (
        "evader",
        "bearing_error_deg",
        "median",
    ),
    "the same, 95th percentile [deg] ": ("evader", "bearing_error_deg", "p95"),
    "evader's distance error, median [m]": (
        "evader",
        "distance_error_m",
        "median",
    ),
    "detection rate": ("detection_rate",),
    "false detections": ("false_detections",),
    "misled, pursuer [s]": ("pursuer", "misled_s"),
    "misled, evader [s]": ("evader", "misled_s"),
    "triggered at [m], if begun beyond 0.85 m": ("triggered_at_distance_m",),
    "distance on the circle [m]": ("distance_m",),
    "between headings [deg]": ("relative_orientation_deg",),
    "on the circle since [s]": ("converged_at_s",),
    "closest approach [m]": ("min_distance_m",),
    "times real time": ("real_time_factor",),
}


def play(kind: str, seed: int) -> dict[str, Any]:
    """Summary of one duel of 120 s."""
    settings = DuelSettings(seed=seed, sensing="cameras")
    if kind == "degraded":
        settings = DuelSettings(
            seed=seed,
            sensing="cameras",
            cameras=CameraSettings(drop_frames=0.3, added_latency=0.1),
            room=RoomSettings(things=list(CLUTTER)),
        )
    return summarise(run_duel(settings))


def main(kind: str = "plain", first: int = 1, number: int = 20) -> None:
    """Print outcomes and the range of each figure as a table."""
    found = [play(kind, seed) for seed in range(first, first + number)]
    print_table(found)


def print_table(found: list[dict[str, Any]]) -> None:
    """Print outcomes and the range of each figure."""
    outcomes = [summary["outcome"] for summary in found]
    for outcome in sorted(set(outcomes)):
        print(f"{outcome}: {outcomes.count(outcome)} of {len(found)}")
    print("\n| what | least | mean | greatest |\n|---|---|---|---|")
    for what, keys in ROWS.items():
        values = []
        for summary in found:
            if "triggered" in what and summary["start"]["distance_m"] < 0.85:
                continue
            value: Any = summary
            for key in keys:
                value = value[key]
            values.append(float("nan") if value is None else value)
        low, high = min(values), max(values)
        mean = float(np.mean(values))
        print(f"| {what.strip()} | {low:.3f} | {mean:.3f} | {high:.3f} |")


if __name__ == "__main__":
    kind, *numbers = sys.argv[1:] or ["plain"]
    main(kind, *map(int, numbers))
