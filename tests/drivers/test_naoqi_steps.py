"""Test a robot on NAOqi that is moved by footsteps."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from math import hypot, inf, nan
from typing import Any

import pytest

pytest.importorskip("qi")

from stepaside.core.poses import Pose  # noqa: E402
from stepaside.drivers.guardian_process import SessionLost  # noqa: E402
from stepaside.drivers.naoqi.footstep_mover import MAX_REFUSALS, FootstepMover
from stepaside.drivers.naoqi.motion_services import ALMotion  # noqa: E402
from stepaside.drivers.naoqi.naoqi_body import NaoqiBody  # noqa: E402
from stepaside.drivers.naoqi.naoqi_server import SILENCE, NaoqiServer
from stepaside.drivers.naoqi.service_state import WalkServiceState  # noqa: E402
from stepaside.drivers.velocity.footstep_commands import FootCommand  # noqa: E402
from stepaside.drivers.velocity.velocity_body import REST, VelocityCommand  # noqa: E402
from stepaside.games.duel_settings import DuelSettings, StartSettings  # noqa: E402
from stepaside.games.velocity_walker import VelocityWalker  # noqa: E402
from stepaside.locomotion.zmp.control_settings import STABILISED  # noqa: E402
from stepaside.planning import Foot, GaitSettings  # noqa: E402
from stepaside.sim.body_settings import BODIES  # noqa: E402

from commanded_robots import commanded_robots  # isort: skip  # noqa: E402
from naoqi_fakes import Direct  # isort: skip  # noqa: E402
from velocity_fakes import SimulatedUnicycle, until  # isort: skip  # noqa: E402

GAIT = GaitSettings()
TICK = 0.012
FASTEST = VelocityCommand(0.07, 0.4)
AHEAD = VelocityCommand(0.1, 0.1)
LEFT = ["LLeg", "RLeg"], [[0.04, 0.1, 0.0], [0.04, -0.1, 0.0]], [0.6, 1.2]
LANDING = FootCommand(Foot.LEFT, Pose(0.03, 0.1, 0.0), 0.3)


class Alone:
    """ALMotion of a robot, and a mover of it, without messaging."""

    def __init__(self) -> None:
        self.walker = SimulatedUnicycle()
        self.robot = WalkServiceState(self.walker.state(), ["a", "b"])
        self.robot.awake = True
        self.service = ALMotion(self.robot, FASTEST, GAIT)
        self.motion = Direct(self.service)
        self.now = 100.0
        self.mover = FootstepMover(self.motion, GAIT, lambda: self.now)

    def ask(self, velocity: VelocityCommand, times: int = 4) -> None:
        """Ask for a velocity again and again."""
        for _ in range(times):
            self.now += 0.05
            self.mover.command(velocity)

    def begin(self) -> None:
        """The first of the steps begins."""
        step, _ = self.robot.steps.popleft()
        self.walker.step, self.walker.steps = step, self.walker.steps + 1
        self.robot.state = self.walker.state()


def test_footsteps_are_sent_once_until_a_step_begins() -> None:
    alone = Alone()
    alone.ask(AHEAD, 10)
    (told,) = alone.motion.called("setFootSteps")
    legs, steps, times, clear = told
    assert legs == ["LLeg", "RLeg", "LLeg"] and clear
    assert times == pytest.approx([0.547, 1.094, 1.641])
    assert [step[1] > 0.0 for step in steps] == [True, False, True]
    alone.begin()
    alone.ask(VelocityCommand(0.1, -0.1), 10)
    _, again = alone.motion.called("setFootSteps")
    assert again[0] == ["RLeg", "LLeg", "RLeg"]
    assert [step[2] < 0.0 for step in again[1]] == 3 * [True]
    assert len(alone.robot.steps) == 3


def test_zero_velocity_stops_at_once_with_pending_footsteps() -> None:
    alone = Alone()
    alone.ask(AHEAD)
    alone.ask(REST, 1)
    assert not alone.robot.steps
    alone.ask(REST, 10)
    assert len(alone.motion.called("stopMove")) == 1
    alone.ask(AHEAD)
    assert len(alone.robot.steps) == 3


def test_footsteps_that_are_refused_are_planned_anew_and_then_given_up() -> (
    None
):
    alone = Alone()
    alone.robot.awake = False
    with pytest.raises(SessionLost, match="refused 5 footstep commands"):
        alone.ask(AHEAD, 100)
    assert len(alone.motion.called("setFootSteps")) == MAX_REFUSALS
    alone = Alone()
    alone.robot.awake = False
    alone.ask(AHEAD)
    alone.robot.awake = True
    alone.ask(AHEAD, 10)
    assert len(alone.robot.steps) == 3


@pytest.mark.parametrize(
    "said", [None, [], [[], [["LLeg"]], []], [[], [["LLeg", 1.0, "x"]], []]]
)
def test_footsteps_that_cannot_be_read_end_the_session(
    said: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    alone = Alone()
    monkeypatch.setattr(alone.service, "getFootSteps", lambda: said)
    with pytest.raises(SessionLost, match="(?i)footstep"):
        alone.ask(AHEAD)


@pytest.mark.parametrize(
    ("legs", "steps", "times", "said"),
    [
        ([], [], [], "same length"),
        (["LLeg"], [[0.04, 0.1, 0.0]], [0.6, 1.2], "same length"),
        (["LArm"], [[0.04, 0.1, 0.0]], [0.6], "LLeg or RLeg"),
        (
            ["LLeg", "LLeg"],
            2 * [[0.04, 0.1, 0.0]],
            [0.6, 1.2],
            "feet must alternate",
        ),
        (["LLeg"], [[0.04, nan, 0.0]], [0.6], "finite"),
        (["LLeg"], [[inf, 0.1, 0.0]], [0.6], "finite"),
        (["LLeg"], [[0.04, 0.1]], [0.6], "unpack"),
        (["LLeg"], [[0.04, 0.1, 0.0]], [nan], "times must increase"),
        (["LLeg", "RLeg"], LEFT[1], [0.6, 0.6], "times must increase"),
        (["LLeg"], [[0.04, 0.14, 0.0]], [0.6], "lateral displacement"),
        (["LLeg"], [[0.1, 0.1, 0.0]], [0.6], "at most 0.08 m"),
        (["LLeg"], [[0.0, 0.1, 0.6]], [0.6], "at most 0.08 m and 0.524"),
    ],
)
def test_infeasible_footsteps_are_refused_together(
    legs: Any, steps: Any, times: Any, said: str
) -> None:
    alone = Alone()
    alone.service.setFootSteps(*LEFT, True)
    with pytest.raises((ValueError, TypeError), match=said):
        alone.service.setFootSteps(legs, steps, times, True)
    assert [step.foot for step, _ in alone.robot.steps] == list(Foot)


def test_footsteps_must_follow_the_pending_or_current_step() -> None:
    alone = Alone()
    service = alone.service
    service.setFootSteps(*LEFT, True)
    service.setFootSteps(*LEFT, False)
    assert len(alone.robot.steps) == 4
    alone.begin()
    with pytest.raises(ValueError, match="feet must alternate"):
        service.setFootSteps(*LEFT, True)
    service.setFootSteps("RLeg", [[0.04, -0.1, 0.0]], 0.6, True)
    _, certain, later = service.getFootSteps()
    assert [step[0] for step in certain] == ["LLeg"]
    assert [step[0] for step in later] == ["RLeg"]
    assert service.moveIsActive()


def test_velocity_and_rest_clear_the_footsteps() -> None:
    alone = Alone()
    clears: list[Callable[[], None]] = [
        lambda: alone.service.move(0.05, 0.0, 0.0),
        alone.service.stopMove,
        alone.service.rest,
    ]
    for clear in clears:
        alone.robot.awake = True
        alone.service.setFootSteps(*LEFT, True)
        assert alone.robot.asked == REST
        clear()
        assert not alone.robot.steps
    with pytest.raises(RuntimeError, match="wakeUp first"):
        alone.service.setFootSteps(*LEFT, True)


@pytest.fixture
def unicycle() -> SimulatedUnicycle:
    return SimulatedUnicycle()


@pytest.fixture
def server(unicycle: SimulatedUnicycle) -> Iterator[NaoqiServer]:
    served = NaoqiServer(
        *("tcp://127.0.0.1:0", unicycle, ["a", "b"], FASTEST),
        tick=TICK,
    )
    yield served
    served.close()


def test_footsteps_end_with_their_client(
    server: NaoqiServer, unicycle: SimulatedUnicycle
) -> None:
    def by_steps(motion: Any, clock: Any) -> FootstepMover:
        return FootstepMover(motion, GAIT, clock)

    body = NaoqiBody(server.url, make_mover=by_steps)

    def walks() -> VelocityCommand:
        body.command(AHEAD)
        server.speak()
        server.act()
        return unicycle.commanded

    pace = GAIT.path_interval / GAIT.step_duration
    velocity = until(lambda: (v := walks()) != REST and v)
    assert velocity == pytest.approx((0.1 * pace, 0.1 * pace, 0.0))
    for _ in range(round(SILENCE / TICK) + 2):
        server.speak()
        server.act()
    assert unicycle.commanded == REST and not server.robot.steps
    body.close()


@pytest.fixture(scope="module")
def walked() -> tuple[VelocityWalker, list[VelocityCommand]]:
    """Return a robot with four pending footsteps."""
    settings = DuelSettings(
        seed=7,
        start=StartSettings(2.0, 0.2, 0.1),
        body=replace(BODIES["delayed"], cycle=TICK),
        control=STABILISED,
    )
    world, (walker, _) = commanded_robots(settings)
    served = NaoqiServer(
        *("tcp://127.0.0.1:0", walker, ["a"] * 24, FASTEST), tick=TICK
    )
    service = ALMotion(served.robot, FASTEST, GAIT)
    asked = []
    service.wakeUp()
    ways = [(0.0, 0.0), *3 * [(0.04, 0.0)], *2 * [(-0.02, 0.1)]]
    legs = 3 * ["RLeg", "LLeg"]
    steps = [
        [way, (0.1 if leg == "LLeg" else -0.1), turn]
        for leg, (way, turn) in zip(legs, ways, strict=True)
    ]
    service.setFootSteps(legs, steps, [0.6 * i for i in range(1, 7)], True)
    for _ in range(760):
        service.moveInit()
        served.speak()
        served.act()
        walker.tick()
        world.step()
        asked.append(walker.state().velocity)
    served.close()
    return walker, asked


def test_a_robot_walks_its_footsteps_and_stands_after_the_last(
    walked: tuple[VelocityWalker, list[VelocityCommand]],
) -> None:
    """On the spot first, then ahead, then back on an arc, after a rest."""
    walker, asked = walked
    assert not walker.has_fallen and not walker.is_moving
    state = walker.state()
    assert state.steps == 6 and state.step is None
    assert asked[-1] == REST
    assert state.pose.theta == pytest.approx(0.2, abs=0.005)
    # Three strides of 0.04 m, and two of 0.02 m back.
    assert hypot(*state.pose[:2]) == pytest.approx(0.08, abs=0.006)
