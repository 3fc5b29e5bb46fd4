"""Values that the public interface returns, each computed once."""

from functools import cache
from typing import Any

import stepaside
from stepaside import Direction, DuelRun, DuelSettings, Foot, GaitSettings
from stepaside.theory.bound import Grid, fixed_pursuit_game, solve_bound


@cache
def a_run() -> DuelRun:
    return stepaside.run_duel(DuelSettings(seed=3, duration=0.4))


@cache
def a_bound() -> Any:
    grid = Grid(0.3, 4.0, 17, 16, 16)
    return solve_bound(fixed_pursuit_game(1.0, 1.0, 1.0), grid, horizon=0.1)


@cache
def a_plan() -> Any:
    return plan(0.3)


def plan(bearing: Any) -> Any:
    return stepaside.ManeuverPlanner(GaitSettings()).plan(
        bearing, Direction.BACKWARD, first_foot=Foot.LEFT, standing=True
    )
