"""Compiled loop of many games, one after the other, on all cores.

A step of the integration that crosses an edge of its smooth piece
(:mod:`.relative_motion`), that contains the closest approach or the capture,
or that is long relative to the distance is divided there.
"""

from typing import Any, NamedTuple

from ...core.compilation import (
    compiled,
    compiled_parallel,
    inlined,
    parallel_range,
    shared,
)
from .relative_motion import (
    NEAR,
    SLACK,
    Mode,
    Rates,
    RelativeState,
    Rules,
    SmoothPiece,
    cross,
    deviation,
    edge_margin,
    initial_mode,
    piece_of,
    rates_of,
    rk4,
)

prange = parallel_range()
TURN_PER_STEP = 0.04  # longest step, in distances per sum of the speeds
EDGE, CLOSEST, CAPTURE = 0, 1, 2  # events at which a step is divided


class _Step(NamedTuple):
    """A game after one step, or at the capture within it.

    The closest approach of the step is in [m], its time ``when`` since the
    begin of the step in [s].
    """

    state: RelativeState
    mode: Mode
    closest: float
    when: float
    captured: bool


@inlined
def _margin(
    event: int,
    state: RelativeState,
    rates: Rates,
    piece: SmoothPiece,
    rules: Rules,
) -> float:
    """Return the margin of a state to an event, negative beyond it."""
    if event == EDGE:
        return float(edge_margin(state, rates, piece, rules))
    if event == CAPTURE:
        return float(state.r - rules.capture_distance)
    return float(-rates.r)


@shared
def _margin_after(
    time: float,
    event: int,
    state: RelativeState,
    rates: Rates,
    piece: SmoothPiece,
    rules: Rules,
) -> float:
    """Return the margin to an event after a time on a smooth piece."""
    then = rk4(state, rates, time, piece, rules)
    return _margin(event, then, rates_of(then, piece, rules), piece, rules)


@shared
def _time_of(
    event: int,
    state: RelativeState,
    rates: Rates,
    step: float,
    piece: SmoothPiece,
    rules: Rules,
) -> float:
    """Return the time within a step at which a margin reaches zero, in [s].

    The root is found by the Illinois variant of false position. A game that
    starts on an edge may first enter the piece and then leave it.
    """
    short, above = 0.0, _margin(event, state, rates, piece, rules)
    for halvings in range(1, 49):
        if above > 0.0:
            break
        short = step * 0.5**halvings
        above = _margin_after(short, event, state, rates, piece, rules)
    if above <= 0.0:
        return 0.0
    long = step
    below = _margin_after(long, event, state, rates, piece, rules)
    moved = 0  # the end that was moved last
    for _ in range(60):
        middle = (short * below - long * above) / (below - above)
        if not short < middle < long:
            break
        m = _margin_after(middle, event, state, rates, piece, rules)
        if abs(m) < 1e-15:
            return middle
        if m > 0.0:
            short, above = middle, m
            below *= 0.5 if moved == 1 else 1.0
            moved = 1
        else:
            long, below = middle, m
            above *= 0.5 if moved == -1 else 1.0
            moved = -1
    return long


@shared
def _located_step(
    state: RelativeState, mode: Mode, step: float, rules: Rules
) -> _Step:
    """Advance a game by one step, across any number of smooth pieces."""
    done, best, when = 0.0, state.r, 0.0
    speeds = rules.pursuer_speed + rules.evader_speed
    piece = piece_of(mode, rules)
    rates = rates_of(state, piece, rules)
    while done < step:
        part = min(step - done, TURN_PER_STEP * state.r / speeds)
        last = part == step - done
        then = rk4(state, rates, part, piece, rules)
        after = rates_of(then, piece, rules)
        leaves = edge_margin(then, after, piece, rules) < -SLACK
        if leaves:
            part = _time_of(EDGE, state, rates, part, piece, rules)
            then = rk4(state, rates, part, piece, rules)
            after = rates_of(then, piece, rules)
        near, time = then.r, part
        if rates.r < 0.0 < after.r:
            time = _time_of(CLOSEST, state, rates, part, piece, rules)
            near = rk4(state, rates, time, piece, rules).r
        if near <= rules.capture_distance:
            time = _time_of(CAPTURE, state, rates, time, piece, rules)
            state = rk4(state, rates, time, piece, rules)
            return _Step(state, mode, state.r, done + time, True)
        if near < best:
            best, when = near, done + time
        state, rates, done = then, after, done + part
        if leaves:
            state, mode = cross(state, mode, rules)
            piece = piece_of(mode, rules)
            rates = rates_of(state, piece, rules)
        elif last:
            break
    return _Step(state, mode, best, when, False)


@compiled
def _play_one(
    played: Any,
    side: int,
    circles: Any,
    steps: int,
    step: float,
    rules: Rules,
) -> None:
    """Play a game to the end; see :func:`play_all`."""
    state = RelativeState(played[0], played[1], played[2])
    state, mode = initial_mode(state, side, rules)
    closest, when, settled, captured = state.r, 0.0, 0.0, -1.0
    if closest <= rules.capture_distance:
        steps, captured = 0, 0.0
    for n in range(steps):
        done = _located_step(state, mode, step, rules)
        state, mode = done.state, done.mode
        if done.closest < closest:
            closest, when = done.closest, n * step + done.when
        if done.captured:
            captured = n * step + done.when
            break
        apart = True
        for c in range(len(circles)):
            circle = RelativeState(circles[c, 0], circles[c, 1], circles[c, 2])
            apart &= deviation(state, mode.side, circle) > NEAR
        if apart:
            settled = (n + 1) * step
    played[0], played[1], played[2] = state.r, state.a, state.psi
    played[3], played[4], played[5] = mode.side, closest, when
    played[6], played[7] = captured, settled


@compiled_parallel
def play_all(
    played: Any,
    side: int,
    circles: Any,
    steps: int,
    step: float,
    rules: Rules,
) -> None:
    """Play games to the end, on all cores.

    Rows of r [m], a, psi [rad] in ``played``, shape (n, 8), are overwritten
    by the final ones, with the side, closest approach [m], its time, the
    time of capture, -1 for none, and the last time off all circles [s].
    Circles are rows of r [m], a, psi [rad] at side +1. Shape (m, 3).
    """
    for i in prange(len(played)):
        _play_one(played[i], side, circles, steps, step, rules)
