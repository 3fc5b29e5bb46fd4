"""Time many games at once: compiled kernel beside plain NumPy.

Both play the same games in one process, in alternation; the best of two
counts for either. On one core::

    NUMBA_NUM_THREADS=1 python benchmarks/kernel.py
"""

import argparse
import time

import numpy as np

from stepaside.unicycle.kernel import play_games
from stepaside.unicycle.laws import make_game


def main() -> None:
    """Print steps per second of both, their ratio and largest difference."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--games", type=int, default=16_384)
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--seconds", type=float, help="also one long run [s]")
    arguments = parser.parse_args()

    import numba

    cores = numba.get_num_threads()
    game = make_game(1.0, 1.0, 0.5, 0.5)
    rng = np.random.default_rng(0)
    angles = rng.uniform(-np.pi, np.pi, (arguments.games, 2))
    starts = np.column_stack([rng.uniform(0.3, 6.0, arguments.games), angles])
    duration = 0.01 * arguments.steps
    work = arguments.games * arguments.steps
    play_games(game, starts[:10], 0.1)  # compile, or load what was compiled
    best = {"numba": 0.0, "numpy": 0.0}
    closest = {}
    for _ in range(2):
        for backend in best:
            begin = time.perf_counter()
            out = play_games(
                game, starts, duration, backend=backend, capture_distance=0.2
            )
            rate = work / (time.perf_counter() - begin)
            best[backend] = max(best[backend], rate)
            closest[backend] = out.closest_distance
    gap = np.abs(closest["numba"] - closest["numpy"]).max()
    print(f"{arguments.games} games of {arguments.steps} steps of 0.01 s")
    print(f"compiled, {cores} core(s)  {best['numba'] / 1e6:8.1f} M steps/s")
    print(f"plain NumPy, one core {best['numpy'] / 1e6:8.1f} M steps/s")
    print(f"ratio                 {best['numba'] / best['numpy']:8.1f}")
    print(f"largest difference    {gap:8.1e} m")
    if arguments.seconds:
        begin = time.perf_counter()
        play_games(game, starts, arguments.seconds, capture_distance=0.2)
        spent = time.perf_counter() - begin
        rate = arguments.games * arguments.seconds / 0.01 / spent / 1e6
        print(f"{arguments.seconds:g} s games: {spent:.1f} s, {rate:.1f} M/s")


if __name__ == "__main__":
    main()
