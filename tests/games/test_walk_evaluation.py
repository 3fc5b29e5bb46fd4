"""Test summaries of walks on records with known values."""

from dataclasses import asdict
from math import degrees, pi, sin
from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.games.game_settings import walk
from stepaside.games.trajectory import COLUMNS, Trajectory
from stepaside.games.walk_evaluation import WARM_UP, walking_of

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
    return {
        name: np.zeros((len(times), len(COLUMNS[name]))) for name in RECORDED
    }


def figures(rows: dict[str, Any], times: Array = TIMES) -> dict[str, Any]:
    late = times >= WARM_UP
    track = Trajectory(**{name: each[late] for name, each in rows.items()})
    return asdict(walking_of(times[late], track, CYCLE))


def walked(ratio: float = 1.0, turned: float = 1.0) -> dict[str, Array]:
    """Return a circle of 1 m at 0.05 m/s, with sway in each cycle."""
    rows = record()
    angle = 0.05 * TIMES
    sway = 0.02 * np.sin(2.0 * pi * (TIMES - 3.0) / PERIOD)
    size = ratio + sway
    rows["com"][:, :2] = (size * [np.cos(angle), np.sin(angle)]).T
    rows["com_reference"][:] = np.column_stack([np.sin(angle), np.cos(angle)])
    reference = np.remainder(6.0 + angle, 2.0 * pi)
    rows["heading_reference"][:, 0] = reference
    rows["torso"][:, 2] = np.remainder(6.1 + turned * angle, 2.0 * pi)
    return rows


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
    for name in ("torso", "heading_reference"):
        right[name] = -right[name]
    found = figures(right)
    assert found["yaw_ratio"] == pytest.approx(1.0)
    assert found["yaw_rate_deg_s"] == pytest.approx(-degrees(0.05))


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
    rows = record(times)
    rows["support"][:, 1] = single
    rows["sole"][:, :2] = np.column_stack([0.6 * x, -0.8 * x])
    slip = figures(rows, times)["slip_per_step_m"]
    # The first sample and the last are left out.
    assert slip == pytest.approx(0.002, rel=1e-9)


def test_errors_of_the_estimate_have_the_names_of_their_axes() -> None:
    rows = record()
    rows["estimate"][:, 6:] = 0.02, -0.05  # roll, pitch
    found = figures(rows)["estimation"]
    assert found["roll_rad"] == pytest.approx(0.02)
    assert found["pitch_rad"] == pytest.approx(0.05)
