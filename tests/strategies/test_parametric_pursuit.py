"""Test the family of pursuers with a pull to the centre and a sway."""

import pytest

from stepaside.core.poses import Pose
from stepaside.strategies import (
    HerdingPursuit,
    Knowledge,
    Limits,
    ParametricPursuit,
    Pursuit,
    Strategy,
)

LIMITS = Limits(0.1, 0.2, 0.04, 0.4)


def heading(strategy: Strategy, time: float = 0.0) -> float:
    known = Knowledge(time, 0.4, 1.2, LIMITS, pose_in_map=Pose(0.6, -0.3, 1.0))
    intent, _ = strategy.decide(known, strategy.begin())
    return intent.heading


@pytest.mark.parametrize("ratio", [1.0, 2.5])
def test_without_pull_and_sway_it_is_the_paper_s_pursuer(ratio: float) -> None:
    found = heading(ParametricPursuit(ratio))
    assert found == pytest.approx(heading(Pursuit(gain_ratio=ratio)))


def test_with_a_pull_of_one_it_is_the_herding_pursuer() -> None:
    found = heading(ParametricPursuit(pull=1.0))
    assert found == pytest.approx(heading(HerdingPursuit()))


def test_sway_adds_a_periodic_error() -> None:
    plain = heading(ParametricPursuit())
    swaying = ParametricPursuit(sway=0.3, period=8.0)
    for time, error in ((0.0, 0.0), (2.0, 0.3), (4.0, 0.0), (6.0, -0.3)):
        assert heading(swaying, time) - plain == pytest.approx(error)
