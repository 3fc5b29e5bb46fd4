"""Learned legs of one robot: a body velocity in, joint targets out."""

from math import cos, isnan, sin

import numpy as np

from ...core.errors import PolicyError
from ...core.poses import Array, Pose
from ...perception.attitude import AttitudeFilter
from ...perception.measurement import Measurement
from ...robots.description import RobotDescription
from ...robots.forward_kinematics import ForwardKinematics
from .contract import CommandRanges, PolicyContract
from .initial_posture import InitialPosture
from .leg_odometry import LegOdometry
from .network import PolicyNetwork
from .runner import BodyMotion, PolicyRunner
from .velocity_response import STILL, BodyVelocity, VelocityResponse

CORRECTION = 0.5  # of the attitude filter by the accelerometer, in [1/s]
TURN_LEARNING = 0.2  # integral gain of the turning rate, in [1/s]
TURN_BOUND = 0.3  # greatest learned correction, in [rad/s]


class PolicyLegs:
    """Walking policy on the sensors of one robot.

    The policy runs at its own period, which is a multiple of the control
    tick. Its command is the inverse of the measured response; the remaining
    error of the turning rate is learned from the gyro while it walks.

    Attributes:
        contract: Contract of the network.
        response: Response of the legs to commands.
        standing: Posture in which the robot begins.
        odometry: Odometry of the robot.
        joint_targets: Joint targets of this tick, in [rad], in the order of
            the motors. Shape (joints,).
        command: Command of the policy at this tick.
        intended: Intended velocity at this tick.
    """

    def __init__(
        self,
        contract: PolicyContract,
        network: PolicyNetwork,
        description: RobotDescription,
        *,
        tick: float,
        response: VelocityResponse | None = None,
        learns_turns: bool = True,
    ) -> None:
        """Begin in the default posture.

        Args:
            contract: Contract of the network.
            network: The network.
            description: Description of the robot.
            tick: Control period, in [s].
            response: Measured response; by default commands are delivered.
            learns_turns: Whether the turning rate is corrected by the gyro.

        Raises:
            PolicyError: If the period of the policy is no multiple of the
                tick.
        """
        ratio = contract.period / tick
        if round(ratio) < 1 or abs(ratio - round(ratio)) > 1e-6:
            raise PolicyError(
                f"legs: tick must divide the period of the policy, "
                f"{contract.period:g} [s], got {tick:g}"
            )
        self._every, self._tick = round(ratio), tick
        self.contract = contract
        self.response = response or VelocityResponse.ideal(
            contract.command_ranges
        )
        forward = ForwardKinematics(description)
        motors = forward.tree.motors
        self._joints = np.array([motors.index(n) for n in contract.joints])
        angles = zip(contract.joints, contract.default_posture, strict=True)
        self.standing = InitialPosture(forward, dict(angles))
        self.joint_targets = self.standing.joint_targets
        self._runner = PolicyRunner(contract, network)
        self._attitude = AttitudeFilter(CORRECTION, 0.0)
        self.odometry = LegOdometry(forward)
        self.command = self.intended = STILL
        self._learns_turns = learns_turns
        self._correction = 0.0  # of the turning rate, in [rad/s]
        self._bias, self._readings = 0.0, 0
        self._turned, self._ticks = 0.0, 0

    @property
    def ready(self) -> bool:
        """Whether it has stood long enough to calibrate the gyro."""
        return self._attitude.ready

    @property
    def pose(self) -> Pose:
        """Pose of the torso in odometry."""
        x, y, theta = self.odometry.pose
        return Pose(x, y, theta + self._turned)

    @property
    def tilt(self) -> tuple[float, float]:
        """Roll and pitch of the torso, in [rad]."""
        return self._attitude.roll, self._attitude.pitch

    @property
    def limits(self) -> CommandRanges:
        """Least and greatest velocity along each axis alone."""
        return self.response.limits

    def update(
        self, measurement: Measurement, velocity: BodyVelocity
    ) -> Array:
        """Run one control tick.

        Args:
            measurement: Measurement of the tick, with joint velocities.
            velocity: Intended velocity; the nearest deliverable one with the
                same path is walked.

        Returns:
            Joint targets, in [rad], in the order of the motors.

        Raises:
            PolicyError: If the network returns NaN or infinity.
        """
        self.intended = self.response.nearest(velocity)
        rate = self._note_imu(measurement)
        self._turned += rate * self._tick
        if self._ticks % self._every == 0:
            self._decide(measurement)
        self._ticks += 1
        return self.joint_targets

    def _note_imu(self, measurement: Measurement) -> float:
        """Update attitude and turning; return the turning rate, [rad/s]."""
        wz = float(measurement.gyro[2])
        wz = 0.0 if isnan(wz) else wz
        if not self.ready:
            self._readings += 1
            self._bias += (wz - self._bias) / self._readings
            rate = 0.0
        else:
            rate = wz - self._bias
        ahead, left, _ = self.odometry.velocity.tolist()
        self._attitude.update(
            measurement.gyro,
            measurement.accelerometer,
            (-left * rate, ahead * rate),
            self._tick,
        )
        return rate

    def _decide(self, measurement: Measurement) -> None:
        """Run the policy at its own period."""
        period = self.contract.period
        attitude = self._attitude
        roll, pitch = attitude.roll, attitude.pitch
        turned, self._turned = self._turned, 0.0
        self.odometry.update(measurement, (roll, pitch), turned, period)
        walks = self.intended != STILL
        if self._learns_turns and walks:
            error = self.intended.turn * period - turned
            correction = self._correction + TURN_LEARNING * error
            self._correction = min(max(correction, -TURN_BOUND), TURN_BOUND)
        self.command = STILL
        if walks:
            turn = self.intended.turn + self._correction
            self.command = self.response.command_for(
                self.intended._replace(turn=turn)
            )
        velocities = measurement.joint_velocities
        assert velocities is not None
        gravity = (
            sin(pitch),
            -cos(pitch) * sin(roll),
            -cos(pitch) * cos(roll),
        )
        motion = BodyMotion(
            measurement.joint_positions[self._joints],
            velocities[self._joints],
            np.array(measurement.gyro),
            np.array(gravity),
            self.odometry.velocity,
        )
        targets = self.joint_targets.copy()
        targets[self._joints] = self._runner.update(
            motion, np.array(self.command)
        )
        self.joint_targets = targets
