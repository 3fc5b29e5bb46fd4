"""One step of one game past edges, closest approach and capture.

A step that meets an edge of its smooth piece (:mod:`.modes`), that holds the
closest approach or the capture, or that is long against the distance is cut
there, and each part is one step of :func:`.motion.rk4`.
"""

from enum import IntEnum
from math import pi
from typing import Any, NamedTuple

from .compilation import inlined, shared
from .game_parameters import FlatParameters
from .relative_motion import RelativeState, SightGeometry, look, look_anew, rk4
from .smooth_pieces import Branch, Edge, Mode, SmoothPiece, leave, piece_of

TURN_PER_STEP = 0.04  # longest step, in distances per sum of the speeds
_SLACK = 1e-12  # how far beyond an edge counts as left


class Event(IntEnum):
    """What a step may be cut at."""

    NONE = -1
    WRAP = 0  # the pursuer's error passes pi
    LOW = 1  # the bearing leaves its piece
    HIGH = 2
    RELEASE = 3  # the line of sight outruns the evader that slides on it
    CLOSEST = 4  # the distance stops falling
    CAPTURE = 5


EDGES = (Event.WRAP, Event.LOW, Event.HIGH, Event.RELEASE)
"""Events that end a piece."""


class StateView(NamedTuple):
    """A state and its view."""

    state: RelativeState
    seen: SightGeometry


class LocatedStep(NamedTuple):
    """A game after one step.

    Attributes:
        state: State at the end, or at the capture.
        mode: Mode then.
        closest: Least distance within the step, in [m].
        closest_time: When that was, from the start of the step, in [s].
        capture_time: When the capture was, likewise; -1 for none.
    """

    state: RelativeState
    mode: Mode
    closest: float
    closest_time: float
    capture_time: float


@inlined
def margin(
    event: Event, now: StateView, piece: SmoothPiece, rules: FlatParameters
) -> Any:
    """How far a state, or many, are from an event; zero there."""
    if event == Event.WRAP:
        return pi - abs(now.state.a)
    if event == Event.LOW:
        return now.state.psi - piece.low
    if event == Event.HIGH:
        return piece.high - now.state.psi
    if event == Event.CAPTURE:
        return now.state.r - rules.capture_distance
    if event == Event.RELEASE:
        return rules.evader_gain - abs(now.seen.sight)
    return -now.seen.opening


@inlined
def advance(
    now: StateView, time: float, piece: SmoothPiece, rules: FlatParameters
) -> StateView:
    """Advance on a piece by one step, with exact sines."""
    state = rk4(look_anew, now.state, now.seen, time, piece, rules)
    return StateView(state, look(state, rules))


@shared
def time_of(
    event: Event,
    now: StateView,
    step: float,
    piece: SmoothPiece,
    rules: FlatParameters,
) -> float:
    """Part of a step until an event's margin falls to zero, in [s].

    By false position, where the value at an end that stays twice is halved
    (Illinois). From an edge a game may come in first and then leave.
    """
    short, long = 0.0, step
    above: float = margin(event, now, piece, rules)
    for halvings in range(1, 49):
        if above > 0.0:
            break
        short = step * 0.5**halvings
        above = margin(event, advance(now, short, piece, rules), piece, rules)
    if above <= 0.0:
        return 0.0
    below: float = margin(
        event, advance(now, long, piece, rules), piece, rules
    )
    moved = 0  # which end was moved last
    for _ in range(60):
        middle = (short * below - long * above) / (below - above)
        if not short < middle < long:
            break
        m = margin(event, advance(now, middle, piece, rules), piece, rules)
        if abs(m) < 1e-15:
            return float(middle)
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
def first_edge(
    now: StateView,
    step: float,
    mode: Mode,
    piece: SmoothPiece,
    rules: FlatParameters,
) -> tuple[Event, float, StateView]:
    """The first end of a piece within a step, its time, and what is then."""
    edge, part = Event.NONE, step
    then = advance(now, part, piece, rules)
    for event in EDGES:
        if event == Event.RELEASE and mode.branch != Branch.SLIDING:
            continue
        if margin(event, then, piece, rules) < -_SLACK:
            edge, part = event, time_of(event, now, part, piece, rules)
            then = advance(now, part, piece, rules)
    return edge, part, then


@shared
def nearest(
    now: StateView,
    then: StateView,
    step: float,
    piece: SmoothPiece,
    rules: FlatParameters,
) -> tuple[float, float]:
    """Least distance of a step, but for its start, and its time."""
    if not now.seen.opening < 0.0 < then.seen.opening:
        return then.state.r, step
    time = time_of(Event.CLOSEST, now, step, piece, rules)
    return advance(now, time, piece, rules).state.r, time


@inlined
def cross(
    event: Event, state: RelativeState, mode: Mode, rules: FlatParameters
) -> tuple[RelativeState, Mode]:
    """Pass an edge: state and mode on its other side."""
    r, a, psi = state
    if event == Event.WRAP:
        return RelativeState(
            r, a - 2.0 * pi if a > 0.0 else a + 2.0 * pi, psi
        ), mode
    edge = Edge.LOW if event == Event.LOW else Edge.HIGH
    psi, mode = leave(psi, look(state, rules).sight, mode, edge, rules)
    return RelativeState(r, a, psi), mode


@shared
def event_located_step(
    state: RelativeState, mode: Mode, step: float, rules: FlatParameters
) -> LocatedStep:
    """Advance a game by one step, however many pieces it takes."""
    done = 0.0
    best, best_time = state.r, 0.0
    speeds = rules.pursuer_speed + rules.evader_speed
    now = StateView(state, look(state, rules))
    while done < step:
        piece = piece_of(mode, rules)
        reach = min(step - done, TURN_PER_STEP * now.state.r / speeds)
        edge, part, then = first_edge(now, reach, mode, piece, rules)
        near, when = nearest(now, then, part, piece, rules)
        if near <= rules.capture_distance:
            when = time_of(Event.CAPTURE, now, when, piece, rules)
            state = advance(now, when, piece, rules).state
            done += when
            return LocatedStep(state, mode, state.r, done, done)
        if near < best:
            best, best_time = near, done + when
        last = edge == Event.NONE and reach == step - done
        done = step if last else done + part
        if edge != Event.NONE:
            state, mode = cross(edge, then.state, mode, rules)
            then = StateView(state, look(state, rules))
        now = then
    return LocatedStep(now.state, mode, best, best_time, -1.0)
