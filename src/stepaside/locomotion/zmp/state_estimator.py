"""Estimation of the body's state from encoders, IMU and foot forces."""

from math import atan2, cos, exp, isnan, sin
from typing import NamedTuple

import numpy as np

from ...core.compilation import bound, compiled
from ...core.constants import GRAVITY
from ...core.poses import Array
from ...perception.attitude import AttitudeFilter
from ...perception.measurement import RobotState
from ...robots.forward_kinematics import ForwardKinematics
from ...robots.leg_kinematics import BodyReference

STANDS, TOUCHES = 0.2, 0.02  # least fractions of the weight on the feet
FALLEN = 0.7  # tilt of the torso that counts as a fall, in [rad]
# Columns of ``values``: foot forces, then x, y, z and yaw of the left and the
# right foot, reaction of the command, roll and pitch.
VALUES = 20
# Columns of ``state``: CoM, which is NaN at first, velocity, DCM, ZMP, share
# of the load on the left foot, weight and heading.
STATE = 11


@compiled
def estimate(
    values: Array,
    com: Array,
    feet: Array,
    axes: Array,
    sensors: Array,
    state: Array,
    tick: float,
    eta: float,
    position_gain: float,
    velocity_gain: float,
    touches: float,
    stands: float,
) -> None:
    """Update the state by the values of one tick.

    CoM, feet and their axes are in the torso frame, the sensors in the foot
    frames. The load fraction is known above the weight ``touches``; above
    ``stands``, in [N], the floor supports the robot.
    """
    left = values[0] + values[1] + values[2] + values[3]
    right = values[4] + values[5] + values[6] + values[7]
    weight = left + right
    if weight > touches:
        share = left / weight
        state[8] = 0.0 if share < 0.02 else min(share, 1.0)
        if share > 0.98:
            state[8] = 1.0
    state[9] = weight
    sr, cr = sin(values[18]), cos(values[18])
    sp, cp = sin(values[19]), cos(values[19])
    com_x, com_y, zmp_x, zmp_y = 0.0, 0.0, 0.0, 0.0
    for side in range(2):
        load = state[8] if side == 0 else 1.0 - state[8]
        if load != 0.0:
            at = 8 + 4 * side
            x, y, yaw = values[at], values[at + 1], values[at + 3]
            a, b, h = axes[side, 0, 0], axes[side, 1, 0], axes[side, 2, 0]
            across = cr * b - sr * h
            along = cp * a + sp * (sr * b + cr * h)
            turn = yaw - atan2(across, along)
            if load >= 0.5:
                state[10] = turn
            c, s = cos(turn), sin(turn)
            a = com[0] - feet[side, 0]
            b = com[1] - feet[side, 1]
            h = com[2] - feet[side, 2]
            u = cp * a + sp * (sr * b + cr * h)
            v = cr * b - sr * h
            com_x += load * (x + c * u - s * v)
            com_y += load * (y + s * u + c * v)
            total = left if side == 0 else right
            if total > 0.0:
                u, v = 0.0, 0.0
                for corner in range(4 * side, 4 * side + 4):
                    force = values[corner] / total
                    u += force * sensors[corner, 0]
                    v += force * sensors[corner, 1]
                c, s = cos(yaw), sin(yaw)
                zmp_x += load * (x + c * u - s * v)
                zmp_y += load * (y + s * u + c * v)
    state[6], state[7] = zmp_x, zmp_y
    for i in range(2):
        pivot = state[6 + i] - values[16 + i]
        found = com_x if i == 0 else com_y
        if isnan(state[i]):
            state[i] = found
        pull = eta * eta * (state[i] - pivot) if weight >= stands else 0.0
        predicted = state[i] + tick * state[2 + i]
        predicted += 0.5 * tick * tick * pull
        error = found - predicted
        state[i] = predicted + position_gain * error
        state[2 + i] = state[2 + i] + tick * pull + velocity_gain * error
        state[4 + i] = state[i] + state[2 + i] / eta


class BodyState(NamedTuple):
    """Estimated state of the body, in odometry."""

    com: tuple[float, float]  # CoM (x, y) [m]
    velocity: tuple[float, float]  # its velocity [m/s]
    dcm: tuple[float, float]  # divergent component of motion [m]
    zmp: tuple[float, float]  # center of the foot forces [m]
    tilt: tuple[float, float]  # roll and pitch of the torso [rad]
    # angular velocity in the torso frame [rad/s]
    rate: tuple[float, float, float]
    left_share: float  # fraction of the weight on the left foot [0, 1]
    weight: float  # sum of the foot forces [N]

    @property
    def has_fallen(self) -> bool:
        """Whether the torso tilts beyond recovery."""
        return max(map(abs, self.tilt)) > FALLEN


class StateEstimator:
    """State estimator of one robot.

    The torso tilt comes from the IMU, the CoM from tilt and joints relative to
    the loaded feet, whose poses are those of odometry, and the velocity from
    an observer of the pendulum, driven by the measured ZMP.
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
        """Prepare it; force sensors are in the foot frames (8, 2)."""
        self.kinematics = kinematics
        self._tick = tick
        weight = GRAVITY * kinematics.mass
        self._attitude = AttitudeFilter(correction, bias_correction)
        fade = exp(-bandwidth * tick)
        self._values, self._state = np.zeros(VALUES), np.zeros(STATE)
        self._state[:2], self._state[8] = np.nan, 0.5
        self._estimate = bound(
            estimate,
            self._values,
            *(kinematics.com, kinematics.places, kinematics.axes),
            np.ascontiguousarray(force_sensors, dtype=np.float64),
            self._state,
            *(tick, eta),
            # Two equal poles at the bandwidth.
            *(1.0 - fade * fade, (1.0 - fade) ** 2 / tick),
            *(TOUCHES * weight, STANDS * weight),
        )

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
        return float(self._state[10])

    def update(
        self,
        measurement: RobotState,
        feet: BodyReference,
        acceleration: tuple[float, float],
        reaction: tuple[float, float] = (0.0, 0.0),
    ) -> BodyState:
        """Estimate the state, with feet as the executed command has them."""
        values, state, attitude = self._values, self._state, self._attitude
        (ax, ay), heading = acceleration, state.item(10)
        c, s = cos(heading), sin(heading)
        attitude.update(
            *(measurement.gyro, measurement.accelerometer),
            *((c * ax + s * ay, c * ay - s * ax), self._tick),
        )
        self.kinematics.evaluate(measurement.joint_positions)
        tilt = attitude.roll, attitude.pitch
        values[:8] = measurement.foot_forces
        values[8:] = *feet.left_foot, *feet.right_foot, *reaction, *tilt
        self._estimate()
        cx, cy, vx, vy, dx, dy, px, py, share, weight, _ = state.tolist()
        return BodyState(
            (cx, cy),
            (vx, vy),
            (dx, dy),
            (px, py),
            tilt,
            attitude.rate,
            share,
            weight,
        )
