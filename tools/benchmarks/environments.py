"""Time learning environments, and an environment of MPE2.

A step is one decision of one environment, with reward and observation. All
are timed in one process on one core, in turns; the best of three counts for
each::

    NUMBA_NUM_THREADS=1 python tools/benchmarks/environments.py

``--mpe2`` also times ``simple_tag_v3`` of MPE2 (``pip install mpe2``) with one
pursuer, one evader and no obstacles, through its PettingZoo interface.
"""

import os

os.environ.setdefault("NUMBA_NUM_THREADS", "1")

import time
from collections.abc import Callable
from typing import Any

import numpy as np
from benchmark_options import ask, machine
from result_files import header, write_result

from stepaside.envs import ParallelDuel, VectorDuel

ROUNDS = 3
SETTINGS: dict[str, Any] = {"level": "steps", "duration": 60.0}
BACK = np.array([0.0, 1.0], np.float32)


def vector_steps(games: int, steps: int) -> Callable[[], int]:
    """Return a function that plays the vector environment."""
    envs = VectorDuel(games, role="evader", **SETTINGS)
    envs.reset(seed=0)
    actions = np.tile(BACK, (games, 1))

    def play() -> int:
        for _ in range(steps):
            envs.step(actions)
        return games * steps

    return play


def parallel_steps(env: Any, steps: int, actions: Any) -> Callable[[], int]:
    """Return a function that plays a PettingZoo environment."""

    def play() -> int:
        env.reset(seed=0)
        for _ in range(steps):
            if not env.agents:
                env.reset()
            env.step(actions)
        return steps

    return play


def measure(games: int, steps: int, *, mpe2: bool) -> dict[str, float]:
    """Return steps per second of each, and ratios."""
    both = {"pursuer": BACK, "evader": BACK}
    players: dict[str, Callable[[], int]] = {
        "vector": vector_steps(games, steps),
        "parallel": parallel_steps(ParallelDuel(**SETTINGS), 10 * steps, both),
    }
    if mpe2:
        from mpe2 import simple_tag_v3

        env = simple_tag_v3.parallel_env(
            num_good=1, num_adversaries=1, num_obstacles=0, max_cycles=150
        )
        still = {"adversary_0": 1, "agent_0": 1}
        players["mpe2"] = parallel_steps(env, 10 * steps, still)
    best = dict.fromkeys(players, 0.0)
    for play in players.values():
        play()  # compile, or load from the cache
    for _ in range(ROUNDS):
        for name, play in players.items():
            begin = time.process_time()
            count = play()
            rate = count / (time.process_time() - begin)
            best[name] = max(best[name], rate)
    figures = {f"{name}_steps_per_s": rate for name, rate in best.items()}
    if mpe2:
        figures["vector_over_mpe2"] = best["vector"] / best["mpe2"]
        figures["parallel_over_mpe2"] = best["parallel"] / best["mpe2"]
    return figures


def main() -> None:
    """Measure, write and print the results."""
    asked = ask(__doc__, "environments.json")
    asked.add_argument("--games", type=int, default=4096)
    asked.add_argument("--steps", type=int, default=300)
    asked.add_argument("--mpe2", action="store_true")
    given = asked.parse_args()
    figures = measure(given.games, given.steps, mpe2=given.mpe2)
    head = header({"games": given.games, "steps": given.steps})
    write_result(given.output, head, machine=machine(), figures=figures)
    for name, value in figures.items():
        print(f"{name}: {value:.3g}")


if __name__ == "__main__":
    main()
