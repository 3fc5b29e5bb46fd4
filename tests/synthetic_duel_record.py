"""Duel records with prescribed distance and angle over time."""

from collections.abc import Callable

import numpy as np

from stepaside.core.poses import Array
from stepaside.games.duel_circle import circle_of_theory
from stepaside.games.game_settings import StartSettings, duel

SETTINGS = duel(start=StartSettings(1.0, 0.1, -0.2))
THEORY = circle_of_theory(SETTINGS)
CYCLE = 2.0 * SETTINGS.gait.step_duration
TIMES: Array = 0.02 * np.arange(3001, dtype=float)
Law = Callable[[Array], Array]


def still(value: float) -> Law:
    return lambda times: np.full_like(times, value)


def stepped(at: float, before: float, after: float) -> Law:
    return lambda times: np.where(times < at, before, after)


ROUND = (still(THEORY.distance_m), still(THEORY.headings_apart_rad))


class Record:
    """Two players some way apart, the first on a circle."""

    def __init__(
        self,
        distance: Law = ROUND[0],
        apart: Law = ROUND[1],
        times: Array = TIMES,
    ) -> None:
        heading = 0.4 * times
        away = distance(times)
        pursuer = np.column_stack(
            [0.4 * np.cos(heading), 0.4 * np.sin(heading), heading]
        )
        evader = pursuer + np.column_stack(
            [away * np.cos(0.3), away * np.sin(0.3), apart(times)]
        )
        self.times, self.places = times, {"pursuer": pursuer, "evader": evader}
