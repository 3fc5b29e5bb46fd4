"""Test phases of a maneuver and their constant maps."""

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.planning import GaitSettings
from stepaside.planning.com import evaluate
from stepaside.planning.schedule import Schedule
from stepaside.planning.swing import swing_height, swing_progress

GAIT = GaitSettings()
SINGLE, DOUBLE = GAIT.single_support, GAIT.double_support
START, STEP = GAIT.start_support, GAIT.step_duration


def zmp(schedule: Schedule, inputs: Array, times: Array) -> Array:
    """ZMP at times, from the map of the schedule, shape (m,)."""
    index, local = schedule.zmp_map.locate(times)
    local = np.minimum(local, schedule.durations[index])
    unit = evaluate(schedule.zmp_map.coefficients[:, index], local)
    values: Array = unit @ inputs
    return values


def anchors(count: int) -> Array:
    """Inputs with the anchors at 1, 2, 3, ... and nothing else."""
    inputs = np.zeros(count + 4)
    inputs[: count + 1] = np.arange(1.0, count + 2.0)
    return inputs


def test_zmp_rests_in_single_support_and_moves_in_double_support() -> None:
    schedule = Schedule(GAIT, 4, standing=False)
    inputs = anchors(4)
    for i in range(4):
        begin = i * STEP
        rest = begin + SINGLE * np.array([0.01, 0.5, 0.99])
        np.testing.assert_allclose(
            zmp(schedule, inputs, rest), i + 1.0, atol=1e-12
        )
        halfway = begin + SINGLE + 0.5 * DOUBLE
        ahead = i + 1.5 if i < 3 else i + 1.25
        assert zmp(schedule, inputs, np.array([halfway])) == pytest.approx(
            ahead
        )


def test_the_zmp_moves_evenly_between_the_feet() -> None:
    schedule = Schedule(GAIT, 2, standing=False)
    s = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
    times = SINGLE + DOUBLE * s - 1e-12
    moved = zmp(schedule, anchors(2), times) - 1.0
    np.testing.assert_allclose(moved, s, atol=1e-9)


@pytest.mark.parametrize("standing", [False, True])
def test_zmp_never_jumps(standing: bool) -> None:
    schedule = Schedule(GAIT, 4, standing=standing)
    inputs = np.random.default_rng(1).normal(size=8)
    knots = schedule.starts[1:-1]
    before = zmp(schedule, inputs, knots - 1e-10)
    after = zmp(schedule, inputs, knots + 1e-10)
    np.testing.assert_allclose(before, after, atol=1e-7)


@pytest.mark.parametrize("standing", [False, True])
def test_correction_is_a_bump_as_high_as_its_amplitude(
    standing: bool,
) -> None:
    """27/4 s (1 - s)^2: highest, and equal to 1, at a third of the piece."""
    schedule = Schedule(GAIT, 2, standing=standing)
    inputs = np.zeros(6)
    inputs[4] = 1.0
    lasts = START if standing else SINGLE
    s = np.linspace(0.0, 1.0, 301)
    bump = zmp(schedule, inputs, s * lasts - 1e-13)
    np.testing.assert_allclose(bump, 6.75 * s * (1.0 - s) ** 2, atol=1e-9)
    assert bump.max() == pytest.approx(1.0)
    assert s[bump.argmax()] == pytest.approx(1.0 / 3.0, abs=1e-3)
    later = zmp(schedule, inputs, np.linspace(lasts + 1e-9, 3.0, 20))
    np.testing.assert_array_equal(later, 0.0)


@pytest.mark.parametrize("standing", [False, True])
def test_dcm_at_the_start_is_a_weighted_mean_of_the_zmp(
    standing: bool,
) -> None:
    """Eq. (16): shift everything, and the DCM shifts by as much."""
    row = Schedule(GAIT, 4, standing=standing).dcm_start_map
    assert row[:6].sum() == pytest.approx(1.0)
    assert row[7] == 0.0  # the CoM does not matter
    eta, lasts = GAIT.eta, START if standing else SINGLE
    t = np.linspace(0.0, lasts, 20001)
    s = t / lasts
    bump = eta * np.exp(-eta * t) * 6.75 * s * (1.0 - s) ** 2
    integral = float((0.5 * (bump[1:] + bump[:-1])).sum() * t[1])
    assert row[6] == pytest.approx(integral, rel=1e-6)


@pytest.mark.parametrize("standing", [False, True])
def test_swing_phase_counts_from_each_lift_off(standing: bool) -> None:
    schedule = Schedule(GAIT, 3, standing=standing)
    begin = START if standing else 0.0
    s = np.array([0.0, 0.5, 1.0])
    for i in range(3):
        times = begin + i * STEP + s * SINGLE + 1e-12
        step, phase = schedule.swing_phases(times)
        np.testing.assert_array_equal(step, i)
        np.testing.assert_allclose(phase, s, atol=1e-9)


@pytest.mark.parametrize("standing", [False, True])
def test_feet_take_turns_from_row_to_row(standing: bool) -> None:
    """Step i takes a foot from row i of the placements to row i + 2."""
    schedule = Schedule(GAIT, 4, standing=standing)
    begin = START if standing else 0.0
    rows = np.arange(6.0)
    for i in range(4):
        phases = np.array([0.1, 0.4, 0.9, 1.1])
        sampler = schedule.sampler(begin + i * STEP + phases * SINGLE)
        support, first = (sampler.feet @ rows).reshape(2, -1)
        moving, resting = (first, support) if i % 2 == 0 else (support, first)
        np.testing.assert_allclose(moving, i + 2 * swing_progress(phases))
        np.testing.assert_allclose(resting, i + 1.0)
        lift = swing_height(phases, GAIT.step_height)
        heights = sampler.swing_height, sampler.support_height
        high, low = heights if i % 2 == 0 else heights[::-1]
        np.testing.assert_allclose(high, lift, atol=1e-12)
        np.testing.assert_array_equal(low, 0.0)
