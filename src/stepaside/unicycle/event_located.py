"""One step of one game past capture, closest approach and edges.

Fixed steps by Runge and Kutta's rule of fourth order. A step that meets an
edge of its smooth piece (:mod:`.modes`), that holds the closest approach or
the capture, or that is long against the distance is cut there.
"""

from math import cos, pi, sin
from typing import Any

from . import modes
from .compiled import compiled

TURN_PER_STEP = 0.04  # longest step, in distances per sum of the speeds
_SLACK = 1e-12

piece = compiled(modes.piece)
leave = compiled(modes.leave)
enter = compiled(modes.enter)


@compiled
def enter_all(
    state: Any,
    side: Any,
    branch: Any,
    vp: float,
    ve: float,
    first: int,
    angle: float,
    keeps_side: bool,
    saturated: bool,
    gain: float,
) -> None:
    """Find the piece that each game starts in; ``state`` may turn round."""
    for j in range(len(state)):
        r, a, psi = state[j, 0], state[j, 1], state[j, 2]
        sight = (vp * sin(a) - ve * sin(psi)) / r
        state[j, 2], side[j], branch[j] = enter(
            psi, sight, first, angle, keeps_side, saturated, gain
        )


@compiled
def rk4(
    r: float,
    a: float,
    psi: float,
    step: float,
    vp: float,
    ve: float,
    kp: float,
    c0: float,
    c1: float,
    c2: float,
) -> tuple[float, float, float]:
    """Advance (r, a, psi) by one step on a smooth piece."""
    r0, a0, p0 = r, a, psi
    dr, da, dp = 0.0, 0.0, 0.0
    for stage in range(4):
        w = (vp * sin(a) - ve * sin(psi)) / r
        fr = ve * cos(psi) - vp * cos(a)
        fa = w - kp * a
        fp = (1.0 - c2) * w - c1 * psi - c0
        weight = 1.0 if stage == 0 or stage == 3 else 2.0
        dr += weight * fr
        da += weight * fa
        dp += weight * fp
        part = step if stage == 2 else 0.5 * step
        r, a, psi = r0 + part * fr, a0 + part * fa, p0 + part * fp
    sixth = step / 6.0
    return r0 + sixth * dr, a0 + sixth * da, p0 + sixth * dp


@compiled
def margin(
    what: int,
    r: float,
    a: float,
    psi: float,
    vp: float,
    ve: float,
    ke: float,
    low: float,
    high: float,
    capture: float,
) -> float:
    """Distance to an edge: 0 pursuer's wrap, 1 low, 2 high, 3 sliding.

    4 is the closest approach and 5 the capture.
    """
    if what == 0:
        return pi - abs(a)
    if what == 1:
        return psi - low
    if what == 2:
        return high - psi
    if what == 3:
        return ke - abs((vp * sin(a) - ve * sin(psi)) / r)
    if what == 4:
        return vp * cos(a) - ve * cos(psi)
    return r - capture


@compiled
def cut(
    what: int,
    r: float,
    a: float,
    psi: float,
    step: float,
    vp: float,
    ve: float,
    kp: float,
    ke: float,
    low: float,
    high: float,
    c0: float,
    c1: float,
    c2: float,
    capture: float,
) -> float:
    """Part of a step until a margin falls to zero, in [s]."""
    short, long = 0.0, step
    above = margin(what, r, a, psi, vp, ve, ke, low, high, capture)
    x, y, z = rk4(r, a, psi, step, vp, ve, kp, c0, c1, c2)
    below = margin(what, x, y, z, vp, ve, ke, low, high, capture)
    if above <= 0.0:
        return 0.0
    for _ in range(60):
        middle = (short * below - long * above) / (below - above)
        if not short < middle < long:
            break
        x, y, z = rk4(r, a, psi, middle, vp, ve, kp, c0, c1, c2)
        m = margin(what, x, y, z, vp, ve, ke, low, high, capture)
        if m > 0.0:
            short, above = middle, m
            below *= 0.5
        else:
            long, below = middle, m
            above *= 0.5
        if abs(m) < 1e-15 or long - short < 1e-15 * step:
            break
    return long


@compiled
def careful_step(
    r: float,
    a: float,
    psi: float,
    side: int,
    branch: int,
    step: float,
    vp: float,
    ve: float,
    kp: float,
    ke: float,
    angle: float,
    hysteresis: float,
    keeps_side: bool,
    capture: float,
) -> tuple[float, float, float, int, int, float, float, float]:
    """Advance a game by one step, however many pieces it takes.

    Returns:
        r, a, psi, side, branch, then the least distance within the step
        [m], when it was, and when the capture was (-1 for none), both from
        the start of the step, in [s].
    """
    done = 0.0
    best, best_time = r, 0.0
    while done < step:
        low, high, c0, c1, c2 = piece(
            side, branch, angle, hysteresis, keeps_side, ke
        )
        part = min(step - done, TURN_PER_STEP * r / (vp + ve))
        last = part == step - done
        r1, a1, psi1 = rk4(r, a, psi, part, vp, ve, kp, c0, c1, c2)
        edge = -1
        for what in range(4):
            if what == 3 and branch != 2:
                continue
            m = margin(what, r1, a1, psi1, vp, ve, ke, low, high, capture)
            if m < -_SLACK:
                time = cut(
                    what, r, a, psi, part, vp, ve, kp, ke, low, high,
                    c0, c1, c2, capture,
                )  # fmt: skip
                part, edge, last = time, what, False
                r1, a1, psi1 = rk4(r, a, psi, part, vp, ve, kp, c0, c1, c2)
        was = vp * cos(a) - ve * cos(psi)
        now = vp * cos(a1) - ve * cos(psi1)
        nearest, when = r1, part
        if was > 0.0 and now < 0.0:
            when = cut(
                4, r, a, psi, part, vp, ve, kp, ke, low, high, c0, c1, c2,
                capture,
            )  # fmt: skip
            nearest = rk4(r, a, psi, when, vp, ve, kp, c0, c1, c2)[0]
        if nearest <= capture:
            when = cut(
                5, r, a, psi, when, vp, ve, kp, ke, low, high, c0, c1, c2,
                capture,
            )  # fmt: skip
            r, a, psi = rk4(r, a, psi, when, vp, ve, kp, c0, c1, c2)
            done += when
            return r, a, psi, side, branch, r, done, done
        if nearest < best:
            best, best_time = nearest, done + when
        r, a, psi = r1, a1, psi1
        done = step if last else done + part
        if edge == 0:
            a -= 2.0 * pi if a > 0.0 else -2.0 * pi
        elif edge > 0:
            sight = (vp * sin(a) - ve * sin(psi)) / r
            psi, side, branch = leave(
                psi,
                sight,
                side,
                branch,
                -1 if edge == 1 else 1,
                angle,
                keeps_side,
                ke,
            )
    return r, a, psi, side, branch, best, best_time, -1.0
