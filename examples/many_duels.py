# /// script
# dependencies = ["stepaside"]
# ///
"""Compare duels of ideal and hardware-like bodies, on all cores.

Any executor of ``concurrent.futures`` works, on one machine or on many.
Run it alone: ``python examples/many_duels.py``.
"""

import sys
from concurrent.futures import ProcessPoolExecutor

from stepaside import BODIES, duel, run_game


def main(seconds: float, seeds: range) -> None:
    """Play all bodies from all initial poses, and print a table."""
    duels = {
        (body, seed): duel(
            seed=seed,
            duration=seconds,
            body=BODIES[body],
        )
        for body in ("ideal", "hardware")
        for seed in seeds
    }
    print("body      seed  outcome      closest [m]  at the end [m]  replans")
    with ProcessPoolExecutor() as pool:
        runs = pool.map(run_game, duels.values())
        for (body, seed), run in zip(duels, runs, strict=True):
            planning = run.summary.planning
            replans = planning.replans if planning else 0
            print(
                f"{body:<9} {seed:4d}  {run.outcome.value:<11}"
                f"{run.summary.min_distance_m:12.3f}"
                f"{run.distance[-1]:16.3f}{replans:9d}"
            )


if __name__ == "__main__":
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 30.0
    main(seconds, range(1, 4))
