"""Test the execution of a strategy by a walking robot."""

from collections.abc import Callable
from math import atan2, hypot, nan
from typing import Any

import pytest

from fake_robot import GAIT, STEP, FakeStrategy
from stepaside.control.strategy_runner import StrategyRunner
from stepaside.core.errors import StrategyError
from stepaside.core.poses import Pose
from stepaside.perception.measurement import Sighting
from stepaside.planning import Foot
from stepaside.strategies import Intent, Knowledge

PLACE = Pose(1.0, 2.0, 0.5)


def decisions(strategy: FakeStrategy | None = None) -> StrategyRunner:
    """Decisions of a robot whose torso looks along 0.2 rad."""
    made = StrategyRunner(strategy or FakeStrategy(), GAIT)
    made.headings.note(0.0, 0.2)
    made.templates.note(0.0, PLACE)
    return made


def test_a_step_begins_beside_the_foot_that_landed() -> None:
    made = decisions()
    foot = Pose(0.3, -0.2, 0.7)
    seen = Sighting(2.5, 0.4, 1.5, spread=0.07)
    made.decide(3.0, seen, moving=True, stands=(foot, Foot.LEFT))
    made.decide(3.0, seen, moving=False, stands=(foot, Foot.LEFT))
    made.decide(3.0, seen, moving=True)
    known, *others = made.memory
    back = foot.inverse().compose(known.step_start_in_map)
    half = 0.5 * GAIT.foot_spacing
    assert back == pytest.approx(Pose(0.0, -half, 0.0))
    assert [each.step_start_in_map for each in others] == [None, None]
    assert known.spread == 0.07


def test_it_tells_how_the_other_walks_in_its_own_frame() -> None:
    """On the floor, whatever line of sight and distance do."""
    made = decisions()
    for i in range(6):
        time = 0.3 * i
        x, y = 1.2 - 0.5 * time, 0.8 - 0.2 * time  # from PLACE, on its axes
        seen = Sighting(time, atan2(y, x) + 0.5 - 0.2, hypot(x, y))
        made.decide(time, seen, moving=True)
    first, *_, last = made.memory
    assert first.velocity is None
    assert last.velocity == pytest.approx((-0.5, -0.2))


def test_line_of_sight_and_heading_are_of_one_instant() -> None:
    """However late a sighting is, it counts from where the body was then."""
    made = decisions()
    made.headings.note(1.0, 0.6)
    made.templates.note(1.0, Pose(1.1, 2.0, 0.8))
    for age in (0.0, 0.3, 0.9):
        for seen, torso, template in ((0.5, 0.2, 0.5), (1.0, 0.6, 0.8)):
            sighting = Sighting(seen, 0.4, 1.5)
            made.decide(seen + age, sighting, moving=True)
            known = made.memory[-1]
            assert known.bearing == pytest.approx(torso + 0.4 - template)
            assert known.pose_in_map.theta == template


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (lambda: dict[str, int]()["lost"], "KeyError: 'lost'"),
        (lambda: (Intent(nan), None), "PlanError: heading must lie in"),
        (lambda: None, "TypeError: cannot unpack"),
        (lambda: (0.3, None), "decide must return an Intent, got 0.3"),
    ],
)
def test_a_failing_strategy_raises_a_strategy_error(
    answer: Callable[[], Any], said: str
) -> None:
    class Failing(FakeStrategy):
        """Strategy that fails."""

        def decide(self, knowledge: Knowledge, memory: Any) -> Any:
            return answer()

    made, seen = decisions(Failing()), Sighting(0.0, 0.1, 1.0)
    before = made.memory
    with pytest.raises(StrategyError, match=said):
        made.starts(0.0, seen)
    with pytest.raises(StrategyError, match=said):
        made.decide(0.0, seen, moving=True)
    assert made.memory == before


def test_rates_are_reset_for_a_different_person() -> None:
    """The next one's velocity is its own, and unknown at first."""
    made, speeds = decisions(), []
    for i in range(12):
        now = i * 0.25 * STEP
        who = 1 if i < 6 else 2
        seen = Sighting(now, 0.0, 1.8 if who == 1 else 1.0, who)
        made.decide(now, seen, moving=False)
        speeds.append(made.memory[-1].velocity)
    assert speeds[6] is None and speeds[5] is not None
    assert speeds[-1] == pytest.approx((0.0, 0.0), abs=1e-9)


def test_an_unsettled_sighting_does_not_start_a_walk() -> None:
    """A robot under way goes on all the same."""
    made = decisions()
    seen = Sighting(0.0, 0.3, 1.0)
    assert made.starts(0.0, seen)
    assert not made.starts(0.0, seen._replace(settled=False))
    intent = made.decide(0.0, seen._replace(settled=False), moving=True)
    assert intent.walks
