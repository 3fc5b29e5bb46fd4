"""Time many games at once: compiled kernel against NumPy.

Both simulate the same games in one process, alternately; the best of two
counts for each. Processor time on one core::

    NUMBA_NUM_THREADS=1 python tools/benchmarks/kernel.py
"""

import os

os.environ.setdefault("NUMBA_NUM_THREADS", "1")

import time

import numpy as np
from benchmark_options import ask, machine

from stepaside.studies.code_version import UNICYCLES
from stepaside.studies.result_files import header, write_result
from stepaside.theory.unicycle.kernel import play_games
from stepaside.theory.unicycle.unicycle_game import make_game


def measure_kernel(games: int, steps: int) -> dict[str, float]:
    """Return steps per second of both, their ratio and largest difference."""
    game = make_game(1.0, 1.0, 0.5, 0.5)
    rng = np.random.default_rng(0)
    angles = rng.uniform(-np.pi, np.pi, (games, 2))
    starts = np.column_stack([rng.uniform(0.3, 6.0, games), angles])
    duration = 0.01 * steps
    play_games(game, starts[:10], 0.1)  # compile, or load from the cache
    best = {"numba": 0.0, "numpy": 0.0}
    closest = {}
    for _ in range(2):
        for backend in best:
            begin = time.process_time()
            out = play_games(
                game, starts, duration, backend=backend, capture_distance=0.2
            )
            rate = games * steps / (time.process_time() - begin)
            best[backend] = max(best[backend], rate)
            closest[backend] = out.closest_distance
    gap = np.abs(closest["numba"] - closest["numpy"]).max()
    return {
        "compiled_steps_per_s": best["numba"],
        "numpy_steps_per_s": best["numpy"],
        "compiled_over_numpy": best["numba"] / best["numpy"],
        "greatest_difference_m": float(gap),
    }


def main() -> None:
    """Measure, write and print the results."""
    asked = ask(__doc__, "kernel.json")
    asked.add_argument("--games", type=int, default=16_384)
    asked.add_argument("--steps", type=int, default=1000)
    arguments = asked.parse_args()

    figures = measure_kernel(arguments.games, arguments.steps)
    settings = {"games": arguments.games, "steps": arguments.steps}
    head = header(settings, modules=UNICYCLES, libraries=("numpy", "numba"))
    write_result(arguments.output, head, machine=machine(), figures=figures)
    for name, value in figures.items():
        print(f"{name}: {value:.3g}")


if __name__ == "__main__":
    main()
