"""Test the adapters of vendors' SDKs against stand-ins that note each call."""

import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from time import monotonic, sleep
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import Pose
from stepaside.drivers.method_thread import SessionLost
from stepaside.drivers.robot import JointTargets
from stepaside.drivers.robot_loader import load_robot_class
from stepaside.drivers.robot_session import RobotSession

ADAPTERS = Path(__file__).parents[2] / "examples" / "adapters"
BOOSTER = "booster_robotics_sdk_python"
WALK = (-0.2, 0.0, 0.4)


class Sdk:
    """Objects of an SDK: each call is noted, and has one answer."""

    def __init__(self) -> None:
        self.calls: list[tuple[Any, ...]] = []
        self.handlers: list[Callable[[Any], None]] = []
        self.answers: dict[str, Any] = {"Instance": self}

    def __getattr__(self, name: str) -> Callable[..., Any]:
        def call(*arguments: Any) -> Any:
            self.handlers += [a for a in arguments if callable(a)]
            self.calls.append((name, *arguments))
            return self.answers.get(name, self)

        return call

    def waits_for(self, call: tuple[Any, ...]) -> None:
        """Wait for a call, which another thread makes."""
        end = monotonic() + 20.0
        while call not in self.calls:
            assert monotonic() < end, self.calls
            sleep(0.005)


@pytest.fixture
def sdk() -> Sdk:
    return Sdk()


def adapter(name: str) -> Any:
    file, kind = ADAPTERS / name.partition(":")[0], name.partition(":")[2]
    return load_robot_class(f"{file}:{kind}")


def installed(
    monkeypatch: pytest.MonkeyPatch, name: str, **names: Any
) -> None:
    """Let a module and its parents be imported."""
    parts = name.split(".")
    for i in range(1, len(parts) + 1):
        module = ModuleType(".".join(parts[:i]))
        monkeypatch.setitem(sys.modules, module.__name__, module)
    vars(module).update(names)


@pytest.fixture
def booster(sdk: Sdk, monkeypatch: pytest.MonkeyPatch) -> type:
    sdk.answers |= {"Init": None, "Move": None}
    installed(
        monkeypatch,
        BOOSTER,
        ChannelFactory=sdk,
        B1LocoClient=lambda: sdk,
        B1OdometerStateSubscriber=sdk.Subscriber,
        RobotMode=SimpleNamespace(kPrepare="prepare", kWalking="walking"),
    )
    kind: type = adapter("booster_robot.py:BoosterRobot")
    monkeypatch.setattr(sys.modules[kind.__module__], "STANDING_UP", 0.0)
    return kind


def test_a_booster_walks_and_stands_by_its_client(
    booster: type, sdk: Sdk
) -> None:
    session = RobotSession(booster())
    session.run("prepare", 20.0)
    assert session.listen(0.05) is None
    began = monotonic()
    sdk.handlers[-1](SimpleNamespace(x=1.0, y=2.0, theta=0.3))
    report = session.listen(1.0)
    assert report is not None and report.pose == Pose(1.0, 2.0, 0.3)
    assert began <= report.time <= monotonic()
    session.command(partial(session.robot.command, *WALK))
    sdk.waits_for(("Move", *WALK))
    session.halt()
    sdk.waits_for(("Move", 0.0, 0.0, 0.0))
    session.close()
    assert ("Init", 0, "127.0.0.1") in sdk.calls
    modes = [call[1] for call in sdk.calls if call[0] == "ChangeMode"]
    assert modes == ["prepare", "walking"]
    assert sdk.calls[-2:] == [("Move", 0.0, 0.0, 0.0), ("CloseChannel",)]


def test_a_booster_that_does_not_answer_is_tried_again(
    booster: type, sdk: Sdk
) -> None:
    sdk.answers["WaitForService"] = False
    with pytest.raises(SessionLost, match="no Booster answers"):
        RobotSession(booster())


@pytest.mark.parametrize("code", [0, 3104])
def test_a_unitree_walks_by_velocities_that_time_out(
    code: int, sdk: Sdk, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An error code ends the session."""
    sdk.answers["SetVelocity"] = code
    name = "unitree_sdk2py"
    client = SimpleNamespace(LocoClient=lambda: sdk)
    state = SimpleNamespace(SportModeState_="SportModeState_")
    channel = SimpleNamespace(
        ChannelFactoryInitialize=sdk.initialize,
        ChannelSubscriber=sdk.ChannelSubscriber,
    )
    for path, module in (
        ("core.channel", channel),
        ("g1.loco.g1_loco_client", client),
        ("idl.unitree_go.msg.dds_", state),
    ):
        installed(monkeypatch, f"{name}.{path}", **vars(module))
    session = RobotSession(adapter("unitree_robot.py:UnitreeRobot")())
    session.run("prepare", 20.0)
    sdk.handlers[-1](
        SimpleNamespace(
            stamp=SimpleNamespace(sec=7, nanosec=500_000_000),
            position=[1.0, 2.0, 0.7],
            imu_state=SimpleNamespace(rpy=[0.0, 0.0, 0.3]),
        )
    )
    report = session.listen(1.0)
    assert report is not None and report.time == 7.5
    assert report.pose == Pose(1.0, 2.0, 0.3)
    session.command(partial(session.robot.command, *WALK))
    sdk.waits_for(("SetVelocity", *WALK, 0.6))
    assert not session.robot.keeps_walking
    if code:
        with pytest.raises(SessionLost, match="SetVelocity returned 3104"):
            while True:
                session.command(partial(session.robot.command, *WALK))
                sleep(0.01)
        with pytest.raises(SessionLost, match=r"stop\(\) of UnitreeRobot"):
            session.close()
        return
    session.close()
    topic = ("ChannelSubscriber", "rt/odommodestate", "SportModeState_")
    assert topic in sdk.calls
    assert sdk.calls[-2:] == [("SetVelocity", 0.0, 0.0, 0.0, 0.6), ("Close",)]


def test_booster_is_driven_by_its_joints(
    sdk: Sdk, monkeypatch: pytest.MonkeyPatch
) -> None:
    motor = SimpleNamespace(q=0.0, kp=0.0, kd=0.0)
    sdk.answers["motor_cmd_at"] = motor
    installed(
        monkeypatch,
        BOOSTER,
        ChannelFactory=sdk,
        B1LocoClient=lambda: sdk,
        B1LowStateSubscriber=sdk.Subscriber,
        B1LowCmdPublisher=lambda: sdk,
        LowCmd=lambda: sdk,
        LowCmdType=SimpleNamespace(SERIAL="serial"),
        RobotMode=SimpleNamespace(kCustom="custom", kDamping="damping"),
    )
    robot = adapter("booster_joints.py:BoosterJoints")()
    robot.open()
    assert robot.listen() is None
    motors = [SimpleNamespace(q=0.1 * i, dq=-0.1 * i) for i in range(22)]
    imu = SimpleNamespace(gyro=[1, 2, 3], acc=[0, 0, 9.8], rpy=[0.1, 0.2, 3])
    sdk.handlers[0](SimpleNamespace(motor_state_serial=motors, imu_state=imu))
    report = robot.listen()
    assert report.tilt == (0.1, 0.2)
    assert robot.joints[21] == "Right_Ankle_Roll"
    assert report.joint_positions[21] == pytest.approx(2.1)
    assert report.joint_velocities[10] == pytest.approx(-1.0)
    targets = JointTargets(*np.ones((3, 22)))
    for array, value in zip(targets, (0.3, 30.0, 2.0), strict=True):
        array[21] = value
    robot.command(targets)
    assert (motor.q, motor.kp, motor.kd) == (0.3, 30.0, 2.0)
    assert sdk.calls[-1][0] == "Write"
    robot.release()
    modes = [call[1] for call in sdk.calls if call[0] == "ChangeMode"]
    assert modes == ["custom", "damping"]
