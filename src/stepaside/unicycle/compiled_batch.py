"""Many games in blocks that fit the cache, several per instruction.

A block keeps its numbers in one flat array, quantity after quantity. The
inner loop has no branch, so that the compiler turns it into vector
instructions; the few games that need care in a step are flagged and done
one by one by :func:`.careful.careful_step`.
"""

from typing import Any

import numpy as np

from .compiled import compiled, compiled_inline, compiled_parallel, prange
from .event_located import TURN_PER_STEP, careful_step, piece

SIZE = 128  # games in a block
SIXTH = 1.0 / 6.0
LOOSE = 2.0 * TURN_PER_STEP  # a step longer than this is done with care
_R, _A, _P, _R1, _A1, _P1 = (SIZE * row for row in range(6))
_D, _W, _SA, _CA, _SP, _CP = (SIZE * row for row in range(6, 12))
_C0, _FREE, _LOW, _HIGH = (SIZE * row for row in range(12, 16))
_STEP, _FLAG, _SETTLED = (SIZE * row for row in range(16, 19))
_SIDE, _OFF = (SIZE * row for row in range(19, 21))
_ROWS = 21
_ROUND = 6755399441055744.0  # 1.5 * 2**52: adding it rounds to an integer


@compiled_inline
def sine_cosine(x: float) -> tuple[float, float]:
    """Sine and cosine to 2e-16 for moderate angles, without a branch."""
    q = (x * 0.3183098861837907 + _ROUND) - _ROUND
    y = (x - q * 3.141592653589793) - q * 1.2246467991473532e-16
    half = q - 2.0 * ((q * 0.5 + _ROUND) - _ROUND)
    sign = 1.0 - 2.0 * half * half
    z = y * y
    # Estrin's scheme: short chains keep the vector units busy.
    z2 = z * z
    z4 = z2 * z2
    z8 = z4 * z4
    s = -1.6666666666666666e-01 + z * 8.333333333333333e-03
    s += z2 * (-1.984126984126984e-04 + z * 2.7557319223985893e-06)
    t = -2.505210838544172e-08 + z * 1.6059043836821613e-10
    t += z2 * (-7.647163731819816e-13 + z * 2.8114572543455206e-15)
    s += z4 * t + z8 * (-8.22063524662433e-18 + z * 1.957294106339126e-20)
    c = -0.5 + z * 4.1666666666666664e-02
    c += z2 * (-1.388888888888889e-03 + z * 2.48015873015873e-05)
    u = -2.755731922398589e-07 + z * 2.08767569878681e-09
    u += z2 * (-1.1470745597729725e-11 + z * 4.779477332387385e-14)
    c += z4 * u + z8 * (-1.5619206968586225e-16 + z * 4.110317623312165e-19)
    return sign * (y + y * z * s), sign * (1.0 + z * c)


@compiled_inline
def turn(s: float, c: float, x: float) -> tuple[float, float]:
    """Turn a sine and a cosine by a small angle, within a step."""
    z = x * x
    sx = 8.333333333333333e-03 - z * 1.984126984126984e-04
    sx = -1.6666666666666666e-01 + z * (sx + z * z * 2.7557319223985893e-06)
    cx = -1.388888888888889e-03 + z * 2.48015873015873e-05
    cx = z * (-0.5 + z * (4.1666666666666664e-02 + z * cx))
    sx = x + x * (z * sx)
    return s + (s * cx + c * sx), c + (c * cx - s * sx)


@compiled
def sweep(
    w: Any,
    time: float,
    vp: float,
    ve: float,
    kp: float,
    ke: float,
    c1: float,
    capture: float,
    circles: Any,
    near: float,
) -> int:
    """Do one step of every game of a block; count the flagged ones."""
    flags = 0
    for i in range(SIZE):
        r, a, p = w[_R + i], w[_A + i], w[_P + i]
        c0, free, h = w[_C0 + i], w[_FREE + i], w[_STEP + i]
        d1, w1 = w[_D + i], w[_W + i]
        sa, ca, sp, cp = w[_SA + i], w[_CA + i], w[_SP + i], w[_CP + i]
        f1, g1 = w1 - kp * a, free * w1 - c1 * p - c0
        h2 = 0.5 * h
        x, y, z = r + h2 * d1, a + h2 * f1, p + h2 * g1
        sy, cy = turn(sa, ca, y - a)
        sz, cz = turn(sp, cp, z - p)
        d2, w2 = ve * cz - vp * cy, (vp * sy - ve * sz) / x
        f2, g2 = w2 - kp * y, free * w2 - c1 * z - c0
        x, y, z = r + h2 * d2, a + h2 * f2, p + h2 * g2
        sy, cy = turn(sa, ca, y - a)
        sz, cz = turn(sp, cp, z - p)
        d3, w3 = ve * cz - vp * cy, (vp * sy - ve * sz) / x
        f3, g3 = w3 - kp * y, free * w3 - c1 * z - c0
        x, y, z = r + h * d3, a + h * f3, p + h * g3
        sy, cy = turn(sa, ca, y - a)
        sz, cz = turn(sp, cp, z - p)
        d4, w4 = ve * cz - vp * cy, (vp * sy - ve * sz) / x
        f4, g4 = w4 - kp * y, free * w4 - c1 * z - c0
        h6 = h * SIXTH
        x = r + h6 * (d1 + 2.0 * (d2 + d3) + d4)
        y = a + h6 * (f1 + 2.0 * (f2 + f3) + f4)
        z = p + h6 * (g1 + 2.0 * (g2 + g3) + g4)
        sy, cy = sine_cosine(y)
        sz, cz = sine_cosine(z)
        d, s = ve * cz - vp * cy, (vp * sy - ve * sz) / x
        w[_R1 + i], w[_A1 + i], w[_P1 + i] = x, y, z
        w[_D + i], w[_W + i] = d, s
        w[_SA + i], w[_CA + i], w[_SP + i], w[_CP + i] = sy, cy, sz, cz
        flag = (
            ((d1 < 0.0) & (d >= 0.0))
            | (x <= capture)
            | (abs(y) > np.pi)
            | (z < w[_LOW + i])
            | (z > w[_HIGH + i])
            | ((1.0 - free) * abs(s) > ke)
            | ((vp + ve) * h > LOOSE * r)
        ) & (h > 0.0)
        w[_FLAG + i] = 1.0 if flag else 0.0
        flags += 1 if flag else 0
    for c in range(len(circles)):
        shrink, error, bearing = (
            1.0 / circles[c, 0],
            circles[c, 1],
            circles[c, 2],
        )
        for i in range(SIZE):
            side = w[_SIDE + i]
            off = abs(w[_R1 + i] * shrink - 1.0)
            off = max(off, abs(side * w[_A1 + i] - error))
            off = max(off, abs(side * w[_P1 + i] - bearing))
            w[_OFF + i] = off if c == 0 else min(off, w[_OFF + i])
    for i in range(SIZE):
        apart = (w[_OFF + i] > near) & (w[_STEP + i] > 0.0)
        w[_SETTLED + i] = time if apart else w[_SETTLED + i]
    return flags


@compiled
def set_piece(
    w: Any,
    i: int,
    side: int,
    branch: int,
    angle: float,
    hysteresis: float,
    keeps_side: bool,
    ke: float,
) -> None:
    """Write the numbers of a game's smooth piece into its block."""
    low, high, c0, _, c2 = piece(
        side, branch, angle, hysteresis, keeps_side, ke
    )
    w[_LOW + i], w[_HIGH + i] = low, high
    w[_C0 + i], w[_FREE + i], w[_SIDE + i] = c0, 1.0 - c2, side


@compiled
def set_rates(
    w: Any, i: int, r: float, a: float, psi: float, vp: float, ve: float
) -> None:
    """Write what the next step needs to know of a state into its block."""
    sa, ca = sine_cosine(a)
    sp, cp = sine_cosine(psi)
    w[_SA + i], w[_CA + i], w[_SP + i], w[_CP + i] = sa, ca, sp, cp
    w[_D + i], w[_W + i] = ve * cp - vp * ca, (vp * sa - ve * sp) / r


@compiled
def play_block(
    first: int,
    last: int,
    state: Any,
    side: Any,
    branch: Any,
    out: Any,
    count: int,
    step: float,
    laws: tuple[float, float, float, float, float, float, float],
    keeps_side: bool,
    capture: float,
    circles: Any,
    near: float,
) -> None:
    """Play games ``first`` to ``last`` (excluded); see :mod:`.kernel`."""
    vp, ve, kp, ke, c1, angle, hysteresis = laws
    w = np.zeros(_ROWS * SIZE)
    w[_R : _R + SIZE] = 1.0
    w[_R1 : _R1 + SIZE] = 1.0
    w[_OFF : _OFF + SIZE] = np.inf
    for i in range(last - first):
        j = first + i
        w[_R + i], w[_A + i], w[_P + i] = state[j, 0], state[j, 1], state[j, 2]
        set_rates(w, i, state[j, 0], state[j, 1], state[j, 2], vp, ve)
        w[_STEP + i] = step if state[j, 0] > capture else 0.0
        set_piece(w, i, side[j], branch[j], angle, hysteresis, keeps_side, ke)
    for n in range(count):
        flags = sweep(
            w, (n + 1) * step, vp, ve, kp, ke, c1, capture, circles, near
        )
        if flags > 0:
            for i in range(last - first):
                if w[_FLAG + i] == 0.0:
                    continue
                j = first + i
                r, a, p, side[j], branch[j], best, when, caught = careful_step(
                    w[_R + i], w[_A + i], w[_P + i], side[j], branch[j], step,
                    vp, ve, kp, ke, angle, hysteresis, keeps_side, capture,
                )  # fmt: skip
                w[_R1 + i], w[_A1 + i], w[_P1 + i] = r, a, p
                set_rates(w, i, r, a, p, vp, ve)
                if best < out[j, 0]:
                    out[j, 0], out[j, 1] = best, n * step + when
                if caught >= 0.0:
                    out[j, 2] = n * step + caught
                    w[_STEP + i] = 0.0
                set_piece(
                    w, i, side[j], branch[j], angle, hysteresis, keeps_side,
                    ke,
                )  # fmt: skip
        for i in range(3 * SIZE):
            w[i] = w[3 * SIZE + i]
    for i in range(last - first):
        j = first + i
        state[j, 0], state[j, 1], state[j, 2] = w[_R + i], w[_A + i], w[_P + i]
        out[j, 3] = w[_SETTLED + i]
        if w[_R + i] < out[j, 0]:
            out[j, 0], out[j, 1] = w[_R + i], count * step


@compiled_parallel
def play_blocks(
    state: Any,
    side: Any,
    branch: Any,
    out: Any,
    count: int,
    step: float,
    laws: tuple[float, float, float, float, float, float, float],
    keeps_side: bool,
    capture: float,
    circles: Any,
    near: float,
) -> None:
    """Play all games, blocks in parallel; see :mod:`.kernel`."""
    games = state.shape[0]
    for block in prange((games + SIZE - 1) // SIZE):
        first = block * SIZE
        last = min(first + SIZE, games)
        play_block(
            first, last, state, side, branch, out, count, step, laws,
            keeps_side, capture, circles, near,
        )  # fmt: skip
