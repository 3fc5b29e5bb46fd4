"""Test that joint control is independent of NAO and of the protocol."""

import ast
from collections import deque
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stepaside.drivers.joint
from stepaside.drivers.joint.frames import Codec, JointCommand, JointFrame
from stepaside.drivers.joint.joint_body import (
    JointBody,
    JointInterface,
    SystemClock,
)
from stepaside.drivers.joint.joint_map import JointMap, MotorTable, motors_of
from stepaside.drivers.joint.safety_state_machine import RobotState
from stepaside.robots.description import load_robot

FILES = sorted(Path(stepaside.drivers.joint.__file__).parent.glob("*.py"))
TICK = 0.02  # [s], unlike NAO's
MOTORS = MotorTable(
    ("hip", "knee", "neck"),
    low=np.array([-1.0, 0.0, -2.0]),
    high=np.array([1.0, 2.0, 2.0]),
    speed=np.array([4.0, 4.0, 0.25]),
    stall_current=np.full(3, np.inf),
    legs=np.array([0, 1]),
    crouch={"knee": 1.5},
    tick=TICK,
)
STANCE = np.array([0.6, -0.2])  # [rad], of knee and hip


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_joint_control_imports_no_protocol(file: Path) -> None:
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            parts = set((node.module or "").split("."))
            parts |= {alias.name for alias in node.names}
            assert not parts & {"lola", "naoqi", "ros2", "msgpack", "qi"}


class MotorLink:
    """Link to motors that follow their targets at once."""

    def __init__(self) -> None:
        self.position = np.zeros(3)
        self.stiffness = np.zeros(3)
        self.commands: list[JointCommand] = []
        self.now = 0.0
        self.chest_pressed = False
        self.frames: deque[JointFrame] = deque()

    def clock(self) -> float:
        """Time, in [s]."""
        return self.now

    def wait(self, timeout: float) -> bool:
        """Advance by one tick, and produce its frame."""
        self.now += TICK
        frame = JointFrame(
            position=self.position,
            stiffness=self.stiffness,
            current=np.ones(3),
            temperature=np.full(3, 30.0),
            status=(0, 0, 0),
            accelerometer=np.array([0.0, 0.0, 9.81 + 0.01 * np.sin(self.now)]),
            gyroscope=np.zeros(3),
            angles=(0.0, 0.0),
            foot_forces=np.full(8, 6.0),
            load=5.0,
            echoes={},
            chest_pressed=self.chest_pressed,
            bumper_pressed=False,
            charge=1.0,
            number=0.0,
            counted=False,
            lock_step=False,
        )
        self.frames.append(frame)
        return True

    def receive(self) -> list[Any]:
        """Return the frame of the tick."""
        frames = list(self.frames)
        self.frames.clear()
        return frames

    def send(self, data: Any) -> None:
        """Move the motors to their targets."""
        self.commands.append(data)
        if data.position is not None:
            self.position = data.position.copy()
        self.stiffness = data.stiffness

    def close(self) -> None:
        """Do nothing."""


def body_on(link: MotorLink) -> JointBody:
    return JointBody(
        JointInterface(
            link,
            MOTORS,
            Codec(lambda frame: frame, lambda command: command),
        ),
        dict(zip(("knee", "hip"), STANCE, strict=True)),
        clock=SystemClock(link.clock, lambda duration: None),
    )


def state_of(body: JointBody) -> RobotState:
    """Return the state now: type checkers assume that it does not change."""
    return body.state


def play(body: JointBody, ticks: int, targets: np.ndarray) -> None:
    for _ in range(ticks):
        body.read()
        body.write(targets)


def test_a_robot_with_other_joints_takes_its_stance_and_walks() -> None:
    link = MotorLink()
    body = body_on(link)
    play(body, 150, STANCE)
    assert state_of(body) is RobotState.READY
    np.testing.assert_allclose(link.position, [-0.2, 0.6, 0.0], atol=0.02)
    for pressed in (True, False):
        link.chest_pressed = pressed
        play(body, 1, STANCE)
    wanted = np.array([0.8, 5.0])  # the hip's limit is 1 rad
    play(body, 60, wanted)
    assert state_of(body) is RobotState.WALKING
    assert 0.9 < link.position[0] < 1.0
    assert link.position[1] == pytest.approx(0.8)
    np.testing.assert_allclose(
        body.read().joint_positions, link.position[[1, 0]]
    )
    body.rest("test")
    body.halted()
    play(body, 200, STANCE)
    assert state_of(body) is RobotState.LIMP
    assert link.position[1] == pytest.approx(1.5)
    assert not link.stiffness.any()


def test_targets_change_no_faster_than_the_motors_of_the_robot() -> None:
    link = MotorLink()
    body = body_on(link)
    link.position = np.array([0.9, 1.9, 1.9])
    play(body, 150, STANCE)
    targets = np.array(
        [c.position for c in link.commands if c.position is not None]
    )
    speeds = np.abs(np.diff(targets, axis=0)) / TICK
    assert np.all(speeds <= np.minimum(MOTORS.speed, 0.5) + 1e-9)


def test_the_motors_of_a_described_robot_have_its_joints_and_limits() -> None:
    robot = load_robot("nao")
    motors = motors_of(robot, tick=TICK, crouch=robot.standing)
    assert motors.names == tuple(robot.speed_limits)
    assert motors.speed.tolist() == list(robot.speed_limits.values())
    legs = [motors.names[leg] for leg in motors.legs]
    assert legs == [leg for leg in robot.legs if leg in robot.speed_limits]
    values = np.arange(motors.count, dtype=float)
    joints = JointMap(motors.names[::-1], motors)
    np.testing.assert_array_equal(joints.from_motors(values), values[::-1])
