"""Values that the public interface returns, each computed once."""

from functools import cache
from typing import Any

import stepaside
from stepaside import Direction, Foot, GaitSettings, Run, duel
from stepaside.theory.value import CarGame, solve_cars


@cache
def a_run() -> Run:
    return stepaside.run_game(duel(seed=3, duration=0.4))


@cache
def a_bound() -> Any:
    game = CarGame(1.0, 1.0, pursuer_gain=1.0)
    return solve_cars(game, 4.0, 8, horizon=0.1)


@cache
def a_plan() -> Any:
    return plan(0.3)


def plan(bearing: Any) -> Any:
    return stepaside.ManeuverPlanner(GaitSettings()).plan(
        bearing, Direction.BACKWARD, first_foot=Foot.LEFT, standing=True
    )
