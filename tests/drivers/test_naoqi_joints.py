"""Test a robot on NAOqi that is moved by its joints."""

import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from math import isnan, nan, radians
from threading import Thread
from time import monotonic
from typing import Any

import numpy as np
import pytest

pytest.importorskip("qi")
pytest.importorskip("msgpack")

from stepaside.drivers.guardian_process import SessionLost  # noqa: E402
from stepaside.drivers.joint.joint_body import JointBody  # noqa: E402
from stepaside.drivers.joint.joint_loop import JointLoop, JointTick  # noqa: E402
from stepaside.drivers.joint.safety_state_machine import RobotState  # noqa: E402
from stepaside.drivers.lola.conventions import (  # noqa: E402
    COUNTER,
    LOCK_STEP,
)
from stepaside.drivers.lola.nao_joints import (
    NAMES,  # noqa: E402
    TICK,  # noqa: E402
)
from stepaside.drivers.lola.wire import WireError  # noqa: E402
from stepaside.drivers.naoqi.joint_chains import CHAINS  # noqa: E402
from stepaside.drivers.naoqi.joint_connection import open_joints  # noqa: E402
from stepaside.drivers.naoqi.joint_server import (  # noqa: E402
    NaoqiJointServer,
)
from stepaside.drivers.naoqi.joint_services import (  # noqa: E402
    JointMemoryService,
    JointMotionService,
    JointServiceState,
)
from stepaside.drivers.naoqi.joint_transport import (
    ramp_stiffness_down,
    service_of,
)
from stepaside.drivers.naoqi.qi_session import connect, listen  # noqa: E402
from stepaside.drivers.naoqi.sensor_keys import (  # noqa: E402
    KEYS,
    OLDER,
    frame_of,
    values_of,
)
from stepaside.drivers.scheme_factory import control_scheme_factory  # noqa: E402
from stepaside.games.duel import run_duel  # noqa: E402
from stepaside.games.duel_settings import DuelSettings, StartSettings  # noqa: E402
from stepaside.games.robot_endpoints import NaoqiJointsEndpoint  # noqa: E402
from stepaside.games.run_archive import results_of
from stepaside.games.served_duel import serve_duel  # noqa: E402
from stepaside.locomotion.zmp.control_settings import ControlSettings  # noqa: E402
from stepaside.perception.measurement import Sighting  # noqa: E402
from stepaside.planning import GaitSettings  # noqa: E402
from stepaside.robots.description import load_robot  # noqa: E402
from stepaside.sim.body_settings import BODIES  # noqa: E402
from stepaside.strategies import Evasion  # noqa: E402

from lola_fakes import (  # isort: skip  # noqa: E402
    JOINTS,
    STANCE,
    MadeUpRobot,
    pressed,
    sensor_frame,
)
from velocity_fakes import until  # isort: skip  # noqa: E402

ANYWHERE = "tcp://127.0.0.1:0"


def told_of(frame: Any) -> list[Any]:
    """Return the values of ALMemory for a frame."""
    values = values_of(frame)
    return [values[key] for key in KEYS]


def test_a_frame_survives_the_keys_of_almemory() -> None:
    frame = pressed(
        stiffness=np.linspace(0.0, 1.0, 25),
        temperature=np.linspace(20.0, 70.0, 25),
        status=(0, 1, 2, 3, *21 * (0,)),
        accelerometer=np.array([1.0, -2.0, -9.0]),
        gyroscope=np.array([0.1, -0.2, 0.3]),
        angles=(0.05, -0.04),
        fsr=np.linspace(0.1, 0.8, 8),
        sonar=(0.3, 1.2),
        current=np.linspace(-0.5, 2.0, 25),
    )
    touch = list(frame.touch)
    touch[5] = touch[9] = 1.0
    frame = frame._replace(touch=tuple(touch))
    read = frame_of(told_of(frame), 7, lock_step=True)
    assert read.battery[COUNTER] == 7 and read.robot_config[0] == LOCK_STEP
    assert read.battery[0] == frame.battery[0]
    same = frame._replace(battery=read.battery, robot_config=read.robot_config)
    for got, wanted in zip(read, same, strict=True):
        np.testing.assert_array_equal(got, wanted)


def test_the_names_are_those_of_naoqi() -> None:
    device = "Device/SubDeviceList"
    for key in (
        f"{device}/LKneePitch/Position/Sensor/Value",
        f"{device}/InertialSensor/AccelerometerZ/Sensor/Value",
        f"{device}/InertialSensor/GyroscopeX/Sensor/Value",
        f"{device}/InertialSensor/AngleY/Sensor/Value",
        f"{device}/RFoot/FSR/RearRight/Sensor/Value",
        f"{device}/US/Left/Sensor/Value",
        f"{device}/LFoot/Bumper/Left/Sensor/Value",
        f"{device}/RKneePitch/ElectricCurrent/Sensor/Value",
    ):
        assert KEYS.count(key) == 1


@pytest.mark.parametrize("value", [None, nan, "x", [1.0]])
@pytest.mark.parametrize("key", ["LKneePitch/Position", "AngleX", "LFoot/FSR"])
def test_values_that_are_not_finite_are_not_a_frame(
    key: str, value: object
) -> None:
    told = told_of(sensor_frame())
    at = next(i for i, k in enumerate(KEYS) if key in k)
    told[at] = value
    with pytest.raises(WireError, match=key):
        frame_of(told, 0, lock_step=False)
    with pytest.raises(WireError, match="values are needed"):
        frame_of(told[:-1], 0, lock_step=False)


def test_values_that_some_robots_lack_are_optional() -> None:
    told = told_of(sensor_frame())
    for at, key in enumerate(KEYS):
        absent = ("Hand/", "Wrist", "Status", "US", "Bumper", "Battery")
        if any(word in key for word in (*absent, "Current", "GyroscopeZ")):
            told[at] = None
    frame = frame_of(told, 0, lock_step=False)
    assert frame.sonar == (2.55, 2.55) and max(frame.status) == 0
    assert frame.battery[0] == 1.0  # no reason to stop
    assert isnan(frame.gyroscope[2]) and frame.gyroscope[0] == 0.0


class OlderMemory(JointMemoryService):
    """ALMemory of a NAO V3 or V4."""

    def _renamed(self, key: str) -> str:
        newer = {older: newer for newer, older in OLDER.items()}
        gone = key in OLDER or key.endswith("GyroscopeZ/Sensor/Value")
        return "nothing" if gone else newer.get(key, key)

    def getData(self, key: str) -> Any:
        """One value."""
        return super().getData(self._renamed(key))

    def getListData(self, keys: Any) -> list[Any]:
        """Values; None for what there is not."""
        return super().getListData([self._renamed(key) for key in keys])


def test_robots_with_the_older_inertial_unit_are_read() -> None:
    device = "Device/SubDeviceList/InertialSensor"
    assert set(OLDER.values()) == {
        f"{device}/{name}/Sensor/Value"
        for name in ("AccX", "AccY", "AccZ", "GyrX", "GyrY")
    }
    robot = JointServiceState()
    robot.values = values_of(
        sensor_frame(
            accelerometer=np.array([0.5, -0.25, -9.5]),
            gyroscope=np.array([0.1, -0.2, 7.0]),
        )
    )
    services = {
        "ALMotion": JointMotionService(robot),
        "ALMemory": OlderMemory(robot),
    }
    session = listen(ANYWHERE, services)
    try:
        body = open_joints(session.endpoints()[0], JOINTS, STANCE)
        for _ in range(3):
            measured = body.read()
            body.write(STANCE)
        assert measured.accelerometer.tolist() == [-0.5, 0.25, 9.5]
        assert measured.gyro[:2].tolist() == [0.1, -0.2]
        assert isnan(measured.gyro[2])
        body.close()
    finally:
        session.close()


class Scene:
    """Served robot and player in lock step, in one thread."""

    def __init__(self, *, lock_step: bool = True) -> None:
        self.robot = MadeUpRobot()
        self.server = NaoqiJointServer(
            ANYWHERE, self.robot, JOINTS, lock_step=lock_step
        )
        self.body: JointBody = open_joints(self.server.url, JOINTS, STANCE)

    def ticks(self, count: int, targets: Any = STANCE) -> None:
        """Ticks of world and player."""
        for _ in range(count):
            self.server.speak()
            self.body.read()
            self.body.write(targets)
            until(lambda: self.server.robot.answered)
            self.server.act()

    def walk(self) -> None:
        """Stand up, and be started by the chest button."""
        self.ticks(100)
        before = self.body.state
        assert self.server.ready
        self.server.press(True)
        self.ticks(1)
        self.server.press(False)
        self.ticks(1)
        assert (before, self.body.state) == (
            RobotState.READY,
            RobotState.WALKING,
        )


@pytest.fixture
def scene() -> Iterator[Scene]:
    scene = Scene()
    yield scene
    scene.body.close()
    scene.server.close()


def test_joint_commands_reach_the_joints(scene: Scene) -> None:
    """The limits are inactive; equality holds to rounding."""
    scene.robot.angles = STANCE + 0.03
    scene.walk()
    generator = np.random.default_rng(5)
    for _ in range(10):
        asked = STANCE + 0.02 * generator.uniform(-1.0, 1.0, len(STANCE))
        scene.ticks(1, asked)
        np.testing.assert_allclose(scene.robot.angles, asked, atol=1e-15)
        assert scene.robot.stiffness.min() == 1.0


def test_measurements_reach_control(scene: Scene) -> None:
    scene.robot.sighting = Sighting(-0.25, 0.5, 0.9)
    scene.ticks(1)
    scene.server.speak()
    read, given = scene.body.read(), scene.robot.sensors()
    for name in ("joint_positions", "gyro", "accelerometer", "foot_forces"):
        np.testing.assert_allclose(
            getattr(read, name), getattr(given, name), rtol=1e-15, atol=0.0
        )
    assert read.sighting is not None
    age = read.time - read.sighting.time
    assert age == pytest.approx(given.time + 0.25)
    assert read.sighting[1:3] == (0.5, 0.9)


@pytest.mark.parametrize("bearing", [radians(-238.0), 3.2, nan])
def test_an_invalid_bearing_is_dropped(scene: Scene, bearing: float) -> None:
    scene.robot.sighting = Sighting(0.0, bearing, 0.9)
    scene.ticks(1)
    scene.server.speak()
    assert scene.body.read().sighting is None


def test_a_robot_is_limp_first_and_stiffens_slowly(scene: Scene) -> None:
    shares = []
    for _ in range(90):
        scene.ticks(1)
        shares.append(float(scene.server.joints.stiffness.max()))
    assert shares[0] == 0.0 and shares[-1] == 1.0
    assert np.diff(shares).min() >= 0.0 and np.diff(shares).max() < 0.013


def test_closing_the_session_ramps_the_stiffness_down(scene: Scene) -> None:
    scene.ticks(12)
    scene.body.close()
    assert scene.server.robot.stiffness.max() == 0.0


def test_a_world_that_freezes_ends_the_session_and_the_robot_is_limp() -> None:
    scene = Scene(lock_step=False)
    for _ in range(5):
        scene.server.speak()
        scene.body.read()
        scene.body.write(STANCE)
    with pytest.raises(SessionLost, match="no valid frame for"):
        scene.body.read()
    assert scene.body.state is RobotState.LIMP
    until(lambda: scene.server.robot.stiffness.max() == 0.0)
    scene.body.close()
    scene.server.close()


def test_a_world_that_is_gone_ends_the_session(scene: Scene) -> None:
    scene.ticks(12)
    scene.server.close()
    with pytest.raises(SessionLost):
        for _ in range(100):
            scene.body.read()
            scene.body.write(STANCE)
    assert scene.body.state is RobotState.LIMP


def test_values_that_are_not_numbers_are_refused_and_then_silence() -> None:
    scene = Scene(lock_step=False)
    for _ in range(5):
        scene.server.speak()
        scene.body.read()
        scene.body.write(STANCE)
    scene.robot.angles = np.full(len(STANCE), nan)
    scene.server.speak()
    with pytest.raises(SessionLost, match="1 refused"):
        scene.body.read()
    assert scene.body.state is RobotState.LIMP
    scene.body.close()
    scene.server.close()


def test_stiffness_decays_when_the_client_falls_silent(
    scene: Scene,
) -> None:
    scene.ticks(12)
    for _ in range(60):
        scene.server.speak()
        scene.server.act()
    assert scene.robot.stiffness.max() == 0.0
    assert not scene.server.connected and scene.server.hear()


def test_the_last_of_two_clients_has_the_joint(scene: Scene) -> None:
    """NAOqi refuses no client: limits hold for all commands together."""
    scene.ticks(12)
    other = connect(scene.server.url)
    service_of(other, "ALMotion").setAngles("HeadYaw", 0.5, 1.0)
    scene.server.act()
    head = list(JOINTS).index("HeadYaw")
    assert scene.robot.angles[head] == 0.5
    scene.ticks(1)
    assert scene.robot.angles[head] == STANCE[head]
    other.close()


@pytest.mark.parametrize(
    ("method", "values", "said"),
    [
        ("setAngles", ("LKneePitch", nan, 1.0), "finite"),
        ("setAngles", ("LKneePitch", 0.1, 0.0), "fraction"),
        (
            "setAngles",
            (["LKneePitch", "HeadYaw"], [1, 2, 3], 1.0),
            "joints need",
        ),
        ("setAngles", ("LKnee", 0.1, 1.0), "no joint 'LKnee'"),
        ("setStiffnesses", ("Body", 1.5), "stiffness must lie"),
        ("setStiffnesses", ("Body", nan), "stiffness must lie"),
    ],
)
def test_invalid_joint_commands_are_refused(
    method: str, values: tuple[Any, ...], said: str
) -> None:
    robot = JointServiceState()
    motion = JointMotionService(robot)
    with pytest.raises(ValueError, match=said):
        getattr(motion, method)(*values)
    assert robot.taken() is None and not robot.answered


def test_joints_are_found_by_name() -> None:
    robot = JointServiceState()
    motion = JointMotionService(robot)
    motion.setStiffnesses("Body", 0.5)
    motion.setAngles(["RHipYawPitch", "LKneePitch"], [0.1, 0.2], 0.5)
    assert motion.getAngles("LHipYawPitch", False) == [0.1]
    assert motion.getAngles(["LKneePitch"], True) == [0.0]
    assert motion.robotIsWakeUp() and robot.answered
    motion.rest()
    assert not motion.robotIsWakeUp()
    motion.wakeUp()
    assert motion.getAngles("LKneePitch", False) == [0.0]
    assert set(motion.getBodyNames("Body")) == {*NAMES, "RHipYawPitch"}
    robot.values["a"] = 1.0
    assert JointMemoryService(robot).getListData(["a", "b"]) == [1.0, None]
    assert JointMemoryService(robot).getData("a") == 1.0


def test_a_chain_has_exactly_its_joints() -> None:
    robot = JointServiceState()
    motion = JointMotionService(robot)
    motion.wakeUp()
    motion.setStiffnesses("Head", 0.0)
    assert [NAMES[i] for i in np.flatnonzero(robot.stiffness == 0.0)] == [
        "HeadYaw",
        "HeadPitch",
    ]
    for chain, joints in CHAINS.items():
        assert motion.getBodyNames(chain) == list(joints)
        wanted = np.linspace(0.1, 0.3, len(joints))
        if "RHipYawPitch" in joints and "LHipYawPitch" in joints:
            wanted[:] = 0.2  # one motor
        motion.setAngles(chain, wanted.tolist(), 0.5)
        assert motion.getAngles(chain, False) == wanted.tolist()
        motion.setAngles([chain, "HeadYaw"], 0.4, 0.5)
        assert motion.getAngles([chain, "HeadYaw"], False) == pytest.approx(
            (len(joints) + 1) * [0.4]
        )


CONTROL = """
import sys
import numpy as np
from stepaside.drivers.joint.session_options import SessionOptions
from stepaside.drivers.joint.safety_conditions import SafetySettings
from stepaside.drivers.naoqi.joint_connection import open_joints
names = sys.argv[2].split(",")
stance = np.array([float(v) for v in sys.argv[3].split(",")])
patient = SessionOptions(guarded=True, safety=SafetySettings(silence=5.0))
body = open_joints(sys.argv[1], names, stance, patient)
while True:
    body.read()
    body.write(stance)
"""


def test_the_guardian_releases_the_joints_when_control_is_killed() -> None:
    """Whatever the robot does by itself: its own decay is not at work."""
    robot = MadeUpRobot()
    server = NaoqiJointServer(ANYWHERE, robot, JOINTS)
    words = [server.url, ",".join(JOINTS), ",".join(map(str, STANCE))]
    process = subprocess.Popen([sys.executable, "-c", CONTROL, *words])

    spoken = monotonic()

    def stiff() -> bool:
        nonlocal spoken
        if server.robot.answered and monotonic() > spoken + TICK:
            spoken = monotonic()
            server.speak()
        return bool(server.robot.stiffness.max() > 0.3)

    try:
        until(stiff)
        process.kill()
        process.wait(20.0)
        assert server.robot.stiffness.max() > 0.3
        until(lambda: server.robot.stiffness.max() == 0.0)
    finally:
        process.kill()
        process.wait(20.0)
        server.close()


def test_falling_stiffness_can_be_asked_for_from_elsewhere(
    scene: Scene,
) -> None:
    scene.ticks(12)
    ramp_stiffness_down(scene.server.url, np.zeros(25), np.full(25, 0.8))
    assert scene.server.robot.stiffness.max() == 0.0
    np.testing.assert_array_equal(
        scene.server.joints.targets[:5], scene.server.robot.targets[:5]
    )


SETTINGS = DuelSettings(
    seed=7,
    duration=2.0,
    start=StartSettings(0.75, 0.2, 0.1),
    body=replace(BODIES["delayed"], cycle=0.012),
    control=ControlSettings(method="measured", feedback=True),
)


def client(url: str, ticks: list[JointTick]) -> None:
    """The evader, until its robot is gone."""
    make = control_scheme_factory(
        load_robot("nao"), GaitSettings(), SETTINGS.control, tick=0.012
    )

    def open_body(scheme: Any) -> JointBody:
        names = scheme.kinematics.joint_names
        stance = scheme.joint_targets
        body: JointBody = until(lambda: _opened(url, names, stance))
        return body

    playing = JointLoop(open_body, Evasion(), make)
    try:
        while True:
            ticks.append(playing.tick())
    except SessionLost:
        playing.body.close()


def _opened(url: str, names: Any, stance: Any) -> JointBody | None:
    try:
        return open_joints(url, names, stance)
    except SessionLost:
        return None  # the world is being built


def test_in_lock_step_a_walk_is_the_one_played_in_one_process() -> None:
    """Calls carry no time, but frames their number, and both wait."""
    url = "tcp://127.0.0.1:29661"
    ticks: list[JointTick] = []
    player = Thread(target=client, args=(url, ticks))
    player.start()
    try:
        endpoints = {"evader": NaoqiJointsEndpoint(url)}
        over = serve_duel(SETTINGS, endpoints, lock_step=True)
    finally:
        player.join(60.0)
    assert not player.is_alive()
    served = over.to_json()
    alone = results_of(run_duel(SETTINGS))
    assert served["outcome"] == alone["outcome"] == "completed"
    for key in ("distance_m", "min_distance_m"):
        assert served[key] == pytest.approx(alone[key], abs=1e-6)
    assert any(tick.begun is not None for tick in ticks)
