"""Time games of several unicycles against the kernel of two.

All are compiled and played in one process, alternately; the best of five
counts for each. Each game has one evader; all others pursue it. Processor
time on one core::

    NUMBA_NUM_THREADS=1 python tools/benchmarks/team_kernel.py
"""

import os

os.environ.setdefault("NUMBA_NUM_THREADS", "1")

import time
from typing import Any

import numpy as np
from benchmark_options import ask, machine

from stepaside.studies.code_version import UNICYCLES
from stepaside.studies.result_files import header, write_result
from stepaside.theory.teams.team_game import play_team_games
from stepaside.theory.teams.team_players import TeamPlayer
from stepaside.theory.unicycle.kernel import play_games
from stepaside.theory.unicycle.unicycle_game import make_game

STEP = 0.01  # in [s]
COUNTS = (2, 4, 8)  # players
ROUNDS = 5


def team_rate(count: int, games: int, steps: int) -> float:
    """Return player-steps per second of games of several players."""
    players = [TeamPlayer(1.0, 0.5, target=count - 1)] * (count - 1)
    players = [*players, TeamPlayer(1.0, 0.5, evades=True)]
    rng = np.random.default_rng(0)
    starts = rng.uniform(-6.0, 6.0, (games, count, 3))
    begin = time.process_time()
    play_team_games(players, starts, STEP * steps, step=STEP, backend="numba")
    passed = time.process_time() - begin
    return games * count * steps / passed


def pair_rate(games: int, steps: int) -> float:
    """Return player-steps per second of the kernel of two players."""
    rng = np.random.default_rng(0)
    angles = rng.uniform(-np.pi, np.pi, (games, 2))
    starts = np.column_stack([rng.uniform(0.3, 6.0, games), angles])
    game = make_game(1.0, 1.0, 0.5, 0.5)
    begin = time.process_time()
    play_games(game, starts, STEP * steps, step=STEP, backend="numba")
    passed = time.process_time() - begin
    return 2.0 * games * steps / passed


def measure(games: int, steps: int) -> list[dict[str, Any]]:
    """Return player-steps and pair-steps per second, and their ratios."""
    pair_rate(64, 10)  # compile, or load from the cache
    for count in COUNTS:
        team_rate(count, 64, 10)
    two, teams = 0.0, dict.fromkeys(COUNTS, 0.0)
    for _ in range(ROUNDS):
        two = max(two, pair_rate(games, steps))
        for count in COUNTS:
            rate = team_rate(count, games // count, steps)
            teams[count] = max(teams[count], rate)
    rows = [rates(2, two, two), *(rates(n, r, two) for n, r in teams.items())]
    return [{"kernel": "two players"} | rows[0]] + [
        {"kernel": "several players"} | row for row in rows[1:]
    ]


def rates(count: int, rate: float, two: float) -> dict[str, float]:
    """Return rates of a kernel.

    Args:
        count: Number of players.
        rate: Player-steps per second.
        two: Those of the kernel of two players.
    """
    return {
        "players": count,
        "player_steps_per_s": rate,
        "pair_steps_per_s": rate * 0.5 * (count - 1),
        "cost_per_player_over_two": two / rate,
    }


def main() -> None:
    """Measure, write and print the results."""
    asked = ask(__doc__, "team-kernel.json")
    asked.add_argument("--games", type=int, default=16_384)
    asked.add_argument("--steps", type=int, default=1000)
    arguments = asked.parse_args()

    rows = measure(arguments.games, arguments.steps)
    settings = {"games": arguments.games, "steps": arguments.steps}
    modules = ("theory/teams", *UNICYCLES)
    head = header(settings, modules=modules, libraries=("numpy", "numba"))
    write_result(arguments.output, head, machine=machine(), rows=rows)
    for row in rows:
        print(", ".join(f"{key} {value}" for key, value in row.items()))


if __name__ == "__main__":
    main()
