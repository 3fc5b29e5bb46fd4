"""Test the ankle feedback."""

from typing import Any

import pytest

from stepaside.locomotion.control_settings import StabiliserSettings
from stepaside.locomotion.zmp.stabiliser import Ankles
from stepaside.locomotion.zmp.state_estimator import BodyState

GAINS = StabiliserSettings(ankle=0.5, ankle_rate=0.04)
TICK = 0.004
Vector = tuple[float, float]
ZERO = (0.0, 0.0)


def state(**changes: Any) -> BodyState:
    values: dict[str, Any] = {
        "tilt": (0.02, -0.03),
        "rate": (0.1, 0.3, 9.0),
        "left_share": 0.5,
    } | changes
    return BodyState(ZERO, ZERO, ZERO, ZERO, weight=50.0, **values)


def settled(state: BodyState) -> list[Vector]:
    ankles = Ankles(GAINS, TICK)
    tilts: tuple[Vector, Vector] = (ZERO, ZERO)
    for _ in range(500):
        tilts = ankles.tilts(state)
    return list(tilts)


def test_feet_tilt_with_the_torso_by_tilt_and_rate() -> None:
    """A torso that leans right presses the right edge: the sole gives."""
    roll = 0.5 * 0.02 + 0.04 * 0.1
    pitch = 0.5 * -0.03 + 0.04 * 0.3
    for tilt in settled(state()):
        assert tilt == pytest.approx((roll, pitch))


@pytest.mark.parametrize(
    ("share", "left", "right"),
    [
        (1.0, 1.0, 0.0),
        (0.75, 1.0, 0.5),
        (0.5, 1.0, 1.0),
        (0.25, 0.5, 1.0),
        (0.0, 0.0, 1.0),
    ],
)
def test_a_foot_tilts_as_far_as_it_bears_weight(
    share: float, left: float, right: float
) -> None:
    whole = settled(state())[0]
    tilts = settled(state(left_share=share))
    for tilt, part in zip(tilts, (left, right), strict=True):
        expected = (part * whole[0], part * whole[1])
        assert tilt == pytest.approx(expected, abs=1e-12)


def test_an_upright_torso_asks_for_level_feet() -> None:
    upright = state(tilt=ZERO, rate=(0.0, 0.0, 3.0))
    assert settled(upright) == [ZERO, ZERO]
