"""Booster K1 driven by its joints, for ``stepaside play``.

A walking policy moves the legs (``legs.network``). Needs ``pip install
booster-robotics-sdk-python``, and a description of the K1 with joints in the
names below. Not tested on a robot: hang it up first.
"""

import os
from time import monotonic
from typing import Any

import numpy as np

import stepaside as sa

ADDRESS = os.environ.get("BOOSTER_ADDRESS", "127.0.0.1")
ARM = ("Shoulder_Pitch", "Shoulder_Roll", "Elbow_Pitch", "Elbow_Yaw")
LEG = (
    *("Hip_Pitch", "Hip_Roll", "Hip_Yaw"),
    *("Knee_Pitch", "Ankle_Pitch", "Ankle_Roll"),
)
JOINTS = (
    *("AAHead_yaw", "Head_pitch"),
    *("ALeft_Shoulder_Pitch", *(f"Left_{name}" for name in ARM[1:])),
    *("ARight_Shoulder_Pitch", *(f"Right_{name}" for name in ARM[1:])),
    *(f"{side}_{name}" for side in ("Left", "Right") for name in LEG),
)


class BoosterJoints(sa.JointRobot):
    """Robot in its custom mode, which takes a command for each joint."""

    tick, joints = 0.02, JOINTS
    gains = dict.fromkeys(JOINTS[:10], (4.0, 1.0))  # those of Booster's
    gains |= dict.fromkeys(JOINTS[10:], (80.0, 2.0))  # K1 deployment
    newest: sa.RobotState | None = None
    takes_joints = False

    def open(self) -> None:
        """Connect, without moving the robot."""
        import booster_robotics_sdk_python as booster

        self.booster = booster
        booster.ChannelFactory.Instance().Init(0, ADDRESS)
        self.client = booster.B1LocoClient()
        self.client.Init()
        if not self.client.WaitForService(2000):
            raise ConnectionError(f"no Booster answers at {ADDRESS}")
        self.states = booster.B1LowStateSubscriber(self.note)
        self.states.InitChannel()
        self.commands = booster.B1LowCmdPublisher()
        self.commands.InitChannel()
        self.message = booster.LowCmd()
        self.message.cmd_type = booster.LowCmdType.SERIAL
        self.message.resize_motor_cmd(len(JOINTS))

    def note(self, state: Any) -> None:
        """Store a message, which has no stamp; called by the SDK."""
        motors, imu = state.motor_state_serial, state.imu_state
        self.newest = sa.RobotState(
            monotonic(),
            np.array([motor.q for motor in motors]),
            np.array(imu.gyro),
            np.array(imu.acc),
            joint_velocities=np.array([motor.dq for motor in motors]),
            tilt=(imu.rpy[0], imu.rpy[1]),
        )

    def listen(self) -> sa.RobotState | None:
        """Return the newest state; add a sighting of your own detector."""
        return self.newest

    def command(self, targets: sa.JointTargets) -> None:
        """Command all joints."""
        if not self.takes_joints:
            self.client.ChangeMode(self.booster.RobotMode.kCustom)
            self.takes_joints = True
        rows = np.column_stack(targets).tolist()
        for number, (angle, stiffness, damping) in enumerate(rows):
            motor = self.message.motor_cmd_at(number)
            motor.q, motor.kp, motor.kd = angle, stiffness, damping
        self.commands.Write(self.message)

    def release(self) -> None:
        """Damp the joints: the robot sinks down."""
        self.client.ChangeMode(self.booster.RobotMode.kDamping)
        self.takes_joints = False

    def close(self) -> None:
        """Unsubscribe."""
        self.states.CloseChannel()
        self.commands.CloseChannel()
