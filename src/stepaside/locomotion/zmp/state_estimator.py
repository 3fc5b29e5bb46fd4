"""Estimation of the body's state from encoders, IMU and foot forces."""

from math import atan2, cos, exp, sin
from typing import NamedTuple

import numpy as np

from ...core.constants import GRAVITY
from ...core.machine_code import BoundKernel
from ...core.poses import Array
from ...perception.attitude import AttitudeFilter
from ...perception.measurement import Measurement
from ...robots.forward_kinematics import ForwardKinematics, MeasuredPosture
from ...robots.leg_kinematics import BodyReference
from .estimator_kernel import STATE, VALUES, estimator_kernel

Vector = tuple[float, float]
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
        self._sensors = force_sensors
        self._weight = GRAVITY * kinematics.mass
        self._eta, self._tick = eta, tick
        self._attitude = AttitudeFilter(correction, bias_correction)
        fade = exp(-bandwidth * tick)
        # Two equal poles at the bandwidth.
        self._position_gain = 1.0 - fade * fade
        self._velocity_gain = (1.0 - fade) ** 2 / tick
        self._angles: Array | None = None  # of the last measurement
        self._com: Vector | None = None
        self._velocity: Vector = (0.0, 0.0)
        self._share = 0.5
        self._heading = 0.0
        self._posture_kernel: BoundKernel | None = None
        self._kernel: BoundKernel | None = None
        if isinstance(kinematics, ForwardKinematics):
            self._bind(kinematics)

    def _bind(self, kinematics: ForwardKinematics) -> None:
        """Prepare the estimation as machine code, if it is used."""
        self._posture_kernel = kinematics.compiled
        loop = estimator_kernel() if self._posture_kernel else None
        if loop is None:
            return
        self._values, self._state = np.zeros(VALUES), np.zeros(STATE)
        self._kernel = loop.bind(
            self._values,
            kinematics.numbers,
            np.ascontiguousarray(self._sensors, dtype=np.float64),
            self._state,
            self._tick,
            self._eta,
            *self._attitude.gains,
            GRAVITY,
            self._position_gain,
            self._velocity_gain,
            TOUCHES * self._weight,
            STANDS * self._weight,
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
        return self._heading

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
        if self._kernel is not None and self._attitude.ready:
            return self._run(measurement, feet, acceleration, reaction)
        attitude, eta = self._attitude, self._eta
        c, s = cos(self._heading), sin(self._heading)
        ax, ay = acceleration
        attitude.update(
            measurement.gyro,
            measurement.accelerometer,
            (c * ax + s * ay, c * ay - s * ax),
            self._tick,
        )
        forces = measurement.foot_forces
        left_force, right_force = _sums(forces)
        weight = self._weigh(left_force, right_force)
        posture = self.kinematics.posture(measurement.joint_positions)
        measured, (px, py) = self._locate(
            posture, forces, (left_force, right_force), feet
        )
        self._observe(
            measured,
            (px - reaction[0], py - reaction[1]),
            stands=weight >= STANDS * self._weight,
        )
        assert self._com is not None
        (cx, cy), (vx, vy) = self._com, self._velocity
        return BodyState(
            (cx, cy),
            (vx, vy),
            (cx + vx / eta, cy + vy / eta),
            (px, py),
            (attitude.roll, attitude.pitch),
            attitude.rate,
            self._share,
            weight,
        )

    def _run(
        self,
        measurement: Measurement,
        feet: BodyReference,
        acceleration: Vector,
        reaction: Vector,
    ) -> BodyState:
        """Estimate by machine code; see :meth:`update`."""
        assert self._kernel is not None and self._posture_kernel is not None
        values, state, attitude = self._values, self._state, self._attitude
        if self._com is not None:  # so far it was estimated in Python
            state[:4] = *self._com, *self._velocity
            state[8:10] = attitude.roll, attitude.pitch
            state[13], state[15] = self._share, self._heading
            state[16:] = attitude.bias
            self._com = None
        self.kinematics.angles[:] = measurement.joint_positions
        self._posture_kernel()
        values[:3], values[3:6] = measurement.gyro, measurement.accelerometer
        values[6:14] = measurement.foot_forces
        values[14:] = (
            *feet.left_foot,
            *feet.right_foot,
            *acceleration,
            *reaction,
        )
        self._kernel()
        cx, cy, vx, vy, dx, dy, px, py, *others = state.tolist()
        roll, pitch, wx, wy, wz, share, weight, heading, _, _ = others
        attitude.roll, attitude.pitch = roll, pitch
        attitude.rate = wx, wy, wz
        self._heading = heading
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

    def _weigh(self, left: float, right: float) -> float:
        """Return the force on both feet, in [N]; update the left fraction."""
        weight = left + right
        if weight > TOUCHES * self._weight:
            share = left / weight
            # The fraction of a hardly loaded foot is noise.
            self._share = 0.0 if share < 0.02 else min(share, 1.0)
            if share > 0.98:
                self._share = 1.0
        return weight

    def _locate(
        self,
        posture: MeasuredPosture,
        forces: Array,
        sums: Vector,
        feet: BodyReference,
    ) -> tuple[Vector, Vector]:
        """Return CoM and ZMP in odometry, in [m], weighted by foot load.

        Args:
            posture: Measured posture.
            forces: Forces at the corners of the soles, in [N]. Shape (8,).
            sums: Their sums under the left and the right foot, in [N].
            feet: Body reference whose feet are used.
        """
        share = self._share
        level = _level(self._attitude.roll, self._attitude.pitch)
        com_x = com_y = zmp_x = zmp_y = 0.0
        for side, load in ((0, share), (1, 1.0 - share)):
            if load == 0.0:
                continue
            x, y, _, yaw = feet.left_foot if side == 0 else feet.right_foot
            frame = level @ posture.axes_feet_in_torso[side]
            turn = yaw - atan2(frame[1, 0], frame[0, 0])
            if load >= 0.5:
                self._heading = turn
            c, s = cos(turn), sin(turn)
            lever = level @ (
                posture.position_com_in_torso
                - posture.positions_feet_in_torso[side]
            )
            u, v, _ = lever.tolist()
            com_x += load * (x + c * u - s * v)
            com_y += load * (y + s * u + c * v)
            total = sums[side]
            if total > 0.0:
                at = slice(4 * side, 4 * side + 4)
                u, v = (forces[at] @ self._sensors[at]).tolist()
                u, v = u / total, v / total
                c, s = cos(yaw), sin(yaw)
                zmp_x += load * (x + c * u - s * v)
                zmp_y += load * (y + s * u + c * v)
        return (com_x, com_y), (zmp_x, zmp_y)

    def _observe(
        self, measured: Vector, pivot: Vector, *, stands: bool
    ) -> None:
        """Update CoM and velocity of the observer.

        Args:
            measured: CoM by the joints, in [m].
            pivot: Pivot of the pendulum, in [m].
            stands: Whether the floor supports the robot.
        """
        tick, square = self._tick, self._eta * self._eta
        com, velocity = [], []
        for at, rate, found, point in zip(
            self._com or measured, self._velocity, measured, pivot, strict=True
        ):
            pull = square * (at - point) if stands else 0.0
            predicted = at + tick * rate
            predicted += 0.5 * tick * tick * pull
            error = found - predicted
            com.append(predicted + self._position_gain * error)
            velocity.append(rate + tick * pull + self._velocity_gain * error)
        self._com = com[0], com[1]
        self._velocity = velocity[0], velocity[1]


def _sums(forces: Array) -> Vector:
    """Return the forces under the left and the right foot, in [N]."""
    a, b, c, d, e, f, g, h = forces.tolist()
    return a + b + c + d, e + f + g + h


def _level(roll: float, pitch: float) -> Array:
    """Return the rotation from the torso to a level frame of its heading."""
    cr, sr, cp, sp = cos(roll), sin(roll), cos(pitch), sin(pitch)
    return np.array(
        (cp, sp * sr, sp * cr, 0.0, cr, -sr, -sp, cp * sr, cp * cr)
    ).reshape(3, 3)
