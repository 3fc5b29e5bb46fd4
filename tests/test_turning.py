"""Test what a gyro tells of turns that are believed."""

from math import pi

import numpy as np
import pytest

from stepaside.control.turning import LEAST, MOST, TurnShare

TICK = 0.012
BIAS = 0.01  # [rad/s]
RATE = 0.16  # that is believed, in [rad/s]


def walked(
    turns: TurnShare,
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


def stood() -> TurnShare:
    turns = TurnShare(TICK)
    generator = np.random.default_rng(2)
    for _ in range(100):
        read = BIAS + generator.normal(0.0, 0.002)
        turns.note(read, 0.0, stands=True)
        assert turns.share == 1.0
    return turns


@pytest.mark.parametrize("rate", [RATE, -RATE])
@pytest.mark.parametrize("made", [0.9, 1.0, 1.1])
def test_the_share_is_that_of_the_turn_made(made: float, rate: float) -> None:
    """Around the whole circle, and with a bias as great as the slip."""
    shares = walked(stood(), made, rate=rate)
    assert shares[-1] == pytest.approx(made, abs=0.01)
    assert shares[0] == 1.0


def test_what_was_long_ago_is_forgotten() -> None:
    turns = stood()
    walked(turns, 0.9)
    assert walked(turns, 1.05)[-1] == pytest.approx(1.05, abs=0.01)


def test_nothing_is_believed_without_a_bias_a_turn_or_a_reason() -> None:
    assert set(walked(TurnShare(TICK), 0.9)) == {1.0}
    assert set(walked(stood(), 0.9, rate=0.01)) == {1.0}
    assert walked(stood(), 0.2)[-1] == LEAST
    assert walked(stood(), 3.0)[-1] == MOST
