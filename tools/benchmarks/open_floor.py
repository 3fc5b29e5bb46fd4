"""Compare survival on an open floor with the value of the game of two cars.

Where the value exceeds the capture distance an evader can survive any pursuer
of the given speed and turns, for the duration of the games. The starts have
any heading. An interrupted run continues::

    python tools/benchmarks/open_floor.py --seeds 0:20
"""

from dataclasses import dataclass
from functools import cache
from math import pi

from benchmark_options import ask, machine, seeds_of
from names import name_and_speed
from resumable_jobs import Row, finished, gather

from stepaside.arena import draw_any_start
from stepaside.core.poses import rotate
from stepaside.games import play_strategies
from stepaside.strategies import load_strategy
from stepaside.strategies.strategy_game import StepGame
from stepaside.studies.result_files import header, write_result
from stepaside.theory.value import ValueTable, solve_cars, two_car_game

EVADERS = ("look-ahead", "robust")
PURSUERS = (
    *("pursuit", "pursuit(gain=3)", "sharp", "optimal-pursuit"),
    *("pursuit@1.1", "sharp@1.1"),  # at that speed, over the evader's
)
FAR = 9.5  # of the grid, in turning radii
CELLS = 24
GAME = StepGame()
RATE = GAME.turn / GAME.period  # largest turning rate, in [rad/s]


@dataclass(frozen=True, slots=True)
class OpenGame:
    """One game on an open floor.

    Attributes:
        evader: Name of the evader.
        pursuer: Name of the pursuer, with @RATIO at another speed.
        seed: Seed of the start.
    """

    evader: str
    pursuer: str
    seed: int


@cache
def bound_of(speed_ratio: float) -> ValueTable:
    """Return the value of two cars, in turning radii of the evader.

    Against a faster pursuer it falls for the whole game.
    """
    return solve_cars(
        two_car_game(speed_ratio, 1.0, 1.0),
        FAR,
        CELLS,
        horizon=RATE * GAME.duration if speed_ratio > 1.0 else None,
    )


def value_of(seed: int, speed_ratio: float) -> float:
    """Return the closest approach that a start guarantees, in [m]."""
    pursuer, evader = draw_any_start(seed)
    unit = GAME.stride / GAME.turn
    x, y = evader.x - pursuer.x, evader.y - pursuer.y
    x, y = rotate(x / unit, y / unit, -pursuer.theta)
    # The evader walks backwards.
    away = evader.theta + pi - pursuer.theta
    return unit * float(bound_of(speed_ratio).value((x, y, away)))


def play(game: OpenGame) -> Row:
    """Play a game and return whether the evader survived."""
    name, ratio = name_and_speed(game.pursuer)
    track = play_strategies(
        load_strategy(name),
        load_strategy(game.evader),
        draw_any_start(game.seed),
        game=StepGame(pursuer_speed_ratio=ratio),
    )
    return {
        "evader": game.evader,
        "pursuer": game.pursuer,
        "seed": game.seed,
        "survived": not track.captured,
        "survived_s": float(track.times[-1]),
        "closest_m": track.closest_distance,
    }


def main() -> None:
    """Play, and write the results."""
    asked = ask(__doc__, "open-floor.json")
    asked.add_argument("--seeds", type=seeds_of, default=range(20))
    asked.add_argument("--pursuers", nargs="+", default=PURSUERS)
    asked.add_argument("--workers", type=int)
    arguments = asked.parse_args()
    seeds = arguments.seeds
    head = header(
        {
            "seeds": f"{seeds.start}:{seeds.stop}",
            "capture_m": GAME.capture,
            "duration_s": GAME.duration,
            "cells": CELLS,
        }
    )
    jobs = {
        f"{pursuer}-{evader}-{seed}": OpenGame(evader, pursuer, seed)
        for pursuer in arguments.pursuers
        for evader in EVADERS
        for seed in seeds
    }
    games = gather(arguments.output, head, jobs, play, arguments.workers)
    rows = []
    for pursuer in arguments.pursuers:
        _, ratio = name_and_speed(pursuer)
        values = {seed: value_of(seed, ratio) for seed in seeds}
        for evader in EVADERS:
            own = [
                row
                for row in games.values()
                if (row["evader"], row["pursuer"]) == (evader, pursuer)
            ]
            sure = [r for r in own if values[r["seed"]] > GAME.capture]
            rest = [r for r in own if values[r["seed"]] <= GAME.capture]
            rows.append(
                {
                    "pursuer": pursuer,
                    "evader": evader,
                    "sure": len(sure),
                    "sure_survived": sum(r["survived"] for r in sure),
                    "open": len(rest),
                    "open_survived": sum(r["survived"] for r in rest),
                    "lost_m": [
                        values[r["seed"]] for r in sure if not r["survived"]
                    ],
                    "falling": bound_of(ratio).change,
                }
            )
    write_result(arguments.output, head, machine=machine(), rows=rows)
    finished(arguments.output)


if __name__ == "__main__":
    main()
