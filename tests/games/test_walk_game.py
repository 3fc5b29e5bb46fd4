"""Test walks: estimation, feedback and pushes on different bodies."""

from dataclasses import replace
from math import pi
from typing import Any

import numpy as np
import pytest

from stepaside.games.game import Outcome
from stepaside.games.game_settings import walk
from stepaside.games.recorded_game import run_game
from stepaside.games.run import Run
from stepaside.games.walk_evaluation import express_in_support_foot
from stepaside.locomotion.control_settings import OPEN_LOOP, STABILISED
from stepaside.planning import GaitSettings
from stepaside.sim.body_settings import BODIES
from stepaside.sim.physics_settings import PhysicsSettings
from stepaside.sim.push import Push

GAIT = GaitSettings()
CYCLE = 2.0 * GAIT.step_duration
SPEED = GAIT.stride / GAIT.step_duration  # of a straight walk, in [m/s]
READY = 1.0  # of standing still, before feedback walks, in [s]
# Left at one phase is right half a cycle later: these are all there are.
SIDEWAYS = [(0.0, 1.0), (0.25, -1.0), (0.5, 1.0), (0.75, -1.0)]


def check_rms(errors: dict[str, Any], **limits: float) -> None:
    """Check the errors of both axes against a limit, by name and unit."""
    for name, limit in limits.items():
        both = {k: e for k, e in errors.items() if k.startswith(name)}
        assert len(both) == 2
        assert max(both.values()) < limit, both


def pushed(
    impulse: float, direction: float, phase: float, *, feedback: bool
) -> Run:
    """Return a straight walk with a push in its fourth cycle."""
    begins = GAIT.start_support + (READY if feedback else 0.0)
    time = begins + (3.0 + phase) * CYCLE
    settings = walk(
        duration=time + 4.0,
        control=STABILISED if feedback else OPEN_LOOP,
        pushes=(Push(impulse, time, direction),),
    )
    return run_game(settings)


def check_recovery(result: Run, heading: float) -> None:
    """Check that a walk goes on as if nothing had happened.

    Args:
        result: Of a walk that was pushed four seconds before its end.
        heading: Greatest turn that the push may have left, in [rad].
    """
    assert result.outcome is Outcome.COMPLETED
    seen, track = express_in_support_foot(result.walker), result.walker
    late = result.times > result.times[-1] - CYCLE
    off = seen["com"] - seen["com_reference"]
    assert np.abs(off[late]).max() < 0.002
    assert np.abs(track.torso[late, 2]).max() < heading
    since = track.com[result.times > result.times[-1] - 4.0]
    walked = np.hypot(*(since[-1] - since[0])[:2])
    assert walked == pytest.approx(4.0 * SPEED, rel=0.08)


@pytest.mark.slow
def test_an_ideal_body_walks_and_estimates_as_planned() -> None:
    """Limits are about 1.5 times the measured errors, a mm or so."""
    result = run_game(walk(duration=12.0, bearing=0.5, control=STABILISED))
    found = result.results()
    summary, planning = found["walking"], found["planning"]
    assert found["outcome"] == "completed" and summary["adapted_steps"] == 0
    walked = 12.0 - READY - GAIT.start_support
    assert planning["steps"] == 1 + walked // GAIT.step_duration
    assert summary["speed_ratio"] == pytest.approx(1.0, abs=0.025)
    assert summary["yaw_ratio"] == pytest.approx(1.0, abs=0.015)
    assert summary["slip_per_step_m"] < 0.0004
    assert planning["min_zmp_margin_m"] > 0.034
    assert planning["p99_us"] > planning["median_us"] > 0.0
    assert summary["tilt_max_deg"] < 0.6
    check_rms(summary["tracking"], com=0.0008, zmp=0.016)
    errors = summary["estimation"]
    check_rms(errors, com=0.0017, velocity=0.015, zmp=0.014)
    for name in ("roll_rad", "pitch_rad"):
        assert errors[name] < 0.005


@pytest.mark.slow
@pytest.mark.parametrize("backward", [False, True])
def test_a_hardware_like_body_walks_and_turns_as_planned(
    backward: bool,
) -> None:
    """With delay, backlash, noise and bias; limits as for the ideal one."""
    result = run_game(
        walk(
            duration=20.0,
            bearing=-0.6,
            backward=backward,
            body=BODIES["hardware"],
            control=STABILISED,
        )
    )
    found = result.results()
    summary, planning = found["walking"], found["planning"]
    assert found["outcome"] == "completed" and summary["adapted_steps"] == 0
    assert summary["speed_ratio"] == pytest.approx(1.0, abs=0.03)
    assert summary["yaw_ratio"] == pytest.approx(1.0, abs=0.035)
    assert summary["yaw_rate_deg_s"] == pytest.approx(-5.0, abs=0.2)
    assert summary["slip_per_step_m"] < 0.001
    assert planning["min_zmp_margin_m"] > 0.03
    assert summary["tilt_max_deg"] < 1.5
    check_rms(summary["tracking"], com=0.008, zmp=0.03)
    errors = summary["estimation"]
    check_rms(errors, com=0.0045, velocity=0.025)
    for name in ("roll_rad", "pitch_rad"):
        assert errors[name] < 0.014


@pytest.mark.parametrize(("phase", "side"), SIDEWAYS)
def test_feedback_survives_sideways_pushes(phase: float, side: float) -> None:
    result = pushed(1.2, side * pi / 2, phase, feedback=True)
    check_recovery(result, heading=0.03)
    given = (0.0, side * 1.2)
    assert result.summary.walking is not None
    assert result.summary.walking.push_impulse_n_s == pytest.approx(
        given, abs=0.02
    )


@pytest.mark.slow
def test_a_walk_is_repeated_to_the_bit_only_with_its_seed() -> None:
    settings = walk(
        seed=5,
        duration=4.0,
        body=BODIES["hardware"],
        control=STABILISED,
        physics=PhysicsSettings(unevenness=0.003),
    )
    first, second = run_game(settings), run_game(settings)
    other = run_game(replace(settings, seed=6))
    again = second.arrays()
    for name, values in first.arrays().items():
        np.testing.assert_array_equal(values, again[name])
    assert (other.walker.com != first.walker.com).any()
