"""State estimation at one tick."""

from math import atan2, cos, isnan, sin, tan

from ...core.compilation import compiled, inlined
from ...core.poses import Array

# Columns of ``values``: gyro, accelerometer, foot forces, then x, y, z and yaw
# of the left and the right foot, acceleration and reaction of the command, and
# whether the attitude is calibrated.
VALUES = 27
# Columns of ``state``: CoM, which is NaN at first, velocity, DCM, ZMP, roll
# and pitch, rate, fraction on the left foot, weight, heading, and bias of the
# gyro.
STATE = 18


@inlined
def _follow_attitude(
    values: Array,
    state: Array,
    tick: float,
    correction: float,
    bias_correction: float,
    gravity: float,
) -> None:
    """Update tilt and rate, as :class:`.AttitudeFilter` does."""
    c = cos(state[15])
    s = sin(state[15])
    ax = c * values[22] + s * values[23]
    ay = c * values[23] - s * values[22]
    wx = values[0] - state[16]
    wy = values[1] - state[17]
    wz = 0.0 if values[2] != values[2] else values[2]
    roll = state[8]
    pitch = state[9]
    sr = sin(roll)
    cr = cos(roll)
    roll += tick * (wx + tan(pitch) * (sr * wy + cr * wz))
    pitch += tick * (cr * wy - sr * wz)
    fx = values[3]
    fy = values[4]
    fz = values[5]
    sr = sin(roll)
    cr = cos(roll)
    sp = sin(pitch)
    cp = cos(pitch)
    error_pitch = -(fx - (cp * ax - sp * gravity)) / gravity
    error_roll = (fy - (sr * sp * ax + cr * ay + sr * cp * gravity)) / gravity
    if fx * fx + fy * fy + fz * fz > 1.0:
        roll += correction * tick * error_roll
        pitch += correction * tick * error_pitch
        step = bias_correction * tick
        state[16] -= step * error_roll
        state[17] -= step * error_pitch
    state[8], state[9] = roll, pitch
    state[10], state[11], state[12] = wx, wy, wz


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
    correction: float,
    bias_correction: float,
    gravity: float,
    position_gain: float,
    velocity_gain: float,
    touches: float,
    stands: float,
) -> None:
    """Update the state by the values of one tick.

    Args:
        values: See :data:`VALUES`.
        com: CoM in the torso frame, in [m]. Shape (3,).
        feet: Positions of left and right foot there, in [m]. Shape (..., 3).
        axes: Axes of the feet there, as columns. Shape (..., 3, 3).
        sensors: Positions of the force sensors in the foot frames, in [m].
            Shape (8, 2).
        state: See :data:`STATE`; changed in place.
        tick: Control period, in [s].
        eta: Rate of the pendulum, in [1/s].
        correction: Gain of the accelerometer, in [1/s].
        bias_correction: Its gain on the bias of the gyro, in [1/s^2].
        gravity: Acceleration of gravity, in [m/s^2].
        position_gain: Gain of the observer.
        velocity_gain: Gain of the observer, in [1/s].
        touches: Weight above which the load fraction is known, in [N].
        stands: Weight above which the floor supports the robot, in [N].
    """
    if values[26] > 0.0:
        _follow_attitude(
            values, state, tick, correction, bias_correction, gravity
        )
    left = values[6] + values[7] + values[8] + values[9]
    right = values[10] + values[11] + values[12] + values[13]
    weight = left + right
    if weight > touches:
        share = left / weight
        state[13] = 0.0 if share < 0.02 else min(share, 1.0)
        if share > 0.98:
            state[13] = 1.0
    state[14] = weight
    sr = sin(state[8])
    cr = cos(state[8])
    sp = sin(state[9])
    cp = cos(state[9])
    com_x = 0.0
    com_y = 0.0
    zmp_x = 0.0
    zmp_y = 0.0
    for side in range(2):
        load = state[13] if side == 0 else 1.0 - state[13]
        if load != 0.0:
            at = 14 + 4 * side
            x = values[at]
            y = values[at + 1]
            yaw = values[at + 3]
            a, b, h = axes[side, 0, 0], axes[side, 1, 0], axes[side, 2, 0]
            across = cr * b - sr * h
            along = cp * a + sp * (sr * b + cr * h)
            turn = yaw - atan2(across, along)
            if load >= 0.5:
                state[15] = turn
            c = cos(turn)
            s = sin(turn)
            a = com[0] - feet[side, 0]
            b = com[1] - feet[side, 1]
            h = com[2] - feet[side, 2]
            u = cp * a + sp * (sr * b + cr * h)
            v = cr * b - sr * h
            com_x += load * (x + c * u - s * v)
            com_y += load * (y + s * u + c * v)
            total = left if side == 0 else right
            if total > 0.0:
                u = 0.0
                v = 0.0
                for corner in range(4 * side, 4 * side + 4):
                    force = values[6 + corner] / total
                    u += force * sensors[corner, 0]
                    v += force * sensors[corner, 1]
                c = cos(yaw)
                s = sin(yaw)
                zmp_x += load * (x + c * u - s * v)
                zmp_y += load * (y + s * u + c * v)
    state[6], state[7] = zmp_x, zmp_y
    for i in range(2):
        pivot = state[6 + i] - values[24 + i]
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
