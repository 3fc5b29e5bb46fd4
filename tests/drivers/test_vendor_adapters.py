"""Test the adapters of vendors' SDKs against stubs of their signatures.

The stubs have the published names and arguments: Booster's of
``booster-robotics-sdk-python`` 1.6, Unitree's of ``unitree_sdk2_python``.
Where Booster's package or ``unitree-sdk2py-dimos``, which packs Unitree's, is
installed, its real types are compared.
"""

import sys
from collections.abc import Callable
from functools import partial
from importlib import import_module
from inspect import getmembers, isfunction, signature
from pathlib import Path
from time import monotonic, sleep
from types import ModuleType, SimpleNamespace
from typing import Any, ClassVar

import numpy as np
import pytest

from stepaside.core.poses import Pose
from stepaside.drivers.method_thread import SessionLost
from stepaside.drivers.robot import JointRobot, JointTargets, VelocityRobot
from stepaside.drivers.robot_loader import load_robot_class
from stepaside.drivers.robot_session import RobotSession

ADAPTERS = Path(__file__).parents[2] / "examples" / "adapters"
WALK = (-0.2, 0.0, 0.4)
CALLS: list[tuple[Any, ...]] = []


def adapter(name: str) -> type[VelocityRobot]:
    file = ADAPTERS / f"{name.lower()}_robot.py"
    kind = load_robot_class(f"{file}:{name}Robot")
    assert issubclass(kind, VelocityRobot)
    return kind


def waits_for(call: tuple[Any, ...]) -> None:
    end = monotonic() + 20.0
    while call not in CALLS:
        assert monotonic() < end, CALLS
        sleep(0.005)


@pytest.fixture(autouse=True)
def no_calls() -> None:
    CALLS.clear()


class ChannelFactory:
    """Stub of Booster's."""

    @staticmethod
    def Instance() -> "ChannelFactory":
        """Return the only one."""
        return ChannelFactory()

    def Init(self, domain_id: int, network_interface: str = "") -> None:
        """Note the call."""
        CALLS.append(("Init", domain_id, network_interface))


class B1LocoClient:
    """Stub of Booster's."""

    answers: ClassVar[bool] = True

    def Init(self) -> None:
        """Do nothing."""

    def WaitForService(self, timeout_ms: int = 5000) -> bool:
        """Answer as the test wants."""
        return self.answers

    def ChangeMode(self, mode: Any) -> None:
        """Note the call."""
        CALLS.append(("ChangeMode", mode))

    def Move(self, vx: float, vy: float, vyaw: float) -> None:
        """Note the call."""
        CALLS.append(("Move", vx, vy, vyaw))


class B1OdometerStateSubscriber:
    """Stub of Booster's."""

    made: ClassVar["list[B1OdometerStateSubscriber]"] = []

    def __init__(self, handler: Callable[[Any], None]) -> None:
        self.handler = handler
        self.made.append(self)

    def InitChannel(self) -> None:
        """Do nothing."""

    def CloseChannel(self) -> None:
        """Note the call."""
        CALLS.append(("CloseChannel",))


STUBS = (ChannelFactory, B1LocoClient, B1OdometerStateSubscriber)
MODES = SimpleNamespace(kPrepare="prepare", kWalking="walking")


@pytest.fixture
def booster(monkeypatch: pytest.MonkeyPatch) -> RobotSession:
    """Connect to a stub, whose odometer sends one message."""
    sdk = ModuleType("booster_robotics_sdk_python")
    vars(sdk).update({stub.__name__: stub for stub in STUBS}, RobotMode=MODES)
    monkeypatch.setitem(sys.modules, sdk.__name__, sdk)
    kind = adapter("Booster")
    monkeypatch.setattr(sys.modules[kind.__module__], "STANDING_UP", 0.0)
    session = RobotSession(kind())
    session.run("prepare", 20.0)
    return session


def test_a_booster_walks_and_stands_by_its_client(
    booster: RobotSession,
) -> None:
    assert booster.listen(0.05) is None
    odometer = SimpleNamespace(x=1.0, y=2.0, theta=0.3)
    B1OdometerStateSubscriber.made[-1].handler(odometer)
    report = booster.listen(1.0)
    assert report is not None and report.pose == Pose(1.0, 2.0, 0.3)
    assert abs(report.time - monotonic()) < 5.0
    booster.command(partial(booster.robot.command, *WALK))
    waits_for(("Move", -0.2, 0.0, 0.4))
    booster.halt()
    waits_for(("Move", 0.0, 0.0, 0.0))
    booster.close()
    assert CALLS[:3] == [
        ("Init", 0, "127.0.0.1"),
        ("ChangeMode", "prepare"),
        ("ChangeMode", "walking"),
    ]
    assert CALLS[-2:] == [("Move", 0.0, 0.0, 0.0), ("CloseChannel",)]


def test_a_booster_that_does_not_answer_is_tried_again(
    booster: RobotSession, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(B1LocoClient, "answers", False)
    with pytest.raises(SessionLost, match="no Booster answers"):
        RobotSession(adapter("Booster")())


def test_boosters_package_has_what_the_adapter_uses() -> None:
    sdk = pytest.importorskip(
        "booster_robotics_sdk_python",
        reason="pip install booster-robotics-sdk-python",
    )
    for stub in STUBS:
        real = getattr(sdk, stub.__name__)
        for name, _ in getmembers(stub, isfunction):
            assert callable(getattr(real, name)), (stub, name)
    for mode in vars(MODES):
        assert getattr(sdk.RobotMode, mode) is not None
    odometer = sdk.Odometer()
    odometer.x, odometer.y, odometer.theta = 1.0, 2.0, 0.25
    robot = adapter("Booster")()
    getattr(robot, "note")(odometer)  # noqa: B009
    report = robot.listen()
    assert report is not None and report.pose == Pose(1.0, 2.0, 0.25)
    three_numbers = sdk.B1LocoClient.Move.__doc__
    assert three_numbers.count("SupportsFloat") == 3
    assert "handler" in sdk.B1OdometerStateSubscriber.__init__.__doc__


class LocoClient:
    """Stub of Unitree's."""

    code: ClassVar[int] = 0

    def SetTimeout(self, timeout: float) -> None:
        """Note the call."""
        CALLS.append(("SetTimeout", timeout))

    def Init(self) -> None:
        """Do nothing."""

    def Start(self) -> None:
        """Note the call."""
        CALLS.append(("Start",))

    def SetVelocity(
        self, vx: float, vy: float, omega: float, duration: float = 1.0
    ) -> int:
        """Note the call."""
        CALLS.append(("SetVelocity", vx, vy, omega, duration))
        return self.code


class ChannelSubscriber:
    """Stub of Unitree's."""

    made: ClassVar["list[ChannelSubscriber]"] = []

    def __init__(self, name: str, type: Any) -> None:
        CALLS.append(("ChannelSubscriber", name, type))
        self.made.append(self)

    def Init(self, handler: Callable[[Any], None], queueLen: int = 0) -> None:
        """Store the handler."""
        self.handler = handler

    def Close(self) -> None:
        """Note the call."""
        CALLS.append(("Close",))


def initialize(id: int = 0, networkInterface: str | None = None) -> None:
    CALLS.append(("ChannelFactoryInitialize", id, networkInterface))


@pytest.fixture
def unitree(monkeypatch: pytest.MonkeyPatch) -> RobotSession:
    """Connect to a stub."""
    contents: dict[str, dict[str, Any]] = {
        "": {},
        ".core": {},
        ".core.channel": {
            "ChannelFactoryInitialize": initialize,
            "ChannelSubscriber": ChannelSubscriber,
        },
        ".g1": {},
        ".g1.loco": {},
        ".g1.loco.g1_loco_client": {"LocoClient": LocoClient},
        ".idl": {},
        ".idl.unitree_go": {},
        ".idl.unitree_go.msg": {},
        ".idl.unitree_go.msg.dds_": {"SportModeState_": "SportModeState_"},
    }
    for name, names in contents.items():
        module = ModuleType(f"unitree_sdk2py{name}")
        vars(module).update(names)
        monkeypatch.setitem(sys.modules, module.__name__, module)
    session = RobotSession(adapter("Unitree")())
    session.run("prepare", 20.0)
    return session


def test_a_unitree_walks_by_velocities_that_time_out(
    unitree: RobotSession,
) -> None:
    state = SimpleNamespace(
        stamp=SimpleNamespace(sec=7, nanosec=500_000_000),
        position=[1.0, 2.0, 0.7],
        imu_state=SimpleNamespace(rpy=[0.0, 0.0, 0.3]),
    )
    ChannelSubscriber.made[-1].handler(state)
    report = unitree.listen(1.0)
    assert report is not None and report.time == 7.5
    assert report.pose == Pose(1.0, 2.0, 0.3)
    unitree.command(partial(unitree.robot.command, *WALK))
    waits_for(("SetVelocity", -0.2, 0.0, 0.4, 0.6))
    unitree.close()
    assert (
        "ChannelSubscriber",
        "rt/odommodestate",
        "SportModeState_",
    ) in CALLS
    assert CALLS[-2:] == [("SetVelocity", 0.0, 0.0, 0.0, 0.6), ("Close",)]
    assert not adapter("Unitree").keeps_walking


@pytest.mark.parametrize("model", ["g1", "h1"])
def test_calls_and_state_of_unitrees_own_sdk_fit(model: str) -> None:
    pytest.importorskip("unitree_sdk2py")
    client = import_module(f"unitree_sdk2py.{model}.loco.{model}_loco_client")
    ours = signature(LocoClient.SetVelocity)
    theirs = signature(client.LocoClient.SetVelocity)
    assert list(theirs.parameters) == list(ours.parameters)
    for name in ("Init", "SetTimeout", "Start"):
        assert callable(getattr(client.LocoClient, name))
    from unitree_sdk2py.idl.default import (
        unitree_go_msg_dds__SportModeState_ as make_state,
    )

    state = make_state()
    state.stamp.sec, state.stamp.nanosec = 7, 250_000_000
    state.position[:2], state.imu_state.rpy[2] = [1.0, 2.0], 0.3
    robot: Any = adapter("Unitree")()
    robot.note(state)
    report = robot.listen()
    assert report.time == 7.25 and report.pose == Pose(1.0, 2.0, 0.3)


def test_an_error_code_of_a_unitree_ends_the_session(
    unitree: RobotSession, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(LocoClient, "code", 3104)
    unitree.command(partial(unitree.robot.command, *WALK))
    waits_for(("SetVelocity", -0.2, 0.0, 0.4, 0.6))
    sleep(0.1)
    with pytest.raises(SessionLost, match="SetVelocity returned 3104"):
        unitree.command(partial(unitree.robot.command, *WALK))
    with pytest.raises(SessionLost, match=r"stop\(\) of UnitreeRobot"):
        unitree.close()


class JointCommands:
    """Stub of Booster's publisher."""

    def InitChannel(self) -> None:
        """Do nothing."""

    def Write(self, message: Any) -> bool:
        """Note the last leg's target and gains."""
        motor = message.motor_cmd_at(21)
        CALLS.append(("Write", motor.q, motor.kp, motor.kd))
        return True


class LowCmd:
    """Stub of Booster's message."""

    cmd_type = ""

    def resize_motor_cmd(self, count: int) -> None:
        """Make empty commands."""
        self.motors = [SimpleNamespace(q=0.0, kp=0.0, kd=0.0)] * count

    def motor_cmd_at(self, number: int) -> Any:
        """Return one command."""
        return self.motors[number]


def test_booster_is_driven_by_its_joints(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    states: list[Callable[[Any], None]] = []

    def subscriber(note: Callable[[Any], None]) -> Any:
        states.append(note)
        return SimpleNamespace(InitChannel=lambda: None)

    name = "booster_robotics_sdk_python"
    stub = ModuleType(name)
    vars(stub).update(
        ChannelFactory=ChannelFactory,
        B1LocoClient=B1LocoClient,
        B1LowStateSubscriber=subscriber,
        B1LowCmdPublisher=JointCommands,
        LowCmd=LowCmd,
        LowCmdType=SimpleNamespace(SERIAL="serial"),
        RobotMode=SimpleNamespace(kCustom="custom", kDamping="damping"),
    )
    monkeypatch.setitem(sys.modules, name, stub)
    kind = load_robot_class(f"{ADAPTERS / 'booster_joints.py'}:BoosterJoints")
    assert issubclass(kind, JointRobot)
    robot = kind()
    robot.open()
    assert robot.listen() is None
    motors = [SimpleNamespace(q=0.1 * i, dq=-0.1 * i) for i in range(22)]
    imu = SimpleNamespace(gyro=[1, 2, 3], acc=[0, 0, 9.8], rpy=[0.1, 0.2, 3])
    states[0](SimpleNamespace(motor_state_serial=motors, imu_state=imu))
    report = robot.listen()
    assert report is not None and report.tilt == (0.1, 0.2)
    assert robot.joints[21] == "Right_Ankle_Roll"
    assert report.joint_positions[21] == pytest.approx(2.1)
    assert report.joint_velocities is not None
    assert report.joint_velocities[10] == pytest.approx(-1.0)
    targets = JointTargets(*np.ones((3, 22)))
    for array, value in zip(targets, (0.3, 30.0, 2.0), strict=True):
        array[21] = value
    robot.command(targets)
    robot.command(targets)
    robot.release()
    assert CALLS[1:] == [
        ("ChangeMode", "custom"),
        ("Write", 0.3, 30.0, 2.0),
        ("Write", 0.3, 30.0, 2.0),
        ("ChangeMode", "damping"),
    ]
