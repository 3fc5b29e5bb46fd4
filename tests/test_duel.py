"""Test the game in physics: the circle, its mirror image, its ends."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from stepaside.planning import PRESETS
from stepaside.simulation import DuelResult, DuelSettings, Outcome, run_duel
from stepaside.simulation.settings import StartSettings, StrategySettings
from stepaside.simulation.summary import summarise, theory_of


@cache
def play(seed: int, duration: float = 90.0) -> DuelResult:
    return run_duel(DuelSettings(seed=seed, duration=duration))


@pytest.mark.parametrize("seed", [11, 42])
def test_robots_walk_the_circle_together(seed: int) -> None:
    """Theory: radius 4v/(pi k) = 0.637 m, distance 0.900 m, 90 degrees."""
    summary = summarise(play(seed))
    assert summary["outcome"] == "completed"
    for name in ("pursuer", "evader"):
        assert summary[name]["radius_m"] == pytest.approx(0.637, rel=0.04)
    assert summary["distance_m"] == pytest.approx(0.900, rel=0.04)
    assert summary["relative_orientation_deg"] == pytest.approx(90, abs=3)
    assert summary["converged_at_s"] < 60.0
    assert summary["max_com_velocity_jump_m_s"] < 1e-9
    assert summary["min_zmp_margin_m"] > 0.02


def test_same_seed_gives_the_same_duel_to_the_bit() -> None:
    one = run_duel(DuelSettings(seed=5, duration=8.0))
    other = run_duel(DuelSettings(seed=5, duration=8.0))
    assert one.arrays.keys() == other.arrays.keys()
    for name, values in one.arrays.items():
        np.testing.assert_array_equal(values, other.arrays[name])


def test_other_seeds_give_other_starts() -> None:
    starts = {play(seed, 0.1).settings.start for seed in range(5)}
    assert len(starts) == 5


def test_evader_stands_until_its_safety_area_is_entered() -> None:
    start = StartSettings(1.2, 0.0, 0.0)
    result = run_duel(DuelSettings(duration=12.0, start=start))
    assert result.triggered_at is not None
    times = result.arrays["times_s"]
    apart = result.arrays["evader_torso"] - result.arrays["pursuer_torso"]
    distance = np.hypot(apart[:, 0], apart[:, 1])
    at = int(np.searchsorted(times, result.triggered_at))
    assert distance[at] == pytest.approx(0.8, abs=0.01)
    evader = result.arrays["evader_com"]
    assert np.abs(evader[: at - 1, :2] - evader[0, :2]).max() < 0.005


def test_released_evader_comes_to_rest() -> None:
    """The pursuer heads elsewhere at first, and the distance grows."""
    settings = DuelSettings(
        duration=14.0,
        start=StartSettings(0.7, 3.1, 0.0),
        strategy=StrategySettings(angle=0.0, release_distance=1.0),
    )
    result = run_duel(settings)
    assert result.outcome is Outcome.COMPLETED
    times = result.arrays["times_s"]
    landings = result.arrays["evader_landings"]
    assert len(landings) > 2
    assert landings[-1, 0] < times[-1] - 3.0
    rest = result.arrays["evader_com"][times > times[-1] - 1.0, :2]
    assert np.ptp(rest, axis=0).max() < 0.005


def test_falls_are_detected_and_end_the_duel() -> None:
    """The durations as printed ask for more speed than the joints have."""
    settings = DuelSettings(duration=60.0, gait=PRESETS["as-printed"])
    result = run_duel(settings)
    assert result.outcome is Outcome.FALL
    assert "fell" in result.message
    assert result.duration < 60.0


def test_planned_footsteps_are_walked_in_physics() -> None:
    """Stride and turn of the feet on the floor against the plan."""
    arrays = play(11).arrays
    times = arrays["times_s"]
    for name in ("pursuer", "evader"):
        walked = arrays[f"{name}_torso"][times > 60.0]
        planned = arrays[f"{name}_landings"]
        planned = planned[planned[:, 0] > 60.0]
        rate = np.polyfit(times[times > 60.0], walked[:, 2], 1)[0]
        heading = np.unwrap(planned[:, 4])
        asked = np.polyfit(planned[:, 0], heading, 1)[0]
        assert rate == pytest.approx(asked, rel=0.05)


def test_theory_follows_the_settings() -> None:
    settings = DuelSettings()
    assert theory_of(settings).distance_m == pytest.approx(0.9003, abs=1e-4)
    saturated = replace(settings.strategy, saturated=True)
    circle = theory_of(replace(settings, strategy=saturated))
    assert circle.radius_evader_m == pytest.approx(0.5)
