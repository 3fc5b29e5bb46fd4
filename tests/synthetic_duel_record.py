"""Duel records with prescribed distance, angle and radii over time."""

from collections.abc import Callable

import numpy as np

from stepaside.core.poses import Array
from stepaside.games.duel_circle import circle_of_theory
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.trajectory import Trajectory

SETTINGS = DuelSettings(start=StartSettings(1.0, 0.1, -0.2))
THEORY = circle_of_theory(SETTINGS)
CYCLE = 2.0 * SETTINGS.gait.step_duration
TIMES: Array = 0.02 * np.arange(3001, dtype=float)
Law = Callable[[Array], Array]


def still(value: float) -> Law:
    return lambda times: np.full_like(times, value)


def stepped(at: float, before: float, after: float) -> Law:
    return lambda times: np.where(times < at, before, after)


ROUND = (still(THEORY.distance_m), still(THEORY.headings_apart_rad))
RADII = (still(0.5), still(0.7))


class Record:
    """Two players some way apart, the first on a circle.

    Their torsos are a little ahead of the places that stand for them, and
    their CoMs on circles round other places.
    """

    def __init__(
        self,
        distance: Law = ROUND[0],
        apart: Law = ROUND[1],
        radii: tuple[Law, Law] = RADII,
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
        self.torsos = {
            name: place
            + 0.014
            * np.column_stack(
                [np.cos(place[:, 2]), np.sin(place[:, 2]), 0.0 * times]
            )
            for name, place in self.places.items()
        }
        self.coms: dict[str, Array] = {}
        middles = {"pursuer": (1.0, -2.0), "evader": (-3.0, 0.5)}
        for (name, (x, y)), radius in zip(middles.items(), radii, strict=True):
            size = radius(times)
            self.coms[name] = np.column_stack(
                [
                    x + size * np.cos(heading),
                    y + size * np.sin(heading),
                    0.27 + 0.01 * np.sin(9.0 * times),
                ]
            )

    def tracks(self) -> dict[str, Trajectory]:
        """Record of each player."""
        return {
            name: Trajectory(
                self.coms[name], self.torsos[name], self.places[name]
            )
            for name in self.torsos
        }
