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
from stepaside.drivers.joint_loop import JointLoop
from stepaside.drivers.joint_motion import motors_of
from stepaside.drivers.robot import JointRobot, JointTargets
from stepaside.drivers.safety import SafetyState
from stepaside.drivers.scheme_factory import policy_gains, scheme_factory
from stepaside.locomotion.control_settings import LegsSettings
from stepaside.locomotion.policy.policy_legs import (
    InitialPosture,
    initial_posture,
    load_policy,
)
from stepaside.perception.measurement import Sighting
from stepaside.planning import GaitSettings
from stepaside.robots.description import RobotDescription, load_robot
from stepaside.robots.forward_kinematics import ForwardKinematics
from stepaside.sim.physics_settings import PhysicsSettings
from stepaside.sim.servos import set_joint_gains
from stepaside.sim.simulated_robot import SimulatedRobot
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


class GainsRobot(JointRobot):
    """Simulated robot whose joints take targets and gains; and its session."""

    tick, stands, halted = TICK, False, True

    def __init__(
        self, description: RobotDescription, posture: InitialPosture
    ) -> None:
        self.now, self.commands = 0.0, 0
        world = World({"robot": description}, PhysicsSettings(tick=TICK))
        start = Pose(0.0, 0.0, 0.0)
        self.simulated = SimulatedRobot(
            world, "robot", description, posture, start, gains={}
        )
        mujoco.mj_forward(world.model, world.data)
        self.joints = posture.joint_names
        moved = world.model.actuator_trnid[:, 0].tolist()
        ids = [
            moved.index(world.model.joint(f"robot/{name}").id)
            for name in self.joints
        ]
        self._actuators, model = np.array(ids), world.model
        own = zip(
            model.actuator_gainprm[ids, 0].tolist(),
            (-model.actuator_biasprm[ids, 2]).tolist(),
            strict=True,
        )
        self.gains: dict[str, tuple[float, float]] = dict(
            zip(self.joints, own, strict=True)
        )
        self.sent: list[JointTargets] = []
        self.robot: Any = self  # of the session

    def listen(self, patience: float = 0.0) -> Any:
        """Produce the report of the next tick."""
        self.now += TICK
        read = self.simulated.read()
        noise = 1e-3 * np.sin(self.now)  # no real sensor stands still
        report = read._replace(
            time=self.now,
            accelerometer=read.accelerometer + noise,
            sighting=Sighting(self.now, 0.0, 0.5),
            tilt=(0.0, 0.0),
        )
        return report

    def command(self, call: Any) -> None:
        """Apply targets and gains."""
        if isinstance(call, JointTargets):
            return
        (targets,) = call.args
        self.sent.append(targets)
        pairs = zip(targets.stiffness, targets.damping, strict=True)
        set_joint_gains(
            self.simulated.world.model,
            self._actuators,
            self.joints,
            dict(zip(self.joints, pairs, strict=True)),
        )
        self.simulated.write(targets.angles)

    def name_of(self, method: str) -> str:
        """Return the name of a method."""
        return method

    def released(self) -> str:
        """Have no switch."""
        return ""

    def attend(self) -> None:
        """Have no guardian."""

    def check_blocked(self) -> None:
        """Return at once."""

    def tell(self, method: str, call: Any) -> None:
        """Show nothing."""

    def halt(self) -> None:
        """Stand as placed."""

    release = halt


@pytest.mark.slow
def test_a_policy_walks_a_robot_that_takes_targets_and_gains(
    tmp_path: Path,
) -> None:
    folder = nao_on_imitated_walk(tmp_path / "nao")
    description = load_robot(folder)
    legs = LegsSettings(str(folder / "policy.onnx"))
    contract, _ = load_policy(legs, description)
    angles = zip(contract.joints, contract.default_posture, strict=True)
    posture = initial_posture(ForwardKinematics(description), dict(angles))
    robot = GainsRobot(description, posture)
    motors = motors_of(robot, description)
    with pytest.raises(ModelError, match="'LHipYawPitch' has no motor"):
        policy_gains(contract, motors._replace(names=motors.names[:2]))
    gains = policy_gains(contract, motors)
    made: Any = robot
    loop = JointLoop(
        lambda: made,
        motors,
        Pursuit(),
        scheme_factory(description, GAIT, legs, tick=TICK),
        gains=gains,
        clock=lambda: robot.now,
        pause=lambda duration: None,
    )
    while loop.state is not SafetyState.READY:
        loop.tick()
        robot.simulated.step()
        assert robot.now < 6.0
    at = robot.joints.index("LKneePitch")
    own = robot.sent[-1].stiffness[at], robot.sent[-1].damping[at]
    assert own == robot.gains["LKneePitch"]
    start = np.array(robot.simulated.truth.position_com_in_world)
    for _ in range(round(6.0 / TICK)):
        tick = loop.tick()
        robot.simulated.step()
    assert tick.state is SafetyState.WALKING, tick.words
    assert np.isnan(tick.row["com_reference"]).all()
    sent = robot.sent[-1]
    assert (sent.stiffness[at], sent.damping[at]) == (200.0, 10.0)
    head = robot.joints.index("HeadYaw")  # the policy does not move it
    assert sent.stiffness[head] == robot.gains["HeadYaw"][0]
    moved = robot.simulated.truth.position_com_in_world - start
    assert 0.15 < moved[0] < 0.4
    assert abs(moved[1]) < 0.1
