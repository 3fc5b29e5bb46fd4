"""Test a robot on NAOqi: both ends, through NAOqi's own messaging."""

import subprocess
import sys
from collections.abc import Iterator
from math import nan

import pytest

pytest.importorskip("qi")

from stepaside.drivers.naoqi.address import parse_url  # noqa: E402
from stepaside.drivers.naoqi.body import NaoqiBody, stop  # noqa: E402
from stepaside.drivers.naoqi.memory_service import (  # noqa: E402
    SILENCE as SILENCE_HEARD,
)
from stepaside.drivers.naoqi.memory_service import (  # noqa: E402
    SONARS,
    ALMemory,
    ALSonar,
)
from stepaside.drivers.naoqi.moving import REPEATED, STUCK  # noqa: E402
from stepaside.drivers.naoqi.server import SILENCE, NaoqiServer  # noqa: E402
from stepaside.drivers.naoqi.session import connect  # noqa: E402
from stepaside.drivers.session import SessionLost  # noqa: E402
from stepaside.drivers.velocity.body import (  # noqa: E402
    REST,
    Report,
    Velocity,
)
from stepaside.errors import ConfigurationError  # noqa: E402
from stepaside.poses import Pose  # noqa: E402
from stepaside.sensing.measurement import Sighting  # noqa: E402

from velocity_fakes import MadeUpWalker, until  # isort: skip  # noqa: E402

TICK = 0.012
SILENT = round(SILENCE / TICK) + 2  # ticks


class Scene:
    """A served robot and its world."""

    def __init__(self) -> None:
        self.walker = MadeUpWalker()
        self.server = NaoqiServer(
            "tcp://127.0.0.1:0",
            self.walker,
            ["LKneePitch", "RKneePitch"],
            Velocity(0.07, 0.4),
            tick=TICK,
        )

    def round(self) -> Velocity:
        """One tick of the world."""
        self.server.speak()
        velocity = self.server.act()
        self.walker.move(velocity, TICK)
        return velocity


@pytest.fixture
def scene() -> Iterator[Scene]:
    scene = Scene()
    yield scene
    scene.server.close()


def heard(body: NaoqiBody) -> Report:
    """Next report of a robot that stands: that answer may be on its way."""

    def told() -> Report | None:
        report = body.listen(1.0)
        rises = report is not None and report.hindrance == "stands up"
        return None if rises else report

    report: Report = until(told)
    return report


@pytest.fixture
def body(scene: Scene) -> Iterator[NaoqiBody]:
    """One that stands: what is asked of one that rises is forgotten."""
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
    body.command(Velocity(-0.06, 0.2))
    until(lambda: scene.round() == Velocity(-0.06, 0.2))
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
    assert scene.round() == pytest.approx((0.035, -0.4))
    assert motion.getRobotVelocity() == [0.0, 0.0, 0.0]  # of the last tick
    assert motion.moveIsActive()
    motion.stopMove()
    assert scene.round() == REST and not motion.moveIsActive()
    session.close()


def test_what_robots_are_asked_by_name_is_answered(scene: Scene) -> None:
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


def test_sonars_are_heard_while_somebody_listens(scene: Scene) -> None:
    state = scene.walker.state()
    scene.server.robot.state = state._replace(
        echoes={"left": 0.42, "right": None}
    )
    memory, sonar = ALMemory(scene.server.robot), ALSonar(scene.server.robot)
    keys = list(SONARS.values())
    assert memory.getListData(keys) == [SILENCE_HEARD, SILENCE_HEARD]
    sonar.subscribe("me")
    assert memory.getListData(keys) == [0.42, SILENCE_HEARD]
    sonar.unsubscribe("me")
    assert memory.getListData(keys) == [SILENCE_HEARD, SILENCE_HEARD]


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
    assert scene.round() == Velocity(0.05, 0.0)
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
def test_what_the_robot_feels_hinders_it(
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


def test_a_robot_that_nobody_asks_anything_rests(
    scene: Scene, body: NaoqiBody
) -> None:
    def asked() -> bool:
        body.command(Velocity(0.05, 0.1))
        return bool(scene.round() == Velocity(0.05, 0.1))

    until(asked)
    assert scene.round() == Velocity(0.05, 0.1)
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
        body.command(Velocity(0.05, 0.0))
        now[0] += 0.9 * STUCK
        body.command(Velocity(0.06, 0.0))
        now[0] += 0.2 * STUCK
        with pytest.raises(SessionLost, match="takes no command"):
            body.command(Velocity(0.06, 0.0))
    now[0] += 1.0
    assert heard(body).hindrance == ""  # it goes on
    body.close()


def test_what_a_second_client_asks_holds_until_the_first_asks_again(
    scene: Scene,
) -> None:
    """NAOqi refuses nobody; the last word counts, and rest is one."""
    now = [100.0]
    body = NaoqiBody(scene.server.url, clock=lambda: now[0])
    asked = Velocity(0.05, 0.1)
    heard(body)
    body.command(asked)
    until(lambda: scene.round() == asked)
    other = connect(scene.server.url)
    other.service("ALMotion").stopMove()
    assert scene.round() == REST
    body.command(asked)
    assert scene.round() == REST
    now[0] += REPEATED

    def asked_again() -> bool:  # the first may not be known to have arrived
        body.command(asked)
        return bool(scene.round() == asked)

    until(asked_again)
    other.close()
    assert scene.round() == asked
    body.close()


def test_a_dry_run_wakes_nobody_and_commands_nothing(scene: Scene) -> None:
    body = NaoqiBody(scene.server.url, dry_run=True)
    body.command(Velocity(0.05, 0.1))
    heard(body)
    body.close()
    assert not scene.server.robot.awake and scene.round() == REST


def test_a_guardian_can_stop_the_robot_by_itself(
    scene: Scene, body: NaoqiBody
) -> None:
    body.command(Velocity(0.05, 0.1))
    until(lambda: scene.round() == Velocity(0.05, 0.1))
    stop(scene.server.url)
    assert scene.round() == REST
    assert scene.server.robot.awake


COMMANDER = """
import sys
from stepaside.drivers.naoqi.body import NaoqiBody
from stepaside.drivers.velocity.body import Velocity
body = NaoqiBody(sys.argv[1])
while True:
    body.listen(0.1)
    body.command(Velocity(0.03, -0.1))
"""


def test_a_commander_that_is_killed_leaves_a_robot_at_rest(
    scene: Scene,
) -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", COMMANDER, scene.server.url]
    )
    try:
        until(lambda: scene.round() == Velocity(0.03, -0.1))
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
def test_what_is_no_url_is_refused(text: str) -> None:
    with pytest.raises(ConfigurationError, match="naoqi:tcp://HOST:PORT"):
        parse_url(text)
