"""Let a person walk at the evader and print docs/person.md's table.

Usage: python benchmarks/person.py [ideal | cameras] [first seed] [number]
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import sys

from stepaside.simulation import DuelSettings, run_duel
from stepaside.simulation.person_settings import PersonSettings
from stepaside.simulation.summary import summarise

WALKS = {
    "steers, 0.073 m/s": PersonSettings("steer", 0.073, 0.146),
    "steers, 0.15 m/s": PersonSettings("steer", 0.15, 0.2),
    "straight at it, 0.15 m/s": PersonSettings("straight", 0.15),
    "straight past at 1.2 m, 0.15 m/s": PersonSettings(
        "straight", 0.15, miss=1.2
    ),
}


def main() -> None:
    """Play and print."""
    sensing = sys.argv[1] if len(sys.argv) > 1 else "ideal"
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    number = int(sys.argv[3]) if len(sys.argv) > 3 else 5
    print(
        "| walk | seed | outcome | triggered at [m] | closest [m] | theory |"
    )
    print("|---|---|---|---|---|---|")
    for name, person in WALKS.items():
        for seed in range(first, first + number):
            result = run_duel(
                DuelSettings(
                    seed=seed,
                    duration=90.0,
                    pursuer="person",
                    person=person,
                    sensing=sensing,
                )
            )
            s = summarise(result)
            at = s["triggered_at_distance_m"]
            theory = s["theory"]["closest_approach_m"]
            print(
                f"| {name} | {seed} | {s['message']} | "
                f"{'never' if at is None else f'{at:.3f}'} | "
                f"{s['min_distance_m']:.3f} | {theory:.3f} |",
                flush=True,
            )


if __name__ == "__main__":
    main()
