"""Test a walking policy that drives a robot by targets and gains.

The robot is a simulated one that measures joint velocities and takes gains.
"""

from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

pytest.importorskip("onnxruntime")
pytest.importorskip("onnx")

from imitated_walk import nao_on_imitated_walk
from stepaside.core.errors import ModelError
from stepaside.core.poses import Pose
from stepaside.drivers.joint.frames import (
    Codec,
    JointCommand,
    JointFrame,
    MotorGains,
)
from stepaside.drivers.joint.joint_body import (
    JointBody,
    JointInterface,
    SystemClock,
)
from stepaside.drivers.joint.joint_loop import JointLoop
from stepaside.drivers.joint.joint_map import motors_of
from stepaside.drivers.joint.safety_state_machine import RobotState
from stepaside.drivers.scheme_factory import (
    policy_gains,
    policy_scheme_factory,
)
from stepaside.locomotion.policy.initial_posture import InitialPosture
from stepaside.locomotion.policy.legs_loader import load_policy
from stepaside.locomotion.policy.legs_settings import LegsSettings
from stepaside.perception.measurement import Sighting
from stepaside.planning import GaitSettings
from stepaside.robots.description import RobotDescription, load_robot
from stepaside.robots.forward_kinematics import ForwardKinematics
from stepaside.sim.physics_settings import PhysicsSettings
from stepaside.sim.servos import set_joint_gains
from stepaside.sim.simulated_robot import SimulatedRobot, motor_of
from stepaside.sim.world import World
from stepaside.strategies import Pursuit

TICK = 0.004  # [s]
GAIT = GaitSettings(
    speed=0.06,
    gain=0.2,
    stride=0.024,
    single_support=0.3,
    double_support=0.1,
    zmp_forward=0.0,
)


class GainsRobot:
    """Link to a simulated robot whose joints take targets and gains."""

    def __init__(
        self, description: RobotDescription, posture: InitialPosture
    ) -> None:
        self.now, self.chest_pressed = 0.0, False
        self.commands: list[JointCommand] = []
        self._frames: list[JointFrame] = []
        world = World({"robot": description}, PhysicsSettings(tick=TICK))
        start = Pose(0.0, 0.0, 0.0)
        self.robot = SimulatedRobot(
            world, "robot", description, posture, start, gains={}
        )
        mujoco.mj_forward(world.model, world.data)
        self.motors = motors_of(
            description, tick=TICK, crouch=description.standing
        )
        names = posture.joint_names
        self._order = [names.index(name) for name in self.motors.names]
        ids = [
            motor_of(world.model, world.model.joint(f"robot/{name}").id)
            for name in self.motors.names
        ]
        self._actuators = np.array(ids)
        model = world.model
        self.own = MotorGains(
            model.actuator_gainprm[ids, 0].copy(),
            -model.actuator_biasprm[ids, 2].copy(),
        )

    def clock(self) -> float:
        """Time, in [s]."""
        return self.now

    def wait(self, timeout: float) -> bool:
        """Produce the frame of the next tick."""
        self.now += TICK
        read = self.robot.read()
        assert read.joint_velocities is not None
        count = self.motors.count
        noise = 1e-3 * np.sin(self.now)  # no real sensor stands still
        frame = JointFrame(
            position=read.joint_positions[self._order],
            stiffness=np.ones(count),
            current=np.zeros(count),
            temperature=np.full(count, 30.0),
            status=(0,) * count,
            accelerometer=read.accelerometer + noise,
            gyroscope=read.gyro,
            angles=(0.0, 0.0),
            foot_forces=read.foot_forces,
            load=5.0,
            echoes={},
            chest_pressed=self.chest_pressed,
            bumper_pressed=False,
            charge=1.0,
            number=0.0,
            counted=False,
            lock_step=False,
            velocity=read.joint_velocities[self._order],
        )
        self._frames.append(frame)
        return True

    def receive(self) -> list[Any]:
        """Return the frame of the tick."""
        frames, self._frames = self._frames, []
        return frames

    def send(self, data: Any) -> None:
        """Apply targets and gains, and advance."""
        self.commands.append(data)
        gains = data.gains or self.own
        set_joint_gains(
            self.robot.world.model,
            self._actuators,
            self.motors.names,
            dict(
                zip(
                    self.motors.names,
                    zip(gains.stiffness, gains.damping, strict=True),
                    strict=True,
                )
            ),
        )
        if data.position is not None:
            targets = np.empty(self.motors.count)
            targets[self._order] = data.position
            self.robot.write(targets)
        self.robot.step()

    def close(self) -> None:
        """Do nothing."""


class AlwaysAhead:
    """Sight of an opponent half a metre ahead."""

    def newest(self, frame: int, start: int) -> Sighting | None:
        """Return the sighting of this frame."""
        return Sighting((frame - start) * TICK, 0.0, 0.5)

    def close(self) -> None:
        """Do nothing."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return nao_on_imitated_walk(tmp_path_factory.mktemp("joints") / "nao")


def test_a_policy_walks_a_robot_that_takes_targets_and_gains(
    folder: Path,
) -> None:
    description = load_robot(folder)
    legs = LegsSettings(str(folder / "policy.onnx"))
    contract, _ = load_policy(legs, description)
    angles = zip(contract.joints, contract.default_posture, strict=True)
    posture = InitialPosture(ForwardKinematics(description), dict(angles))
    link = GainsRobot(description, posture)
    gains = policy_gains(contract, link.motors, link.own)
    codec = Codec(lambda frame: frame, lambda command: command)
    stance = dict(zip(posture.joint_names, posture.joint_targets, strict=True))
    loop = JointLoop(
        lambda _: JointBody(
            JointInterface(link, link.motors, codec, gains),
            stance,
            sight=AlwaysAhead(),
            clock=SystemClock(link.clock, lambda duration: None),
        ),
        Pursuit(),
        policy_scheme_factory(description, legs, GAIT, tick=TICK),
    )
    while loop.body.state is not RobotState.READY:
        loop.tick()
        assert link.now < 6.0
    assert not any(command.gains for command in link.commands)
    for link.chest_pressed in (True, False):
        loop.tick()
    start = np.array(link.robot.truth.position_com_in_world)
    for _ in range(round(6.0 / TICK)):
        tick = loop.tick()
        assert tick.state is RobotState.WALKING, tick.words
    assert tick.walk is None
    sent = link.commands[-1].gains
    assert sent is not None
    at = link.motors.names.index("LKneePitch")
    assert (sent.stiffness[at], sent.damping[at]) == (200.0, 10.0)
    head = link.motors.names.index("HeadYaw")  # the policy does not move it
    assert sent.stiffness[head] == link.own.stiffness[head]
    moved = link.robot.truth.position_com_in_world - start
    assert 0.15 < moved[0] < 0.4
    assert abs(moved[1]) < 0.1


def test_a_robot_without_a_joint_of_the_policy_is_refused(
    folder: Path,
) -> None:
    description = load_robot(folder)
    legs = LegsSettings(str(folder / "policy.onnx"))
    contract, _ = load_policy(legs, description)
    motors = motors_of(description, tick=TICK, crouch={})
    fewer = type(motors)(
        *(motors.names[:2], motors.low[:2], motors.high[:2]),
        *(motors.speed[:2], motors.stall_current[:2], motors.legs[:0]),
        *({}, TICK),
    )
    own = MotorGains(np.ones(2), np.ones(2))
    with pytest.raises(ModelError, match="'LHipYawPitch' has no motor"):
        policy_gains(contract, fewer, own)
