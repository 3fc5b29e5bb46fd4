"""Test a robot on NAOqi: both ends, through NAOqi's own messaging."""

import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from math import nan
from time import monotonic, sleep
from typing import Any

import pytest

pytest.importorskip("qi")

from stepaside.core.errors import ConfigurationError  # noqa: E402
from stepaside.core.poses import Pose  # noqa: E402
from stepaside.drivers.guardian_process import SessionLost  # noqa: E402
from stepaside.drivers.naoqi.joint_chains import CHAINS  # noqa: E402
from stepaside.drivers.naoqi.memory_service import (  # noqa: E402  # noqa: E402
    NO_ECHO,
    SONARS,
    ALMemory,
    ALSonar,
)
from stepaside.drivers.naoqi.motion_services import ALMotion, ALRobotPosture
from stepaside.drivers.naoqi.naoqi_body import NaoqiBody, stop  # noqa: E402
from stepaside.drivers.naoqi.naoqi_server import SILENCE, NaoqiServer  # noqa: E402
from stepaside.drivers.naoqi.naoqi_url import parse_url  # noqa: E402
from stepaside.drivers.naoqi.qi_session import connect, listen  # noqa: E402
from stepaside.drivers.naoqi.service_state import WalkServiceState  # noqa: E402
from stepaside.drivers.naoqi.velocity_mover import REPEAT, TIMEOUT  # noqa: E402
from stepaside.drivers.velocity.template_controller import TemplateController  # noqa: E402
from stepaside.drivers.velocity.velocity_body import (
    REST,
    VelocityCommand,
)
from stepaside.drivers.velocity.velocity_limits import VelocityLimits  # noqa: E402
from stepaside.drivers.velocity.velocity_loop import DrivingState, VelocityLoop
from stepaside.drivers.velocity.watchdog import WatchSettings  # noqa: E402
from stepaside.perception.measurement import Sighting  # noqa: E402
from stepaside.planning import GaitSettings  # noqa: E402
from stepaside.strategies import Pursuit  # noqa: E402

from naoqi_fakes import heard  # isort: skip  # noqa: E402
from velocity_fakes import SimulatedUnicycle, until  # isort: skip  # noqa: E402

TICK = 0.012
SILENT = round(SILENCE / TICK) + 2  # ticks


class Scene:
    """A served robot and its world."""

    def __init__(self) -> None:
        self.walker = SimulatedUnicycle()
        self.server = NaoqiServer(
            "tcp://127.0.0.1:0",
            self.walker,
            ["LKneePitch", "RKneePitch"],
            VelocityCommand(0.07, 0.4),
            tick=TICK,
        )

    def round(self) -> VelocityCommand:
        """One tick of the world."""
        self.server.speak()
        self.server.act()
        velocity = self.walker.commanded
        self.walker.move(velocity, TICK)
        return velocity


@pytest.fixture
def scene() -> Iterator[Scene]:
    scene = Scene()
    yield scene
    scene.server.close()


@pytest.fixture
def body(scene: Scene) -> Iterator[NaoqiBody]:
    """Wait until the robot stands: commands are ignored before."""
    body = NaoqiBody(scene.server.url)
    heard(body)
    yield body
    body.close()


def test_a_robot_is_woken_up_and_stands_before_it_is_ready(
    scene: Scene,
) -> None:
    scene.round()
    assert not scene.server.ready
    body = NaoqiBody(scene.server.url)
    heard(body)
    scene.round()
    assert scene.server.ready
    assert scene.server.robot.posture == "StandInit"
    body.close()
    assert not scene.server.robot.awake
    assert scene.server.robot.posture == "Crouch"


def test_velocities_arrive_and_odometry_comes_back(
    scene: Scene, body: NaoqiBody
) -> None:
    scene.walker.pose = Pose(1.0, -2.0, 2.5)
    body.command(VelocityCommand(-0.06, 0.2))
    until(lambda: scene.round() == VelocityCommand(-0.06, 0.2))
    report = heard(body)
    assert report.pose == pytest.approx(scene.server.robot.state.pose)
    assert report.sighting is None and report.hindrance == ""
    body.command(REST)
    until(lambda: scene.round() == REST)


def test_the_ideal_sight_keeps_its_age(scene: Scene, body: NaoqiBody) -> None:
    scene.walker.time = 50.0
    scene.walker.sighting = Sighting(49.75, -2.0, 0.8)
    scene.server.speak()
    report = heard(body)
    assert report.sighting is not None
    assert report.sighting[:3] == pytest.approx(
        (report.time - 0.25, -2.0, 0.8)
    )


def test_shares_of_the_top_speed_are_those_of_the_gait(scene: Scene) -> None:
    session = connect(scene.server.url)
    motion = session.service("ALMotion")
    motion.wakeUp()
    motion.moveToward(0.5, 0.0, -1.0, [["MaxStepX", 0.04]])
    assert scene.round() == pytest.approx((0.035, -0.4, 0.0))
    assert motion.getRobotVelocity() == [0.0, 0.0, 0.0]  # of the last tick
    assert motion.moveIsActive()
    motion.stopMove()
    assert scene.round() == REST and not motion.moveIsActive()
    session.close()


def test_named_services_answer(scene: Scene) -> None:
    session = connect(scene.server.url)
    motion, memory = session.service("ALMotion"), session.service("ALMemory")
    assert motion.getBodyNames("Body") == ["LKneePitch", "RKneePitch"]
    assert motion.getAngles("Body", True) == [0.1, 0.2]
    assert motion.getAngles(["RKneePitch"], False) == [0.2]
    key = "Device/SubDeviceList/RKneePitch/Position/Sensor/Value"
    assert memory.getData(key) == 0.2
    assert memory.getListData([key, "no such"]) == [0.2, None]
    assert not motion.robotIsWakeUp()
    motion.setStiffnesses("Body", 1.0)
    assert motion.robotIsWakeUp()
    session.service("ALSonar").subscribe("me")
    session.close()


class Chained:
    """ALMotion of a robot that has head and legs, without messaging."""

    def __init__(self) -> None:
        names = [*CHAINS["Head"], *CHAINS["LLeg"], *CHAINS["RLeg"]]
        angles = [0.01 * i for i in range(len(names))]
        state = SimulatedUnicycle().state()._replace(joints=angles)
        self.robot = WalkServiceState(state, names)
        self.motion = ALMotion(
            self.robot, VelocityCommand(0.07, 0.4), GaitSettings()
        )
        self.motion.wakeUp()


def test_a_limp_head_does_not_rest_the_robot() -> None:
    chained = Chained()
    motion = chained.motion
    motion.move(0.05, 0.0, 0.0)
    motion.setStiffnesses("Head", 0.0)
    assert motion.robotIsWakeUp() and motion.moveIsActive()
    motion.setAngles("Head", [0.3, 0.2], 0.2)
    assert chained.robot.head == {}
    motion.setStiffnesses("Head", 1.0)
    motion.setAngles("Head", [0.3, 0.2], 0.2)
    assert chained.robot.head == {"HeadYaw": 0.3, "HeadPitch": 0.2}


@pytest.mark.parametrize("chain", ["LLeg", "RLeg", "Legs", "Body"])
def test_a_limp_leg_does(chain: str) -> None:
    motion = Chained().motion
    motion.move(0.05, 0.0, 0.0)
    motion.setStiffnesses(chain, 0.0)
    assert not motion.robotIsWakeUp() and not motion.moveIsActive()
    motion.setStiffnesses("Head", 1.0)
    assert not motion.robotIsWakeUp()
    motion.setStiffnesses(chain, 0.8)
    assert motion.robotIsWakeUp()


def test_chains_are_known_by_name() -> None:
    motion = Chained().motion
    assert motion.getBodyNames("Head") == ["HeadYaw", "HeadPitch"]
    assert motion.getAngles("Head", True) == [0.0, 0.01]
    assert motion.getAngles(["LKneePitch", "Head"], True) == [0.05, 0.0, 0.01]
    assert motion.getBodyNames("RLeg") == list(CHAINS["RLeg"])
    assert len(motion.getBodyNames("Body")) == 14
    assert motion.getBodyNames("LArm") == []  # it has none


@pytest.mark.parametrize(
    ("method", "values", "said"),
    [
        ("setStiffnesses", ("Tail", 0.0), "no joint 'Tail'"),
        ("setStiffnesses", ("Head", [0.0, 1.0, 1.0]), "2 joints need one"),
        ("setStiffnesses", ("Head", 1.5), "must lie in"),
        ("getBodyNames", ("Tail",), "chains Head"),
        ("getAngles", ("Tail", True), "no joint"),
        ("setAngles", ("LLeg", 0.1, 0.2), "only HeadYaw and HeadPitch"),
        ("setAngles", ("Head", nan, 0.2), "finite"),
        ("setAngles", (["HeadYaw"], [0.1, 0.2], 0.2), "1 joints need one"),
    ],
)
def test_names_and_values_that_do_not_fit_are_refused(
    method: str, values: tuple[object, ...], said: str
) -> None:
    motion = Chained().motion
    with pytest.raises(ValueError, match=said):
        getattr(motion, method)(*values)
    assert motion.robotIsWakeUp()


def test_sonar_echoes_need_a_subscriber(scene: Scene) -> None:
    state = scene.walker.state()
    scene.server.robot.state = state._replace(
        echoes={"left": 0.42, "right": None}
    )
    memory, sonar = ALMemory(scene.server.robot), ALSonar(scene.server.robot)
    keys = list(SONARS.values())
    assert memory.getListData(keys) == [NO_ECHO, NO_ECHO]
    sonar.subscribe("me")
    assert memory.getListData(keys) == [0.42, NO_ECHO]
    sonar.unsubscribe("me")
    assert memory.getListData(keys) == [NO_ECHO, NO_ECHO]


@pytest.mark.parametrize(
    "asked", [(nan, 0.0, 0.0), (0.1, 0.0, float("inf")), (0.0, 0.1, 0.0)]
)
def test_a_velocity_that_cannot_be_walked_is_refused_and_the_robot_rests(
    scene: Scene, asked: tuple[float, float, float]
) -> None:
    session = connect(scene.server.url)
    motion = session.service("ALMotion")
    motion.wakeUp()
    motion.move(0.05, 0.0, 0.0)
    assert scene.round() == VelocityCommand(0.05, 0.0)
    with pytest.raises(RuntimeError, match="finite|aside"):
        motion.move(*asked)
    assert scene.round() == REST
    session.close()


def test_a_robot_that_sleeps_does_not_walk(scene: Scene) -> None:
    session = connect(scene.server.url)
    with pytest.raises(RuntimeError, match="wakeUp first"):
        session.service("ALMotion").move(0.05, 0.0, 0.0)
    session.close()


@pytest.mark.parametrize(
    ("name", "said"), [("fallen", "has fallen"), ("pressed", "chest button")]
)
def test_falls_and_the_button_are_hindrances(
    scene: Scene, body: NaoqiBody, name: str, said: str
) -> None:
    setattr(scene.server.robot, name, True)
    assert heard(body).hindrance == said


def test_the_chest_button_holds_the_robot_until_it_is_pressed_again(
    scene: Scene, body: NaoqiBody
) -> None:
    said = []
    for pressed in (False, True, False, False, True, False):
        scene.server.robot.pressed = pressed
        said.append(heard(body).hindrance)
    assert said == ["", *4 * ["chest button"], ""]


def test_a_fallen_robot_lies_still_until_its_button_is_released(
    scene: Scene, body: NaoqiBody
) -> None:
    robot = scene.server.robot
    robot.fallen = True
    assert heard(body).hindrance == "has fallen"
    robot.fallen, robot.awake, robot.posture = False, False, "Crouch"
    for _ in range(5):
        assert "has fallen" in heard(body).hindrance
    robot.pressed = True
    assert "has fallen" in heard(body).hindrance
    assert not robot.awake
    robot.pressed = False
    assert heard(body).hindrance == ""
    assert robot.awake and robot.posture == "StandInit"


def motion_of(kind: type[ALMotion], robot: WalkServiceState) -> ALMotion:
    """Return a motion service of a robot."""
    return kind(robot, VelocityCommand(0.07, 0.4), GaitSettings())


@contextmanager
def offering(
    **services: Callable[[WalkServiceState], object],
) -> Iterator[tuple[str, WalkServiceState]]:
    """Serve a robot, with some services made by other functions."""
    robot = WalkServiceState(SimulatedUnicycle().state(), ["a", "b"])
    changed = {name: make(robot) for name, make in services.items()}
    served: dict[str, object] = {
        "ALMotion": motion_of(ALMotion, robot),
        "ALMemory": ALMemory(robot),
        "ALRobotPosture": ALRobotPosture(robot),
    }
    session = listen("tcp://127.0.0.1:0", served | changed)
    try:
        yield session.endpoints()[0], robot
    finally:
        session.close()


class Unwilling:
    """A posture that is reached at the second try."""

    def __init__(self) -> None:
        self.tries = 0

    def goToPosture(self, name: str, speed: float) -> bool:
        """Fail once."""
        self.tries += 1
        return self.tries > 1


def test_a_robot_that_could_not_stand_up_tries_again_by_the_button() -> None:
    posture = Unwilling()
    with offering(ALRobotPosture=lambda robot: posture) as (url, robot):
        body = NaoqiBody(url)
        until(lambda: "could not stand up" in heard(body).hindrance)
        assert "could not stand up" in heard(body).hindrance
        robot.pressed = True
        assert "could not stand up" in heard(body).hindrance
        robot.pressed = False
        assert heard(body).hindrance == "" and posture.tries == 2
        body.close()


@pytest.mark.parametrize("slow", [0.06, 0.1])
def test_a_robot_that_answers_slowly_still_walks(slow: float) -> None:
    """The answer to a call that took longer than one look is not lost."""

    class Slow(ALMotion):
        """A service whose answers take some time."""

        def getRobotPosition(self, use_sensors: bool) -> list[float]:
            """Answer late."""
            sleep(slow)
            return super().getRobotPosition(use_sensors)

    with offering(ALMotion=partial(motion_of, Slow)) as (url, robot):
        drive_and_hear(url, robot)


def drive_and_hear(url: str, robot: WalkServiceState) -> None:
    """Check that control walks a robot with a sighting."""
    walker = SimulatedUnicycle()
    body = NaoqiBody(url)
    player = VelocityLoop(
        body,
        lambda: TemplateController(Pursuit(), GaitSettings()),
        VelocityLimits(),
        WatchSettings(),
    )
    try:
        end = monotonic() + 20.0
        while robot.asked == REST and monotonic() < end:
            walker.time += 0.05
            walker.sighting = Sighting(walker.time, 0.1, 2.0)
            robot.state = walker.state()
            player.tick()
        assert robot.asked.forward > 0.0
        ticks = [player.tick() for _ in range(20)]
        assert all(tick.state is DrivingState.WALKING for tick in ticks)
    finally:
        body.close()


class Refusing(ALMotion):
    """A motion that walks no way, and says at length why."""

    def move(self, *values: Any) -> None:
        """Refuse."""
        raise RuntimeError("ALMotion::move\n\tmotors are hot:\n\tLHipRoll")


def test_the_reason_of_a_refused_call_is_complete() -> None:
    with offering(ALMotion=partial(motion_of, Refusing)) as (url, _):
        body = NaoqiBody(url)
        heard(body)
        with pytest.raises(SessionLost) as refused:
            for i in range(1000):
                body.command(VelocityCommand(0.05, 0.001 * i))
                sleep(0.002)
        said = str(refused.value)
        assert "ALMotion::move motors are hot: LHipRoll" in said
        assert ".py" not in said
        body.close()


def test_a_robot_without_calls_stops(scene: Scene, body: NaoqiBody) -> None:
    def asked() -> bool:
        body.command(VelocityCommand(0.05, 0.1))
        return bool(scene.round() == VelocityCommand(0.05, 0.1))

    until(asked)
    assert scene.round() == VelocityCommand(0.05, 0.1)
    until(lambda: scene.round() == REST)
    assert not scene.server.connected


def test_a_world_that_goes_away_ends_the_session(scene: Scene) -> None:
    body = NaoqiBody(scene.server.url)
    heard(body)
    scene.server.close()
    with pytest.raises(SessionLost, match="the robot's"):
        for _ in range(100):
            body.listen(0.1)
    body.close()


def test_a_world_that_freezes_is_silence_and_then_takes_no_command(
    scene: Scene,
) -> None:
    now = [100.0]
    body = NaoqiBody(scene.server.url, clock=lambda: now[0])
    heard(body)
    with scene.server.robot.lock:  # every service waits for it
        now[0] += 1.0
        assert body.listen(0.02) is None
        body.command(VelocityCommand(0.05, 0.0))
        now[0] += 0.9 * TIMEOUT
        body.command(VelocityCommand(0.06, 0.0))
        now[0] += 0.2 * TIMEOUT
        with pytest.raises(
            SessionLost, match="did not answer move within 1 s"
        ):
            body.command(VelocityCommand(0.06, 0.0))
    now[0] += 1.0
    assert heard(body).hindrance == ""  # it goes on
    body.close()


def test_the_newest_command_of_two_clients_applies(
    scene: Scene,
) -> None:
    """NAOqi refuses no client; the newest command applies, even rest."""
    now = [100.0]
    body = NaoqiBody(scene.server.url, clock=lambda: now[0])
    asked = VelocityCommand(0.05, 0.1)
    heard(body)
    body.command(asked)
    until(lambda: scene.round() == asked)
    other = connect(scene.server.url)
    other.service("ALMotion").stopMove()
    assert scene.round() == REST
    body.command(asked)
    assert scene.round() == REST
    now[0] += REPEAT

    def asked_again() -> bool:  # the first may not be known to have arrived
        body.command(asked)
        return bool(scene.round() == asked)

    until(asked_again)
    other.close()
    assert scene.round() == asked
    body.close()


def test_a_dry_run_does_not_wake_or_command_the_robot(scene: Scene) -> None:
    body = NaoqiBody(scene.server.url, dry_run=True)
    body.command(VelocityCommand(0.05, 0.1))
    heard(body)
    body.close()
    assert not scene.server.robot.awake and scene.round() == REST


def test_a_guardian_can_stop_the_robot_by_itself(
    scene: Scene, body: NaoqiBody
) -> None:
    body.command(VelocityCommand(0.05, 0.1))
    until(lambda: scene.round() == VelocityCommand(0.05, 0.1))
    stop(scene.server.url)
    assert scene.round() == REST
    assert scene.server.robot.awake


COMMANDER = """
import sys
from stepaside.drivers.naoqi.naoqi_body import NaoqiBody
from stepaside.drivers.velocity.velocity_body import VelocityCommand
body = NaoqiBody(sys.argv[1])
while True:
    body.listen(0.1)
    body.command(VelocityCommand(0.03, -0.1))
"""


def test_a_commander_that_is_killed_leaves_a_robot_at_rest(
    scene: Scene,
) -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", COMMANDER, scene.server.url]
    )
    try:
        until(lambda: scene.round() == VelocityCommand(0.03, -0.1))
        process.kill()
        process.wait(20.0)
        for _ in range(SILENT):
            last = scene.round()
        assert last == REST
    finally:
        process.kill()
        process.wait(20.0)


def test_a_robot_that_is_not_there_is_said() -> None:
    with pytest.raises(SessionLost, match="no robot answers at tcp://127"):
        NaoqiBody("tcp://127.0.0.1:1")


def test_a_place_that_is_taken_is_refused(scene: Scene) -> None:
    with pytest.raises(ConfigurationError, match="cannot listen at"):
        NaoqiServer(scene.server.url, scene.walker, ["a", "b"], REST, tick=1.0)


@pytest.mark.parametrize(
    ("text", "url"),
    [
        ("naoqi:tcp://nao.local:9559", "tcp://nao.local:9559"),
        ("naoqi:nao.local", "tcp://nao.local:9559"),
        ("127.0.0.1:80", "tcp://127.0.0.1:80"),
    ],
)
def test_urls_are_read(text: str, url: str) -> None:
    assert parse_url(text) == url


@pytest.mark.parametrize(
    "text", ["naoqi:", "naoqi:tcp://", "http://a:1", "a:0", "a:70000", "a b"]
)
def test_an_invalid_url_is_refused(text: str) -> None:
    with pytest.raises(ConfigurationError, match="naoqi:tcp://HOST:PORT"):
        parse_url(text)
