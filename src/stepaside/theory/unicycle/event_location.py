"""Location of events within one step of one game.

A step that crosses an edge of its smooth piece (:mod:`.piecewise_dynamics`),
that contains the closest approach or the capture, or that is long relative to
the distance is divided there; each part is one step of
:func:`.relative_motion.rk4`.
"""

from enum import IntEnum
from math import pi
from typing import Any, NamedTuple

from ...core.compilation import inlined, shared
from .game_parameters import FlatParameters
from .piecewise_dynamics import (
    Branch,
    Edge,
    Mode,
    SmoothPiece,
    next_mode,
    piece_of,
)
from .relative_motion import (
    RelativeState,
    SightGeometry,
    geometry_of,
    recomputed_geometry,
    rk4,
)

TURN_PER_STEP = 0.04  # longest step, in distances per sum of the speeds
_SLACK = 1e-12  # margin below which an edge has been crossed


class Event(IntEnum):
    """Events at which a step is divided."""

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
    """State with its geometry."""

    state: RelativeState
    geometry: SightGeometry


class LocatedStep(NamedTuple):
    """State of a game after one step, with the events of the step.

    Attributes:
        state: State at the end, or at the capture.
        mode: Mode at that time.
        closest: Closest approach within the step, in [m].
        closest_time: Its time since the begin of the step, in [s].
        capture_time: Time of the capture since the begin of the step, in
            [s]; -1 for none.
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
    """Return the margin of one or many states to an event; zero there."""
    if event == Event.WRAP:
        return pi - abs(now.state.a)
    if event == Event.LOW:
        return now.state.psi - piece.low
    if event == Event.HIGH:
        return piece.high - now.state.psi
    if event == Event.CAPTURE:
        return now.state.r - rules.capture_distance
    if event == Event.RELEASE:
        return rules.evader_gain - abs(now.geometry.sight)
    return -now.geometry.opening


@inlined
def advance(
    now: StateView, time: float, piece: SmoothPiece, rules: FlatParameters
) -> StateView:
    """Advance on a smooth piece by one step, with exact sines."""
    state = rk4(
        recomputed_geometry, now.state, now.geometry, time, piece, rules
    )
    return StateView(state, geometry_of(state, rules))


@shared
def time_of(
    event: Event,
    now: StateView,
    step: float,
    piece: SmoothPiece,
    rules: FlatParameters,
) -> float:
    """Return the time within a step at which a margin reaches zero, in [s].

    The root is found by the Illinois variant of false position. A game that
    starts on an edge may first enter the piece and then leave it.
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
    moved = 0  # the end that was moved last
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
    """Return the first edge crossed in a step, its time and its state."""
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
    """Return the closest approach after the begin of a step, and its time."""
    if not now.geometry.opening < 0.0 < then.geometry.opening:
        return then.state.r, step
    time = time_of(Event.CLOSEST, now, step, piece, rules)
    return advance(now, time, piece, rules).state.r, time


@inlined
def cross(
    event: Event, state: RelativeState, mode: Mode, rules: FlatParameters
) -> tuple[RelativeState, Mode]:
    """Return state and mode on the other side of an edge."""
    r, a, psi = state
    if event == Event.WRAP:
        return RelativeState(
            r, a - 2.0 * pi if a > 0.0 else a + 2.0 * pi, psi
        ), mode
    edge = Edge.LOW if event == Event.LOW else Edge.HIGH
    psi, mode = next_mode(
        psi, geometry_of(state, rules).sight, mode, edge, rules
    )
    return RelativeState(r, a, psi), mode


@shared
def event_located_step(
    state: RelativeState, mode: Mode, step: float, rules: FlatParameters
) -> LocatedStep:
    """Advance a game by one step, across any number of smooth pieces.

    Args:
        state: State at the begin of the step.
        mode: Mode at the begin of the step.
        step: Step size, in [s].
        rules: Rules of the game.
    """
    done = 0.0
    best, best_time = state.r, 0.0
    speeds = rules.pursuer_speed + rules.evader_speed
    now = StateView(state, geometry_of(state, rules))
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
            then = StateView(state, geometry_of(state, rules))
        now = then
    return LocatedStep(now.state, mode, best, best_time, -1.0)
