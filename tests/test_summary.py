"""Figures of a duel, from records whose figures are known."""

from collections.abc import Callable
from dataclasses import replace
from math import degrees, pi
from typing import Any

import numpy as np
import pytest

from stepaside.games import summary
from stepaside.games.duel import DuelResult, Outcome
from stepaside.games.settings import (
    DuelSettings,
    StartSettings,
    StrategySettings,
)
from stepaside.games.summary import (
    converged_at,
    cycle_mean,
    distance_over_time,
    orientation_over_time,
    summarise,
    theory_of,
)
from stepaside.poses import Array, Pose
from stepaside.world.person_settings import PersonSettings

SETTINGS = DuelSettings(start=StartSettings(1.0, 0.1, -0.2))
THEORY = theory_of(SETTINGS)
CYCLE = 2.0 * SETTINGS.gait.step_duration
TIMES: Array = 0.02 * np.arange(3001, dtype=float)
Law = Callable[[Array], Array]


def still(value: float) -> Law:
    return lambda times: np.full_like(times, value)


def stepped(at: float, before: float, after: float) -> Law:
    return lambda times: np.where(times < at, before, after)


ROUND = (still(THEORY.distance_m), still(THEORY.headings_apart_rad))
RADII = (still(0.5), still(0.7))


def record(
    distance: Law = ROUND[0],
    apart: Law = ROUND[1],
    radii: tuple[Law, Law] = RADII,
    times: Array = TIMES,
) -> dict[str, Array]:
    """Torsos some way apart, and CoMs on circles round other places."""
    heading = 0.4 * times
    away = distance(times)
    pursuer = np.column_stack([0.1 * times, 0.0 * times, heading])
    evader = pursuer + np.column_stack(
        [away * np.cos(0.3), away * np.sin(0.3), apart(times)]
    )
    arrays = {
        "times_s": times,
        "pursuer_torso": pursuer,
        "evader_torso": evader,
        "pursuer_landings": np.zeros((4, 5)),
    }
    middles = {"pursuer": (1.0, -2.0), "evader": (-3.0, 0.5)}
    for (name, (x, y)), radius in zip(middles.items(), radii, strict=True):
        size = radius(times)
        arrays[f"{name}_com"] = np.column_stack(
            [
                x + size * np.cos(heading),
                y + size * np.sin(heading),
                0.27 + 0.01 * np.sin(9.0 * times),
            ]
        )
    return arrays


def result(arrays: dict[str, Array], **changes: Any) -> DuelResult:
    made = DuelResult(
        settings=SETTINGS,
        outcome=Outcome.COMPLETED,
        message="played",
        duration=60.0,
        arrays=arrays,
        min_distance=0.61,
        triggered_at=2.5,
        triggered_distance=0.79,
        sight=None,
        stills={},
        replans=17,
        planning_times=np.array([3e-4, 1e-4, 2e-4]),
        velocity_jump=1e-12,
        zmp_margin=0.021,
        wall_time=3.0,
    )
    return replace(made, **changes)


def test_theory_is_the_circle_of_the_settings() -> None:
    """Level 0: radius 4v/(pi k) for both, headings a right angle apart."""
    gait = SETTINGS.gait
    radius = 4.0 * gait.speed / (pi * gait.gain)
    assert THEORY.radius_evader_m == pytest.approx(radius)
    assert THEORY.distance_m == pytest.approx(2**0.5 * radius)
    assert THEORY.headings_apart_rad == pytest.approx(pi / 2)
    back = replace(SETTINGS, strategy=StrategySettings(angle=0.0))
    assert not theory_of(back).exists
    sliding = replace(SETTINGS, strategy=StrategySettings(saturated=True))
    assert theory_of(sliding).radius_evader_m == pytest.approx(0.5)


def test_a_person_walks_the_same_circle_at_its_own_pace() -> None:
    """Time is scaled by the gait's pace; lengths and angles are not."""
    gait = SETTINGS.gait
    pace = gait.path_interval / gait.step_duration
    assert pace < 0.9
    person = PersonSettings(speed=gait.speed * pace, gain=gait.gain * pace)
    circle = theory_of(replace(SETTINGS, pursuer="person", person=person))
    assert circle.radius_evader_m == pytest.approx(THEORY.radius_evader_m)
    assert circle.distance_m == pytest.approx(THEORY.distance_m)
    assert circle.turning_rate_rad_s == pytest.approx(
        pace * THEORY.turning_rate_rad_s
    )
    slower = replace(person, speed=0.9 * person.speed)
    other = theory_of(replace(SETTINGS, pursuer="person", person=slower))
    assert other.radius_pursuer_m < 0.95 * other.radius_evader_m
    unsure = replace(person, gain=0.9 * person.gain)
    other = theory_of(replace(SETTINGS, pursuer="person", person=unsure))
    assert other.turning_rate_rad_s < 0.99 * circle.turning_rate_rad_s


def test_distance_is_between_the_torsos_in_the_plane() -> None:
    arrays = {
        "pursuer_torso": np.array([[1.0, 2.0, 9.0], [0.0, 0.0, 0.0]]),
        "evader_torso": np.array([[4.0, -2.0, 0.0], [0.0, -1.0, 2.0]]),
    }
    np.testing.assert_allclose(distance_over_time(arrays), [5.0, 1.0])


@pytest.mark.parametrize(
    ("pursuer", "evader", "apart"),
    [
        (0.0, 90.0, 90.0),
        (90.0, 0.0, 90.0),
        (350.0, 20.0, 30.0),
        (0.0, 200.0, 160.0),
        (-170.0, 170.0, 20.0),
        (30.0, 750.0, 0.0),
    ],
)
def test_headings_are_apart_by_the_smaller_angle(
    pursuer: float, evader: float, apart: float
) -> None:
    arrays = {
        "pursuer_torso": np.radians([[0.0, 0.0, pursuer]]),
        "evader_torso": np.radians([[0.0, 0.0, evader]]),
    }
    found = np.degrees(orientation_over_time(arrays))
    np.testing.assert_allclose(found, apart, atol=1e-9)


def test_the_mean_over_a_cycle_takes_out_the_sway_alone() -> None:
    times: Array = 0.02 * np.arange(500, dtype=float)
    sway = np.sin(2.0 * pi * times / 0.5)
    mean = cycle_mean(3.0 + 0.1 * times + sway, times, 0.5)
    inner = slice(13, -13)
    np.testing.assert_allclose(
        mean[inner], (3.0 + 0.1 * times)[inner], atol=1e-9
    )
    np.testing.assert_allclose(cycle_mean(np.full(500, 3.0), times, 0.5), 3.0)


def test_the_mean_at_the_ends_is_over_what_there_is() -> None:
    times = np.arange(5.0)
    mean = cycle_mean(np.array([0.0, 3.0, 6.0, 0.0, 9.0]), times, 3.0)
    np.testing.assert_allclose(mean, [1.5, 3.0, 3.0, 5.0, 4.5])
    alone = cycle_mean(np.array([1.0, 2.0, 6.0]), np.arange(3.0), 3.0)
    np.testing.assert_allclose(alone, 3.0)
    longer = cycle_mean(np.array([1.0, 2.0, 6.0]), np.arange(3.0), 9.0)
    np.testing.assert_allclose(longer, 3.0)
    every = np.array([1.0, 2.0, 6.0])
    np.testing.assert_allclose(cycle_mean(every, np.arange(3.0), 0.1), every)
    two = np.array([1.0, 2.0])
    np.testing.assert_array_equal(cycle_mean(two, np.arange(2.0), 9.0), two)


# A step of four bands is within the band once a quarter of a cycle is off.
LATE = CYCLE / 4.0


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("at", [12.0, 30.0, 50.0])
def test_they_converge_when_the_angle_is_within_5_degrees(
    side: float, at: float
) -> None:
    right = THEORY.headings_apart_rad
    off = right + side * np.radians(20.0)
    arrays = record(apart=stepped(at, off, right))
    found = converged_at(arrays, SETTINGS, THEORY)
    assert found == pytest.approx(at + LATE, abs=0.021)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("at", [12.0, 30.0, 50.0])
def test_they_converge_when_the_distance_is_within_5_percent(
    side: float, at: float
) -> None:
    right = THEORY.distance_m
    arrays = record(stepped(at, (1.0 + 0.2 * side) * right, right))
    found = converged_at(arrays, SETTINGS, THEORY)
    assert found == pytest.approx(at + LATE, abs=0.021)


@pytest.mark.parametrize("share", [0.9, -0.9])
def test_within_the_band_they_are_on_the_circle_from_the_start(
    share: float,
) -> None:
    arrays = record(
        still(THEORY.distance_m * (1.0 + 0.05 * share)),
        still(THEORY.headings_apart_rad + np.radians(5.0 * share)),
    )
    assert converged_at(arrays, SETTINGS, THEORY) == 0.0


@pytest.mark.parametrize("share", [1.1, -1.1])
def test_just_outside_the_band_they_never_converge(share: float) -> None:
    wide = record(still(THEORY.distance_m * (1.0 + 0.05 * share)))
    assert converged_at(wide, SETTINGS, THEORY) is None
    angle = THEORY.headings_apart_rad + np.radians(5.0 * share)
    assert converged_at(record(apart=still(angle)), SETTINGS, THEORY) is None


def test_who_leaves_the_circle_has_not_converged_before() -> None:
    right, off = THEORY.distance_m, 1.2 * THEORY.distance_m

    def left(times: Array) -> Array:
        return np.where((times > 20.0) & (times < 25.0), off, right)

    found = converged_at(record(left), SETTINGS, THEORY)
    assert found == pytest.approx(25.0 + LATE, abs=0.021)
    gone = record(stepped(40.0, right, off))
    assert converged_at(gone, SETTINGS, THEORY) is None


def test_the_last_five_seconds_must_be_on_the_circle() -> None:
    right, off = THEORY.distance_m, 1.2 * THEORY.distance_m
    just = record(stepped(54.9 - LATE, off, right))
    assert converged_at(just, SETTINGS, THEORY) == pytest.approx(54.9, abs=0.1)
    late = record(stepped(55.1 - LATE, off, right))
    assert converged_at(late, SETTINGS, THEORY) is None


def test_a_cycle_that_the_end_cuts_is_not_judged() -> None:
    """Sway whose half cycles are off, but whose whole ones are not."""

    def sway(times: Array) -> Array:
        phase = 2.0 * pi * (times - times[-1]) / CYCLE
        off: Array = np.radians(12.0) * np.sin(phase)
        return THEORY.headings_apart_rad + off

    arrays = record(apart=sway)
    found = converged_at(arrays, SETTINGS, THEORY)
    assert found is not None and found < CYCLE


def test_the_last_whole_cycle_is_judged() -> None:
    """Who leaves the circle 0.8 of a cycle before the end is seen to."""
    left = 60.0 - 0.8 * CYCLE
    far = 1.12 * THEORY.distance_m
    gone = record(stepped(left, THEORY.distance_m, far))
    assert converged_at(gone, SETTINGS, THEORY) is None


def test_nothing_converges_without_a_circle_or_a_record() -> None:
    back = replace(SETTINGS, strategy=StrategySettings(angle=0.0))
    assert converged_at(record(), back, theory_of(back)) is None
    short = record(times=TIMES[:2])
    assert converged_at(short, SETTINGS, THEORY) is None
    brief = record(times=TIMES[:200])
    assert converged_at(brief, SETTINGS, THEORY) is None


def test_figures_are_those_of_the_last_third() -> None:
    """Before it everything is otherwise; each robot has its own radius."""
    arrays = record(
        stepped(40.0, 2.0, 0.93),
        stepped(40.0, 0.2, 1.5),
        (stepped(40.0, 2.0, 0.5), stepped(40.0, 3.0, 0.7)),
    )
    found = summarise(result(arrays))
    assert found["distance_m"] == pytest.approx(0.93)
    assert found["relative_orientation_deg"] == pytest.approx(degrees(1.5))
    assert found["pursuer"] == {"radius_m": pytest.approx(0.5)}
    assert found["evader"] == {"radius_m": pytest.approx(0.7)}


def test_figures_of_the_last_third_are_means() -> None:
    def swayed(times: Array) -> Array:
        return 0.9 + np.where(times < 50.0, 0.1, -0.1)

    found = summarise(result(record(swayed, swayed)))
    assert found["distance_m"] == pytest.approx(0.9, abs=2e-4)
    angle = found["relative_orientation_deg"]
    assert angle == pytest.approx(degrees(0.9), abs=0.01)


def test_a_straight_way_has_no_radius() -> None:
    arrays = record()
    arrays["evader_com"][:] = 0.25  # stands
    assert summarise(result(arrays))["pursuer"]["radius_m"] is not None
    assert (summarise(result(arrays))["evader"]["radius_m"] or 0.0) < 1e-6


def test_a_summary_says_what_the_duel_was() -> None:
    found = summarise(result(record(), duration=30.0 + 1e-12))
    assert found["outcome"] == "completed" and found["message"] == "played"
    assert found["seed"] == 1 and found["duration_s"] == 30.0
    assert found["start"] == {
        "distance_m": 1.0,
        "pursuer_offset_rad": 0.1,
        "evader_offset_rad": -0.2,
    }
    assert found["triggered_at_s"] == 2.5
    assert found["triggered_at_distance_m"] == 0.79
    assert found["min_distance_m"] == 0.61
    assert found["converged_at_s"] == 0.0
    assert found["replans"] == 17
    assert found["max_com_velocity_jump_m_s"] == 1e-12
    assert found["min_zmp_margin_m"] == 0.021
    assert found["real_time_factor"] == pytest.approx(10.0)
    assert found["theory"] == {
        "closest_approach_m": None,
        "exists": True,
        "radius_m": pytest.approx(THEORY.radius_evader_m),
        "distance_m": pytest.approx(THEORY.distance_m),
        "relative_orientation_deg": pytest.approx(90.0),
    }


def test_planning_times_are_told_in_microseconds() -> None:
    times = np.arange(1, 102)[::-1] * 1e-6
    found = summarise(result(record(), planning_times=times))
    assert found["plan_time_us"] == {
        "median": pytest.approx(51.0),
        "p99": pytest.approx(100.0),
    }
    none = summarise(result(record(), planning_times=np.zeros(0)))
    assert none["plan_time_us"] == {"median": None, "p99": None}
    assert summarise(result(record(), wall_time=0.0))["real_time_factor"] > 1e9


def test_a_figure_that_does_not_exist_is_none() -> None:
    back = replace(SETTINGS, strategy=StrategySettings(angle=0.0))
    theory = summarise(result(record(), settings=back))["theory"]
    assert theory["exists"] is False
    assert theory["radius_m"] is None and theory["distance_m"] is None
    assert theory["relative_orientation_deg"] is None


def test_what_was_seen_is_told_for_each_robot_and_both() -> None:
    sight = {"evader": {"seen": 0.9}, "processing_ms": 3.0}
    found = summarise(result(record(), sight=sight))
    assert found["evader"]["seen"] == 0.9
    assert found["evader"]["radius_m"] == pytest.approx(0.7)
    assert found["pursuer"] == {"radius_m": pytest.approx(0.5)}
    assert found["processing_ms"] == 3.0


def test_a_person_is_compared_with_the_template_at_its_pace(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: dict[str, Any] = {}

    def approach(
        move: Callable[..., Any], person: Pose, evader: Pose, **rest: Any
    ) -> float:
        asked.update(rest, person=person, evader=evader)
        return 0.44

    monkeypatch.setattr(summary, "template_approach", approach)
    settings = replace(
        SETTINGS, pursuer="person", strategy=StrategySettings(angle=1.2)
    )
    found = summarise(result(record(), settings=settings))
    assert found["theory"]["closest_approach_m"] == 0.44
    gait = settings.gait
    pace = gait.path_interval / gait.step_duration
    assert asked == {
        "person": Pose(0.0, 0.0, 0.1),
        "evader": Pose(1.0, 0.0, pi - 0.2),
        "speed": pytest.approx(gait.speed * pace),
        "gain": pytest.approx(gait.gain * pace),
        "angle": 1.2,
        "safety_radius": 0.8,
        "duration": 120.0,
    }
    nowhere = replace(settings, start=StartSettings())
    found = summarise(result(record(), settings=nowhere))
    assert found["theory"]["closest_approach_m"] is None
