"""Test the circle of theory and the convergence of a duel to it."""

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.games.duel_circle import (
    circle_of_theory,
    convergence_time,
    cycle_mean,
)
from stepaside.games.game_settings import GameSettings, duel
from stepaside.sim.person_settings import PersonSettings
from stepaside.strategies import Evasion
from synthetic_duel_record import (
    CYCLE,
    SETTINGS,
    THEORY,
    TIMES,
    Record,
    stepped,
    still,
)


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
        pace * THEORY.turning_rate_rad_s
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


@pytest.mark.parametrize("share", [0.9, -0.9, 1.1, -1.1])
def test_a_duel_just_outside_the_band_never_converges(share: float) -> None:
    away = still(THEORY.distance_m * (1.0 + 0.05 * share))
    apart = still(THEORY.headings_apart_rad + np.radians(5.0 * share))
    expected = 0.0 if abs(share) < 1.0 else None
    assert since(Record(away)) == expected
    assert since(Record(apart=apart)) == expected


def test_convergence_counts_only_after_the_last_departure() -> None:
    right, off = THEORY.distance_m, 1.2 * THEORY.distance_m

    def left(times: Array) -> Array:
        return np.where((times > 20.0) & (times < 25.0), off, right)

    found = since(Record(left))
    assert found == pytest.approx(25.0 + LATE, abs=0.021)
    gone = Record(stepped(40.0, right, off))
    assert since(gone) is None


def test_the_last_five_seconds_must_be_on_the_circle() -> None:
    right, off = THEORY.distance_m, 1.2 * THEORY.distance_m
    just = Record(stepped(54.9 - LATE, off, right))
    assert since(just) == pytest.approx(54.9, abs=0.1)
    late = Record(stepped(55.1 - LATE, off, right))
    assert since(late) is None


@pytest.mark.parametrize("samples", [3, 9, 55])
def test_a_truncated_cycle_at_the_end_is_not_evaluated(samples: int) -> None:
    """Sway whose half cycles are off, but whose whole ones are not.

    However few samples a cycle has.
    """
    times = CYCLE / samples * np.arange(30 * samples, dtype=float)

    def sway(times: Array) -> Array:
        phase = 2.0 * pi * (times - times[-1]) / CYCLE
        off: Array = np.radians(12.0) * np.sin(phase)
        return THEORY.headings_apart_rad + off

    found = since(Record(apart=sway, times=times))
    assert found is not None and found < CYCLE


def test_the_last_complete_cycle_is_evaluated() -> None:
    """A departure 0.8 of a cycle before the end is detected."""
    left = 60.0 - 0.8 * CYCLE
    far = 1.12 * THEORY.distance_m
    gone = Record(stepped(left, THEORY.distance_m, far))
    assert since(gone) is None


def test_nothing_converges_without_a_circle_or_a_record() -> None:
    back = SETTINGS.changed(evasion=Evasion(angle=0.0))
    assert since(Record(), back) is None
    assert since(Record(times=TIMES[:2])) is None
    assert since(Record(times=TIMES[:200])) is None


def test_the_circle_is_that_of_the_arguments_of_evasion() -> None:
    told = duel(evader={"evasion": Evasion(angle=radians(45.0))})
    named = duel(evader={"strategy": "evasion(angle=45deg)"})
    wanted, found = circle_of_theory(told), circle_of_theory(named)
    assert found.exists and found.distance_m == wanted.distance_m
    assert named.resolved() == told.resolved()
