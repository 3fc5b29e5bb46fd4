"""Estimation of the body's state from encoders, IMU and foot forces."""

from math import exp
from typing import NamedTuple

import numpy as np

from ...core.compilation import bound
from ...core.constants import GRAVITY
from ...core.poses import Array
from ...perception.attitude import AttitudeFilter
from ...perception.measurement import Measurement
from ...robots.forward_kinematics import ForwardKinematics, MeasuredPosture
from ...robots.leg_kinematics import BodyReference
from .estimator_kernel import STATE, VALUES, estimate

STANDS, TOUCHES = 0.2, 0.02  # least fractions of the weight on the feet
FALLEN = 0.7  # tilt of the torso that counts as a fall, in [rad]


class BodyState(NamedTuple):
    """Estimated state of the body, in odometry.

    Attributes:
        com: CoM (x, y), in [m].
        velocity: Its velocity, in [m/s].
        dcm: Divergent component of motion, in [m].
        zmp: Center of the foot forces, in [m].
        tilt: Roll and pitch of the torso, in [rad].
        rate: Angular velocity in the torso frame, in [rad/s].
        left_share: Fraction of the weight on the left foot, in [0, 1].
        weight: Sum of the foot forces, in [N].
    """

    com: tuple[float, float]
    velocity: tuple[float, float]
    dcm: tuple[float, float]
    zmp: tuple[float, float]
    tilt: tuple[float, float]
    rate: tuple[float, float, float]
    left_share: float
    weight: float

    @property
    def has_fallen(self) -> bool:
        """Whether the torso tilts beyond recovery."""
        return max(map(abs, self.tilt)) > FALLEN


class StateEstimator:
    """State estimator of one robot.

    The torso tilt comes from the IMU. The CoM follows from the tilt and
    the measured joints relative to the loaded feet, whose poses are those
    of odometry. A constant-gain observer of the linear inverted pendulum,
    driven by the measured ZMP, adds the velocity.

    Attributes:
        kinematics: Forward kinematics of the robot.
    """

    def __init__(
        self,
        kinematics: ForwardKinematics,
        force_sensors: Array,
        eta: float,
        tick: float,
        *,
        bandwidth: float = 40.0,
        correction: float = 0.5,
        bias_correction: float = 0.06,
    ) -> None:
        """Prepare an estimator.

        Args:
            kinematics: Forward kinematics of the robot.
            force_sensors: Positions of the force sensors in the foot frames,
                left then right, in [m]. Shape (8, 2).
            eta: Rate of the pendulum, in [1/s].
            tick: Control period, in [s].
            bandwidth: Bandwidth of the observer, in [rad/s].
            correction: Gain of the :class:`AttitudeFilter`, in [1/s].
            bias_correction: Gain of its bias, in [1/s^2].
        """
        self.kinematics = kinematics
        self._tick = tick
        weight = GRAVITY * kinematics.mass
        self._attitude = AttitudeFilter(correction, bias_correction)
        fade = exp(-bandwidth * tick)
        self._angles: Array | None = None  # of the last measurement
        self._values, self._state = np.zeros(VALUES), np.zeros(STATE)
        self._state[:2], self._state[13] = np.nan, 0.5
        self._estimate = bound(
            estimate,
            self._values,
            *(kinematics.com, kinematics.places, kinematics.axes),
            np.ascontiguousarray(force_sensors, dtype=np.float64),
            self._state,
            *(tick, eta, *self._attitude.gains, GRAVITY),
            # Two equal poles at the bandwidth.
            *(1.0 - fade * fade, (1.0 - fade) ** 2 / tick),
            *(TOUCHES * weight, STANDS * weight),
        )

    @property
    def posture(self) -> MeasuredPosture | None:
        """Last measured posture; None before the first."""
        if self._angles is None:
            return None
        return self.kinematics.posture(self._angles)

    @property
    def ready(self) -> bool:
        """Whether the robot has stood still long enough."""
        return self._attitude.ready

    @property
    def tilt(self) -> tuple[float, float]:
        """Roll and pitch of the torso, in [rad]."""
        return self._attitude.roll, self._attitude.pitch

    @property
    def torso_heading(self) -> float:
        """Heading of the torso in odometry over the loaded foot, in [rad]."""
        return float(self._state[15])

    def update(
        self,
        measurement: Measurement,
        feet: BodyReference,
        acceleration: tuple[float, float],
        reaction: tuple[float, float] = (0.0, 0.0),
    ) -> BodyState:
        """Estimate the state at one tick.

        Args:
            measurement: Measurement of the tick.
            feet: Body reference of the command that the measured motion
                executes, in odometry; its feet are used.
            acceleration: CoM acceleration of that command, in [m/s^2]. The
                estimated one would not do: through the lever of the CoM a
                wrong tilt explains its own acceleration.
            reaction: ZMP shift by the swing leg of that command, in [m].
        """
        self._angles = measurement.joint_positions
        values, state, attitude = self._values, self._state, self._attitude
        values[26] = attitude.ready
        if not attitude.ready:
            attitude.update(
                *(measurement.gyro, measurement.accelerometer),
                *((0.0, 0.0), self._tick),
            )
            state[8:10] = attitude.roll, attitude.pitch
            state[10:13], state[16:] = attitude.rate, attitude.bias
        self.kinematics.evaluate(measurement.joint_positions)
        values[:3], values[3:6] = measurement.gyro, measurement.accelerometer
        values[6:14] = measurement.foot_forces
        values[14:26] = (
            *feet.left_foot,
            *feet.right_foot,
            *acceleration,
            *reaction,
        )
        self._estimate()
        cx, cy, vx, vy, dx, dy, px, py, *others = state.tolist()
        roll, pitch, wx, wy, wz, share, weight, heading, _, _ = others
        attitude.roll, attitude.pitch = roll, pitch
        attitude.rate = wx, wy, wz
        return BodyState(
            (cx, cy),
            (vx, vy),
            (dx, dy),
            (px, py),
            (roll, pitch),
            (wx, wy, wz),
            share,
            weight,
        )
