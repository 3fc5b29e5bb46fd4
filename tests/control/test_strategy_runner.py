"""Test the execution of a strategy by a walking robot."""

from collections.abc import Callable
from math import atan2, hypot, nan, sin
from typing import Any

import pytest

from fake_robot import FIRST, GAIT, STEP, TICK, FakeStrategy, Run
from stepaside.control.strategy_runner import StrategyRunner
from stepaside.core.errors import StrategyError
from stepaside.core.poses import Pose
from stepaside.locomotion.walk_snapshots import Phase
from stepaside.perception.measurement import Sighting
from stepaside.planning import Direction, Foot
from stepaside.strategies import (
    Evasion,
    EvasionMemory,
    Intent,
    Knowledge,
    Pursuit,
    Walk,
)

PLACE = Pose(1.0, 2.0, 0.5)


def decisions(strategy: FakeStrategy | None = None) -> StrategyRunner:
    """Decisions of a robot whose torso looks along 0.2 rad."""
    made = StrategyRunner(strategy or FakeStrategy(), GAIT, TICK)
    made.headings.note(0.0, 0.2)
    made.templates.note(0.0, PLACE)
    return made


def test_knowledge_is_in_the_frame_of_the_template() -> None:
    made = decisions()
    made.decide(3.0, Sighting(2.5, 0.4, 1.5), moving=True)
    (known,) = made.memory
    assert known.bearing == pytest.approx(0.4 + 0.2 - 0.5)
    assert known.time == 3.0 and known.age == 0.5 and known.distance == 1.5
    assert (
        known.pose_in_map == PLACE
        and known.moving
        and not known.obstacles_in_map
    )
    limits = known.limits
    assert (limits.speed, limits.gain) == (GAIT.speed, GAIT.gain)
    assert (limits.stride, limits.step_duration) == (GAIT.stride, STEP)
    made.decide(3.0, Sighting(3.1, 0.4, 1.5), moving=False)
    assert made.memory[1].age == 0.0 and not made.memory[1].moving


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


def test_knowledge_contains_the_closing_speed() -> None:
    made = decisions()
    for i in range(4):
        seen = Sighting(i * STEP, 0.1 * i, 1.5 - 0.02 * i)
        made.decide(i * STEP, seen, moving=True)
    first, *_, last = made.memory
    assert first.bearing_rate is None and first.closing_speed is None
    assert last.bearing_rate == pytest.approx(0.1 / STEP)
    assert last.closing_speed == pytest.approx(0.02 / STEP)


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


def test_memory_of_the_starting_decision_is_discarded() -> None:
    """The second decision uses the time and line of sight of the step."""

    class Counting(FakeStrategy):
        """Counts how often it decided."""

        def begin(self) -> int:  # type: ignore[override]
            return 0

        def decide(self, knowledge, memory):  # type: ignore[no-untyped-def]
            intent, _ = super().decide(knowledge, ())
            return intent, memory + 1

    made = decisions(Counting())
    far, near = Sighting(0.0, 0.0, 3.0), Sighting(0.0, 0.0, 1.0)
    assert not made.starts(0.0, far) and made.memory == 1
    assert made.starts(0.0, near) and made.memory == 1
    made.decide(0.0, near, moving=False)
    assert made.memory == 2


def test_a_strategy_of_the_same_class_keeps_the_memory() -> None:
    made = StrategyRunner(Evasion(), GAIT, TICK)
    made.memory = EvasionMemory(True, 1)
    made.adopt(Evasion(angle=1.0))
    assert made.memory == EvasionMemory(True, 1)
    assert made.strategy == Evasion(angle=1.0)
    made.adopt(Pursuit())
    assert made.memory is None
    made.adopt(Evasion())
    assert made.memory == EvasionMemory(False, 0)


def test_an_adopted_strategy_acts_at_the_next_step() -> None:
    run = Run(Walk(0.5))
    run.until(FIRST - 0.1)
    run.scheme.decisions.adopt(Walk(-0.5, Direction.BACKWARD))
    plan = run.scheme.state.plan
    assert plan is not None and plan.bearing == 0.5
    plan = run.until(FIRST + 0.1).state.plan
    assert plan is not None and plan.bearing == -0.5
    assert plan.direction is Direction.BACKWARD


@pytest.mark.parametrize("factor", [1.0, 0.5, 0.2])
def test_stride_scales_with_the_speed_factor(
    factor: float,
) -> None:
    run = Run(FakeStrategy(heading=0.5, speed_factor=factor))
    full = Run(FakeStrategy(heading=0.5))
    full.until(FIRST + 2.5 * STEP)
    run.until(FIRST + 2.5 * STEP)
    for (at, foot, pose), (then, same, whole) in zip(
        run.landings, full.landings, strict=True
    ):
        assert (at, foot) == (then, same)
        assert pose.theta == pytest.approx(whole.theta, abs=1e-15)
    ways = [
        pose.x + 0.5 * GAIT.foot_spacing * sin(pose.theta)
        for pose in (run.landings[0][2], full.landings[0][2])
    ]
    assert ways[0] == pytest.approx(factor * ways[1])


def test_zero_speed_factor_halts() -> None:
    run = Run(FakeStrategy())
    run.until(FIRST - 0.1)
    run.strategy.speed_factor = 0.0
    run.until(FIRST + 0.1)
    assert run.phase() is Phase.HALTING
    run.until(FIRST + 4.0)
    assert run.phase() is Phase.STANDING
    run.strategy.speed_factor = 0.5
    run.until(FIRST + 4.0 + 2 * TICK)
    assert run.phase() is Phase.WALKING


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (lambda: dict[str, int]()["lost"], "KeyError: 'lost'"),
        (lambda: (Intent(nan), None), "PlanError: heading must be finite"),
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


def test_knowledge_tells_whether_the_body_walks() -> None:
    """It stands before its first step, and again after it has halted."""
    run = Run()
    run.until(FIRST + 2.2 * STEP)
    under_way = [known.moving for known in run.scheme.decisions.memory]
    assert under_way == [False, True, True, True]
    run.until(FIRST + 8.0 * STEP, distance=3.0)
    assert run.phase() is Phase.STANDING
    run.until(run.ticks * TICK + STEP)
    known = run.scheme.decisions.memory[len(under_way)]
    assert not known.moving and run.phase() is Phase.WALKING
