"""Test summaries of walks on records with known values."""

from dataclasses import asdict
from math import degrees, pi, sin
from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.games.game_settings import walk
from stepaside.games.trajectory import WIDTHS, Trajectory
from stepaside.games.walk_evaluation import express_in_support_foot, measured

SETTINGS = walk(seed=4)
CYCLE = 2.0 * SETTINGS.gait.step_duration
STEP = 0.02
RECORDED = [
    *("com", "torso", "com_reference", "zmp_reference", "zmp", "velocity"),
    *("tilt", "sole", "support", "heading_reference", "estimate"),
]
PER_CYCLE = round(CYCLE / STEP)
PERIOD = PER_CYCLE * STEP  # a cycle, as far as samples tell
# Whole cycles after the first three seconds, which are left out.
TIMES: Array = np.arange(round(1.0 / STEP) + 10 * PER_CYCLE + 1, dtype=float)
TIMES = 2.0 + STEP * TIMES


def record(times: Array = TIMES) -> dict[str, Array]:
    """Return a robot that stands as planned, on one foot."""
    rows = {name: np.zeros((len(times), WIDTHS[name])) for name in RECORDED}
    arrays = express_in_support_foot(times, Trajectory(**rows))
    return {name: values.copy() for name, values in arrays.items()}


def figures(arrays: dict[str, Array]) -> dict[str, Any]:
    return asdict(measured(arrays, CYCLE))


PAIRS = [
    ("tracking", "com_x_m", "com_x", "com_reference_x"),
    ("tracking", "com_y_m", "com_y", "com_reference_y"),
    ("tracking", "zmp_x_m", "zmp_x", "zmp_reference_x"),
    ("tracking", "zmp_y_m", "zmp_y", "zmp_reference_y"),
    ("estimation", "com_x_m", "estimated_com_x", "com_x"),
    ("estimation", "com_y_m", "estimated_com_y", "com_y"),
    ("estimation", "velocity_x_m_s", "estimated_velocity_x", "velocity_x"),
    ("estimation", "velocity_y_m_s", "estimated_velocity_y", "velocity_y"),
    ("estimation", "zmp_x_m", "estimated_zmp_x", "zmp_x"),
    ("estimation", "zmp_y_m", "estimated_zmp_y", "zmp_y"),
    ("estimation", "roll_rad", "estimated_roll", "roll"),
    ("estimation", "pitch_rad", "estimated_pitch", "pitch"),
]


@pytest.mark.parametrize(("group", "name", "value", "wanted"), PAIRS)
def test_errors_are_evaluated_after_the_warm_up(
    group: str, name: str, value: str, wanted: str
) -> None:
    """Alternately -0.04 and 0.01; large before three seconds."""
    arrays = record()
    steady = TIMES >= 3.0
    off = np.where(np.arange(len(TIMES)) % 2 == 0, -0.04, 0.01)
    off[~steady] = 9.0
    arrays[value] = 0.5 + off
    arrays[wanted] = np.full(len(TIMES), 0.5)
    found = figures(arrays)[group][name]
    kept = off[steady]
    assert found["rms"] == pytest.approx(np.sqrt((kept**2).mean()))
    assert found["mean"] == pytest.approx(kept.mean()) and found["mean"] < 0
    assert found["max"] == pytest.approx(0.04)
    touched = {value, wanted}
    for other_group, other, one, two in PAIRS:
        if not touched & {one, two}:
            assert figures(arrays)[other_group][other]["max"] == 0.0


def walked(ratio: float = 1.0, turned: float = 1.0) -> dict[str, Array]:
    """Return a circle of 1 m at 0.05 m/s, with sway in each cycle."""
    arrays = record()
    angle = 0.05 * TIMES
    sway = 0.02 * np.sin(2.0 * pi * (TIMES - 3.0) / PERIOD)
    size = ratio + sway
    arrays["com_in_world_x"], arrays["com_in_world_y"] = (
        size * np.cos(angle),
        size * np.sin(angle),
    )
    arrays["com_reference_in_world_x"], arrays["com_reference_in_world_y"] = (
        np.sin(angle),
        np.cos(angle),
    )
    arrays["heading_reference"] = np.remainder(6.0 + angle, 2.0 * pi)
    arrays["heading"] = np.remainder(6.1 + turned * angle, 2.0 * pi)
    return arrays


def test_speed_and_turning_are_over_whole_cycles() -> None:
    """Sway within a cycle adds no path length; headings may wrap."""
    found = figures(walked(1.3, 0.9))
    chord = 2.0 * sin(0.05 * PERIOD / 2.0) / PERIOD
    assert found["speed_m_s"] == pytest.approx(1.3 * chord, rel=1e-6)
    assert found["speed_ratio"] == pytest.approx(1.3, rel=1e-6)
    assert found["yaw_ratio"] == pytest.approx(0.9, rel=1e-6)
    rate = degrees(0.9 * 0.05)
    assert found["yaw_rate_deg_s"] == pytest.approx(rate, rel=1e-6)
    right = walked(1.0, 1.0)
    for name in ("heading", "heading_reference"):
        right[name] = -right[name]
    found = figures(right)
    assert found["yaw_ratio"] == pytest.approx(1.0)
    assert found["yaw_rate_deg_s"] == pytest.approx(-degrees(0.05))


def test_without_path_or_turn_there_is_no_ratio() -> None:
    arrays = record()
    arrays["com_in_world_x"] = 0.1 * TIMES
    found = figures(arrays)
    assert found["speed_m_s"] == pytest.approx(0.1)
    assert found["speed_ratio"] is None and found["yaw_ratio"] is None
    lasted = 10.0 * PERIOD
    for way, exists in ((0.011, True), (0.009, False)):
        arrays["com_reference_in_world_x"] = way / lasted * TIMES
        assert (figures(arrays)["speed_ratio"] is not None) is exists
    for turn, exists in ((0.051, True), (0.049, False), (-0.051, True)):
        arrays["heading_reference"] = turn / lasted * TIMES
        assert (figures(arrays)["yaw_ratio"] is not None) is exists


def supports(slips: list[float], length: int, land: float) -> Array:
    """Return a foot that slips in each single support."""
    single, x = [0.0] * 60, [0.0] * 60
    at = 0.0
    for slip in slips:
        at += land
        # It settles as it lands and lifts: neither is slip.
        way = np.linspace(0.0, slip, length - 2)
        x += [at - 0.5, *(at + way), at + slip + 0.5]
        single += [1.0] * length
        at += slip
        x += [at] * 10
        single += [0.0] * 10
    return np.array([single, x])


def test_slip_is_the_displacement_of_the_support_foot() -> None:
    single, x = supports([0.003, 0.001, 0.002], 20, 0.05)
    times: Array = 2.5 + STEP * np.arange(len(x), dtype=float)
    arrays = record(times)
    arrays["single"] = single
    arrays["foot_in_world_x"], arrays["foot_in_world_y"] = 0.6 * x, -0.8 * x
    slip = figures(arrays)["slip_per_step_m"]
    # The first sample and the last are left out.
    assert slip == pytest.approx(0.002, rel=1e-9)


@pytest.mark.parametrize(("length", "exists"), [(7, True), (6, False)])
def test_slip_needs_a_complete_single_support(
    length: int, exists: bool
) -> None:
    single, x = supports([0.01, 0.01], length, 0.05)
    times: Array = 2.5 + STEP * np.arange(len(x), dtype=float)
    arrays = record(times)
    arrays["single"], arrays["foot_in_world_x"] = single, x
    assert (figures(arrays)["slip_per_step_m"] is not None) is exists


def test_tilt_is_the_greatest_in_any_direction() -> None:
    arrays = record()
    arrays["roll"][10], arrays["pitch"][10] = 1.0, 1.0  # warm-up
    arrays["roll"][200], arrays["pitch"][200] = -0.03, 0.04
    arrays["roll"][300] = 0.045
    assert figures(arrays)["tilt_max_deg"] == pytest.approx(degrees(0.05))
