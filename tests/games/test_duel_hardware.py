"""Test duels of robots with hardware-like bodies and feedback."""

from functools import cache
from math import pi
from typing import Any

import numpy as np
import pytest

from fake_robot import walk_of
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.outcome import Outcome
from stepaside.games.recorded_game import RecordedGame, run_duel
from stepaside.games.run import DuelRun
from stepaside.games.walker import SimulatedPlayer
from stepaside.locomotion.zmp.control_settings import STABILISED
from stepaside.locomotion.zmp.feedback_loop import ClosedLoop
from stepaside.sim.body_settings import BODIES
from stepaside.sim.servos import RealisticServos


def hardware(**changes: Any) -> DuelSettings:
    return DuelSettings(
        **{
            "seed": 3,
            "duration": 12.0,
            "start": StartSettings(0.95, 0.3, -0.2),
            "body": BODIES["hardware"],
            "control": STABILISED,
            **changes,
        }
    )


def test_a_robot_that_never_walked_has_no_zmp_margin() -> None:
    summary = run_duel(hardware(duration=0.1)).summary
    assert summary.min_zmp_margin_m is None and summary.replans == 0
    assert summary.max_com_velocity_jump_m_s == 0.0
    assert summary.plan_time_us.median is summary.plan_time_us.p99 is None


def test_both_robots_of_a_hardware_duel_have_servo_and_sensor_models() -> None:
    duel = RecordedGame(hardware())
    assert duel.in_physics.physics.tick == 0.012
    masses = []
    for walker in duel.in_physics.players:
        assert isinstance(walker, SimulatedPlayer)
        robot, balance = walker.robot, walk_of(walker.scheme).balance
        assert isinstance(robot.servos, RealisticServos)
        assert isinstance(balance, ClosedLoop)
        assert balance.stabiliser.settings == STABILISED
        torso = duel.in_physics.model.body(f"{robot.name}/torso").id
        masses.append(duel.in_physics.model.body_mass[torso])
        readings = [robot.read() for _ in range(3)]
        # Noise differs from reading to reading, encoders are coarse.
        assert np.abs(readings[0].gyro - readings[2].gyro).max() > 0.0
        steps = readings[0].joint_positions / (2.0 * pi / 4096)
        np.testing.assert_allclose(steps, np.round(steps), atol=1e-6)
    assert masses[0] != masses[1]


@cache
def hardware_duel() -> DuelRun:
    return run_duel(hardware())


def test_hardware_robots_play_the_game_with_feedback() -> None:
    """The evader steps aside and turns away; neither robot falls."""
    result = hardware_duel()
    assert result.outcome is Outcome.COMPLETED
    assert result.duration == pytest.approx(12.0)
    arrays, summary = result.arrays(), result.summary
    times = arrays["times_s"]
    np.testing.assert_allclose(np.diff(times)[:-1], 0.024)
    for name, values in arrays.items():
        # Only the ZMP is not there at times, before the first step.
        assert np.isfinite(values).mean() > 0.99, name
    apart = arrays["evader_torso"] - arrays["pursuer_torso"]
    distance = np.hypot(apart[:, 0], apart[:, 1])
    at, began = summary.triggered_at_s, summary.triggered_at_distance_m
    assert at is not None and began is not None
    assert 0.78 < began < 0.8
    places = arrays["evader_place"] - arrays["pursuer_place"]
    away = np.hypot(places[:, 0], places[:, 1])
    assert away[times < at - 0.02].min() > 0.8 - 1e-3
    assert summary.min_distance_m == pytest.approx(distance.min(), abs=2e-3)
    assert 0.5 < summary.min_distance_m < 0.8
    stood = arrays["evader_com"][times < at - 0.02, :2]
    assert np.abs(stood - stood[0]).max() < 0.01
    heights = np.concatenate(
        [arrays["pursuer_com"][:, 2], arrays["evader_com"][:, 2]]
    )
    assert heights.min() > 0.26 and heights.max() < 0.275
    fled = arrays["evader_torso"][-1] - arrays["evader_torso"][0]
    assert np.hypot(*fled[:2]) > 0.2 and abs(fled[2]) > 0.4
    assert summary.max_com_velocity_jump_m_s < 1e-9
    assert summary.min_zmp_margin_m is not None
    assert summary.min_zmp_margin_m > 0.02


@pytest.mark.parametrize("name", ["pursuer", "evader"])
def test_hardware_robots_walk_where_their_footsteps_are(name: str) -> None:
    """Torso relative to the center of the last two footsteps."""
    result = hardware_duel()
    arrays = result.arrays()
    landings = arrays[f"{name}_landings"]
    done = landings[landings[:, 0] < 12.0]
    assert len(done) > 8
    # Feet land in turn, one gait apart.
    np.testing.assert_array_equal(done[1:, 1], -done[:-1, 1])
    step = result.settings.gait.step_duration
    np.testing.assert_allclose(np.diff(done[1:, 0]), step, atol=0.013)
    middle = 0.5 * (done[1:, 2:4] + done[:-1, 2:4])
    walked = np.array(
        [
            np.interp(done[1:, 0], arrays["times_s"], column)
            for column in arrays[f"{name}_torso"][:, :2].T
        ]
    ).T
    assert np.hypot(*(middle[-1] - middle[0])) > 0.15
    assert np.hypot(*(walked - middle).T).max() < 0.05


def test_hardware_bodies_and_their_errors_come_from_the_seed() -> None:
    first = run_duel(hardware(duration=1.5)).arrays()
    again = run_duel(hardware(duration=1.5)).arrays()
    other = run_duel(hardware(duration=1.5, seed=4)).arrays()
    for name, values in first.items():
        np.testing.assert_array_equal(values, again[name])
    off = first["pursuer_qpos"][-1] - other["pursuer_qpos"][-1]
    assert np.abs(off).max() > 1e-4
