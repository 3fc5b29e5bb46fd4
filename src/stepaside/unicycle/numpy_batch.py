"""Many games at once in NumPy, where nothing is compiled."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .compiled_batch import LOOSE, SIXTH
from .event_located import careful_step, piece

Array = NDArray[np.float64]


def rates(
    r: Array, a: Array, psi: Array, vp: float, ve: float
) -> tuple[Array, Array]:
    """Rates of the distance and of the line of sight."""
    distance: Array = ve * np.cos(psi) - vp * np.cos(a)
    sight: Array = (vp * np.sin(a) - ve * np.sin(psi)) / r
    return distance, sight


def distances_off(
    circles: Array, side: Any, r: Array, a: Array, psi: Array
) -> Array:
    """How far states are off each circle, as a share of it or in [rad].

    Args:
        circles: Rows of r [m], a, psi [rad] at side +1. Shape (n, 3).
        side: Side of each game. Shape (m,).
        r: Distance, in [m]. Shape (m,).
        a: Error of the pursuer, in [rad]. Shape (m,).
        psi: Bearing of the pursuer, in [rad]. Shape (m,).

    Returns:
        The largest of the three deviations. Shape (n, m).
    """
    radius, error, bearing = circles.T[..., None]
    off = np.maximum(np.abs(r / radius - 1.0), np.abs(side * a - error))
    found: Array = np.maximum(off, np.abs(side * psi - bearing))
    return found


def play_arrays(
    state: Array,
    side: Any,
    branch: Any,
    out: Array,
    count: int,
    step: float,
    laws: tuple[float, float, float, float, float, float, float],
    keeps_side: bool,
    capture: float,
    circles: Array,
    near: float,
) -> None:
    """Play all games together; the twin of :func:`.blocks.play_blocks`."""
    vp, ve, kp, ke, c1, angle, hysteresis = laws
    extra = (angle, hysteresis, keeps_side, ke)
    pieces = [
        piece(int(s), int(b), *extra)
        for s, b in zip(side, branch, strict=True)
    ]
    low, high, c0, _, c2 = np.array(pieces).T.copy()
    free = 1.0 - c2
    r, a, p = (column.copy() for column in state.T)
    d1, w1 = rates(r, a, p, vp, ve)
    h = np.where(r > capture, step, 0.0)
    with np.errstate(all="ignore"):
        for n in range(count):
            f1, g1 = w1 - kp * a, free * w1 - c1 * p - c0
            h2 = 0.5 * h
            x, y, z = r + h2 * d1, a + h2 * f1, p + h2 * g1
            d2, w2 = rates(x, y, z, vp, ve)
            f2, g2 = w2 - kp * y, free * w2 - c1 * z - c0
            x, y, z = r + h2 * d2, a + h2 * f2, p + h2 * g2
            d3, w3 = rates(x, y, z, vp, ve)
            f3, g3 = w3 - kp * y, free * w3 - c1 * z - c0
            x, y, z = r + h * d3, a + h * f3, p + h * g3
            d4, w4 = rates(x, y, z, vp, ve)
            f4, g4 = w4 - kp * y, free * w4 - c1 * z - c0
            h6 = h * SIXTH
            x = r + h6 * (d1 + 2.0 * (d2 + d3) + d4)
            y = a + h6 * (f1 + 2.0 * (f2 + f3) + f4)
            z = p + h6 * (g1 + 2.0 * (g2 + g3) + g4)
            d, s = rates(x, y, z, vp, ve)
            flag = (d1 < 0.0) & (d >= 0.0)
            flag |= (x <= capture) | (np.abs(y) > np.pi)
            flag |= (z < low) | (z > high) | ((1.0 - free) * np.abs(s) > ke)
            flag |= (vp + ve) * h > LOOSE * r
            flag &= h > 0.0
            off = distances_off(circles, side, x, y, z).min(0, initial=np.inf)
            out[(off > near) & (h > 0.0), 3] = (n + 1) * step
            for j in np.flatnonzero(flag).tolist():
                *now, side[j], branch[j], best, when, caught = careful_step(
                    float(r[j]), float(a[j]), float(p[j]), int(side[j]),
                    int(branch[j]), step, vp, ve, kp, ke, angle, hysteresis,
                    keeps_side, capture,
                )  # fmt: skip
                x[j], y[j], z[j] = now
                d[j], s[j] = rates(x[j], y[j], z[j], vp, ve)
                if best < out[j, 0]:
                    out[j, :2] = best, n * step + when
                if caught >= 0.0:
                    out[j, 2] = n * step + caught
                    h[j] = 0.0
                numbers = piece(int(side[j]), int(branch[j]), *extra)
                low[j], high[j], c0[j] = numbers[:3]
                free[j] = 1.0 - numbers[4]
            r, a, p, d1, w1 = x, y, z, d, s
    state[:] = np.stack([r, a, p], axis=-1)
    ended = r < out[:, 0]
    out[ended, 0], out[ended, 1] = r[ended], count * step
