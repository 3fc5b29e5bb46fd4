"""Play many random duels on all cores and write docs/duels.md's table.

Usage: python benchmarks/duels.py [first seed] [number]
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import sys
from concurrent.futures import ProcessPoolExecutor
from typing import Any

from tqdm import tqdm

from stepaside.simulation import DuelSettings, run_duel
from stepaside.simulation.summary import summarise

ROWS = {
    "pursuer radius [m]": ("pursuer", "radius_m"),
    "evader radius [m]": ("evader", "radius_m"),
    "distance [m]": ("distance_m",),
    "between headings [deg]": ("relative_orientation_deg",),
    "on the circle since [s]": ("converged_at_s",),
    "closest approach [m]": ("min_distance_m",),
    "ZMP margin [m]": ("min_zmp_margin_m",),
}


def play(seed: int) -> dict[str, Any]:
    """Summary of one duel of 120 s."""
    return summarise(run_duel(DuelSettings(seed=seed)))


def main(first: int = 100, number: int = 40) -> None:
    """Print outcomes and the range of each figure as a table."""
    seeds = range(first, first + number)
    with ProcessPoolExecutor() as pool:
        found = list(tqdm(pool.map(play, seeds), total=number))
    outcomes = [summary["outcome"] for summary in found]
    for outcome in sorted(set(outcomes)):
        print(f"{outcome}: {outcomes.count(outcome)} of {number}")
    print("\n| what | least | mean | greatest |\n|---|---|---|---|")
    for what, keys in ROWS.items():
        values = []
        for summary in found:
            value: Any = summary
            for key in keys:
                value = value[key]
            values.append(float("nan") if value is None else value)
        mean = sum(values) / number
        print(
            f"| {what} | {min(values):.3f} | {mean:.3f} | {max(values):.3f} |"
        )


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
