"""Test the circle of theory and the convergence of a duel to it."""

from collections.abc import Callable
from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.games.forecast import circle_of_theory, convergence_time
from stepaside.games.game_settings import GameSettings, StartSettings, duel
from stepaside.games.trajectory import cycle_mean
from stepaside.sim.person_settings import PersonSettings
from stepaside.strategies import Evasion

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


def since(record: Record, settings: GameSettings = SETTINGS) -> float | None:
    """Return the time from which a record is on the circle, in [s]."""
    places = record.places["pursuer"], record.places["evader"]
    return convergence_time(
        record.times, *places, settings, circle_of_theory(settings)
    )


def test_theory_is_the_circle_of_the_settings() -> None:
    """Radius 4v/(pi k) for both, headings a right angle apart."""
    gait = SETTINGS.gait
    radius = 4.0 * gait.speed / (pi * gait.gain)
    assert THEORY.radius_evader_m == pytest.approx(radius)
    assert THEORY.distance_m == pytest.approx(2**0.5 * radius)
    assert THEORY.headings_apart_rad == pytest.approx(pi / 2)
    back = SETTINGS.changed(evasion=Evasion(angle=0.0))
    assert not circle_of_theory(back).exists
    sliding = SETTINGS.changed(evasion=Evasion(saturated=True))
    assert circle_of_theory(sliding).radius_evader_m == pytest.approx(0.5)


def test_a_person_walks_the_same_circle_at_the_real_time_scale() -> None:
    """The gait scales time; lengths and angles are unchanged."""
    gait = SETTINGS.gait
    pace = gait.path_interval / gait.step_duration
    assert pace < 0.9
    person = PersonSettings(speed=gait.speed * pace, gain=gait.gain * pace)
    circle = circle_of_theory(
        SETTINGS.changed(pursuer={"body": "person"}, person=person)
    )
    assert circle.radius_evader_m == pytest.approx(THEORY.radius_evader_m)
    assert circle.distance_m == pytest.approx(THEORY.distance_m)
    assert circle.turning_rate_rad_s == pytest.approx(
        THEORY.turning_rate_rad_s
    )
    slower = replace(person, speed=0.9 * person.speed)
    other = circle_of_theory(
        SETTINGS.changed(pursuer={"body": "person"}, person=slower)
    )
    assert other.radius_pursuer_m < 0.95 * other.radius_evader_m
    unsure = replace(person, gain=0.9 * person.gain)
    other = circle_of_theory(
        SETTINGS.changed(pursuer={"body": "person"}, person=unsure)
    )
    assert other.turning_rate_rad_s < 0.99 * circle.turning_rate_rad_s


def test_the_mean_over_a_cycle_removes_only_the_sway() -> None:
    times: Array = 0.02 * np.arange(500, dtype=float)
    sway = np.sin(2.0 * pi * times / 0.5)
    mean = cycle_mean(3.0 + 0.1 * times + sway, times, 0.5)
    inner = slice(13, -13)
    np.testing.assert_allclose(
        mean[inner], (3.0 + 0.1 * times)[inner], atol=1e-9
    )
    np.testing.assert_allclose(cycle_mean(np.full(500, 3.0), times, 0.5), 3.0)


# A step of four bands is within the band once a quarter of a cycle is off.
LATE = CYCLE / 4.0


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("at", [12.0, 50.0])
def test_they_converge_within_5_degrees_and_5_percent(
    side: float, at: float
) -> None:
    right = THEORY.headings_apart_rad
    off = right + side * np.radians(20.0)
    found = since(Record(apart=stepped(at, off, right)))
    assert found == pytest.approx(at + LATE, abs=0.021)
    right = THEORY.distance_m
    found = since(Record(stepped(at, (1.0 + 0.2 * side) * right, right)))
    assert found == pytest.approx(at + LATE, abs=0.021)


def test_the_circle_is_that_of_the_arguments_of_evasion() -> None:
    told = duel(evader={"evasion": Evasion(angle=radians(45.0))})
    named = duel(evader={"strategy": "evasion(angle=45deg)"})
    wanted, found = circle_of_theory(told), circle_of_theory(named)
    assert found.exists and found.distance_m == wanted.distance_m
    assert named.resolved() == told.resolved()
