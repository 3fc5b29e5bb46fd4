"""Test the calibration of turns by the gyro."""

from math import nan, pi

import numpy as np
import pytest

from fake_robot import TICK as FAKE_TICK
from fake_robot import FakeStrategy, Run, measure
from stepaside.control.turn_calibration import (
    BIAS_TIME,
    TurnCalibration,
)
from stepaside.perception.measurement import RobotState

TICK = 0.012
BIAS = 0.01  # [rad/s]
RATE = 0.16  # that is believed, in [rad/s]


def walked(
    turns: TurnCalibration,
    made: float,
    *,
    duration: float = 40.0,
    rate: float = RATE,
) -> list[float]:
    """Shares while so much of a turn is made, with bias and noise."""
    generator = np.random.default_rng(3)
    shares = []
    for number in range(round(duration / TICK)):
        read = made * rate + BIAS + generator.normal(0.0, 0.02)
        heading = (rate * number * TICK + pi) % (2.0 * pi) - pi
        turns.note(read, heading, stands=False)
        shares.append(turns.share)
    return shares


def stood() -> TurnCalibration:
    turns = TurnCalibration(TICK)
    generator = np.random.default_rng(2)
    for _ in range(100):
        read = BIAS + generator.normal(0.0, 0.002)
        turns.note(read, 0.0, stands=True)
        assert turns.share == 1.0
    return turns


@pytest.mark.parametrize("rate", [RATE, -RATE])
@pytest.mark.parametrize("made", [0.9, 1.0, 1.1])
def test_the_estimated_ratio_matches_the_actual_turn(
    made: float, rate: float
) -> None:
    """Around the whole circle, and with a bias as great as the slip."""
    shares = walked(stood(), made, rate=rate)
    assert shares[-1] == pytest.approx(made, abs=0.01)
    assert shares[0] == 1.0


def test_compensated_headings_yield_the_desired_turn() -> None:
    turns = stood()
    assert turns.compensate(1.2) == 1.2
    walked(turns, 0.9)
    for heading in (-1.6, -0.3, 0.0, 0.8, 1.6):
        assert turns.share * turns.compensate(heading) == pytest.approx(
            heading
        )
    assert turns.compensate(-3.1) == -pi and turns.compensate(3.1) == pi
    assert (
        turns.compensate(4.0) == 4.0
    )  # as by (8), where a turn is not wrapped


def turn_of_a_step(made: float, *, learns: bool) -> float:
    """Return the turn requested for the last step of a walk on a circle."""
    run = Run(FakeStrategy(heading=0.4))
    decisions = run.scheme.decisions
    decisions.turns = TurnCalibration(FAKE_TICK) if learns else None
    believed = 0.0
    for tick in range(round(40.0 / FAKE_TICK)):
        now = tick * FAKE_TICK
        heading = decisions.templates.at(now).theta
        rate, believed = made * (heading - believed) / FAKE_TICK, heading
        run.scheme.update(turned(now, rate))
        if run.scheme.begun is not None:
            run.steps.append(run.scheme.begun)
    return run.landings[-1][2].theta - run.landings[-3][2].theta


def turned(now: float, rate: float) -> RobotState:
    return measure(now)._replace(gyro=np.array([0.0, 0.0, rate + BIAS]))


def test_without_a_vertical_gyro_headings_are_unchanged() -> None:
    turns = TurnCalibration(FAKE_TICK)
    for i in range(round(2.0 * BIAS_TIME / FAKE_TICK)):
        assert turns.ready == (i * FAKE_TICK >= BIAS_TIME)
        turns.note(nan, 0.0, stands=True)
    for i in range(1000):
        turns.note(nan, 0.01 * i, stands=False)
    assert turns.share == 1.0 and turns.compensate(0.5) == 0.5


def test_a_calibrating_robot_stands_until_the_bias_is_known() -> None:
    run = Run()
    run.scheme.decisions.turns = turns = TurnCalibration(FAKE_TICK)
    run.until(BIAS_TIME - 2 * FAKE_TICK)
    assert run.replans == 0 and not turns.ready
    run.until(BIAS_TIME + 2 * FAKE_TICK)
    assert run.replans == 1 and turns.ready


def test_twisting_feet_are_compensated() -> None:
    wanted = turn_of_a_step(0.9, learns=False)
    assert wanted == turn_of_a_step(1.0, learns=False) > 0.05
    asked = turn_of_a_step(0.9, learns=True)
    assert 0.9 * asked == pytest.approx(wanted, rel=0.01)
    assert turn_of_a_step(1.0, learns=True) == pytest.approx(wanted, rel=1e-3)
