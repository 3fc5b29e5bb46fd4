"""State estimation at one tick as machine code, with the bits of NumPy.

Small matrix products of NumPy are fused on processors with fused
multiply-add, in an order that depends on its linear algebra library. The
kernel is used where a trial shows that order.
"""

import ctypes
from collections.abc import Callable
from functools import cache

import numpy as np

from ...core.machine_code import Kernel, kernel_of
from ...core.poses import Array

# Columns of ``values``: gyro, accelerometer, foot forces, then x, y, z and yaw
# of the left and the right foot, and acceleration and reaction of the command.
VALUES = 26
# Columns of ``state``: CoM, velocity, DCM, ZMP, roll and pitch, rate, fraction
# on the left foot, weight, heading, and bias of the gyro.
STATE = 18
ARGUMENTS = "1121" + "0" * 9
LOOP = """\
def estimate(
    values, numbers, sensors, state,
    tick, eta, correction, bias_correction, gravity,
    position_gain, velocity_gain, touches, stands,
):
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
    left = values[6] + values[7] + values[8] + values[9]
    right = values[10] + values[11] + values[12] + values[13]
    weight = left + right
    if weight > touches:
        share = left / weight
        state[13] = 0.0 if share < 0.02 else min(share, 1.0)
        if share > 0.98:
            state[13] = 1.0
    state[14] = weight
    sr = sin(roll)
    cr = cos(roll)
    sp = sin(pitch)
    cp = cos(pitch)
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
            k = 9 + 9 * side
            across = fma(0.0, numbers[k], 0.0)
            across = fma(cr, numbers[k + 3], across)
            across = fma(-sr, numbers[k + 6], across)
            along = fma(cp, numbers[k], 0.0)
            along = fma(sp * sr, numbers[k + 3], along)
            along = fma(sp * cr, numbers[k + 6], along)
            turn = yaw - atan2(across, along)
            if load >= 0.5:
                state[15] = turn
            c = cos(turn)
            s = sin(turn)
            k = 3 + 3 * side
            a = numbers[0] - numbers[k]
            b = numbers[1] - numbers[k + 1]
            h = numbers[2] - numbers[k + 2]
            u = fma(sp * cr, h, fma(cp, a, sp * sr * b))
            v = fma(-sr, h, fma(0.0, a, cr * b))
            com_x += load * (x + c * u - s * v)
            com_y += load * (y + s * u + c * v)
            total = left if side == 0 else right
            if total > 0.0:
                f = 6 + 4 * side
                k = 4 * side
                u = (
                    fma(values[f], sensors[k, 0],
                        values[f + 1] * sensors[k + 1, 0])
                    + fma(values[f + 2], sensors[k + 2, 0],
                          values[f + 3] * sensors[k + 3, 0])
                ) / total
                v = (
                    fma(values[f], sensors[k, 1],
                        values[f + 1] * sensors[k + 1, 1])
                    + fma(values[f + 2], sensors[k + 2, 1],
                          values[f + 3] * sensors[k + 3, 1])
                ) / total
                c = cos(yaw)
                s = sin(yaw)
                zmp_x += load * (x + c * u - s * v)
                zmp_y += load * (y + s * u + c * v)
    state[6], state[7] = zmp_x, zmp_y
    for i in range(2):
        pivot = state[6 + i] - values[24 + i]
        found = com_x if i == 0 else com_y
        pull = eta * eta * (state[i] - pivot) if weight >= stands else 0.0
        predicted = state[i] + tick * state[2 + i]
        predicted += 0.5 * tick * tick * pull
        error = found - predicted
        state[i] = predicted + position_gain * error
        state[2 + i] = state[2 + i] + tick * pull + velocity_gain * error
        state[4 + i] = state[i] + state[2 + i] / eta
"""


@cache
def estimator_kernel() -> Kernel | None:
    """Return the loop, if it has the bits of NumPy on this machine."""
    kernel = kernel_of("estimate", LOOP, ARGUMENTS)
    return kernel if kernel is not None and _fuses_as_kernel() else None


def _fuses_as_kernel() -> bool:
    """Return whether small products of NumPy have the bits of the kernel."""
    try:
        fma = ctypes.CDLL(None).fma
    except (AttributeError, OSError, TypeError):
        return False
    fma.restype, fma.argtypes = ctypes.c_double, [ctypes.c_double] * 3
    draws = np.random.default_rng(1)
    return all(
        _agree(fma, draws.normal(size=(3, 3)), draws.normal(size=(8, 3)))
        for _ in range(20)
    )


def _agree(
    fma: Callable[[float, float, float], float], level: Array, drawn: Array
) -> bool:
    """Return whether the products of one trial have the same bits."""
    axes, (force, *corners) = drawn[:3].copy(), drawn[3:].tolist()
    force.append(corners[0][2])
    soles = np.array([corner[:2] for corner in corners])
    product, lever = level @ axes, level @ axes[0]
    weighted = np.array(force) @ soles
    a, b, c, d = force
    for i, (p, q, r) in enumerate(level.tolist()):
        x, y, z = axes[0].tolist()
        if fma(r, z, fma(p, x, q * y)) != lever[i]:
            return False
        for j in range(3):
            x, y, z = axes[:, j].tolist()
            if fma(r, z, fma(q, y, fma(p, x, 0.0))) != product[i, j]:
                return False
    return all(
        fma(a, x, b * y) + fma(c, z, d * w) == weighted[j]
        for j, (x, y, z, w) in enumerate(soles.T.tolist())
    )
