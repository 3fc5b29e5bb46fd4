"""Data layout and time step of many games.

A block is a structure of arrays over some games. Operations on every game at
every step have no branches, so that one definition serves one game of a
compiled loop (``i`` is an index) and all games of a block in NumPy (``i`` is
a slice). The few games with an event in a step are flagged and repeated one
by one by :func:`.event_location.event_located_step`.
"""

from math import pi
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.compilation import inlined
from .event_location import TURN_PER_STEP, LocatedStep
from .game_parameters import FlatParameters
from .piecewise_dynamics import Mode, SmoothPiece, branch_from_code, piece_of
from .relative_motion import (
    GeometryFunction,
    NearbyGeometry,
    RelativeState,
    SightGeometry,
    rk4,
)

Array = NDArray[np.float64]
NEAR = 0.02  # tolerance of being on a circle: 2 % and 0.02 rad
LONG_STEP = 2.0 * TURN_PER_STEP  # steps above this are divided
QUANTITIES = (
    *RelativeState._fields,
    *SightGeometry._fields,
    *("was_r", "was_a", "was_psi"),  # before the last step
    *SmoothPiece._fields,
    "step",  # step size, in [s]; 0 once the game is over
    "flagged",  # whether the step has to be repeated with event location
    "side",
    "apart",  # whether the game is running and off all circles
    *("settled", "closest", "closest_time", "capture_time"),
)


class BatchTiming(NamedTuple):
    """Duration of games.

    Attributes:
        steps: Number of steps.
        step: Step size, in [s].
    """

    steps: int
    step: float


def block_type(size: int) -> np.dtype[Any]:
    """Return the data type of a block of ``size`` games."""
    fields = [(name, np.float64, (size,)) for name in QUANTITIES]
    return np.dtype([*fields, ("branch", np.int64, (size,))])


@inlined
def needs_location(
    state: RelativeState,
    after: RelativeState,
    was: SightGeometry,
    now: SightGeometry,
    piece: SmoothPiece,
    step: Any,
    rules: FlatParameters,
) -> Any:
    """Return whether a step has an event, or is long for the distance."""
    turned = (was.opening < 0.0) & (now.opening >= 0.0)
    captured = after.r <= rules.capture_distance
    wrapped = abs(after.a) > pi
    left = (after.psi < piece.low) | (after.psi > piece.high)
    released = (1.0 - piece.free) * abs(now.sight) > rules.evader_gain
    speeds = rules.pursuer_speed + rules.evader_speed
    far = speeds * step > LONG_STEP * state.r
    event = turned | captured | wrapped | left | released | far
    return event & (step > 0.0)


@inlined
def store_state(
    block: Any, i: Any, state: RelativeState, geometry: SightGeometry
) -> None:
    """Write states of games, and their geometry, into a block."""
    block.r[i], block.a[i], block.psi[i] = state
    block.sin_a[i], block.cos_a[i] = geometry.sin_a, geometry.cos_a
    block.sin_psi[i], block.cos_psi[i] = geometry.sin_psi, geometry.cos_psi
    block.opening[i], block.sight[i] = geometry.opening, geometry.sight


@inlined
def step_games(
    nearby_geometry: NearbyGeometry,
    geometry_of: GeometryFunction,
    block: Any,
    i: Any,
    rules: FlatParameters,
) -> Any:
    """Advance games of a block by one step; return which have events."""
    state = RelativeState(block.r[i], block.a[i], block.psi[i])
    was = SightGeometry(
        block.sin_a[i],
        block.cos_a[i],
        block.sin_psi[i],
        block.cos_psi[i],
        block.opening[i],
        block.sight[i],
    )
    piece = SmoothPiece(
        block.low[i],
        block.high[i],
        block.constant[i],
        block.slope[i],
        block.free[i],
    )
    step = block.step[i]
    after = rk4(nearby_geometry, state, was, step, piece, rules)
    now = geometry_of(after, rules)
    flagged = needs_location(state, after, was, now, piece, step, rules)
    block.was_r[i], block.was_a[i], block.was_psi[i] = state
    store_state(block, i, after, now)
    block.flagged[i] = flagged
    block.apart[i] = step > 0.0
    return flagged


@inlined
def deviations(
    state: RelativeState, side: Any, circle: RelativeState
) -> RelativeState:
    """Return the absolute deviations of states from a circle.

    Args:
        state: States of games.
        side: Their sides.
        circle: State on the circle at side +1.

    Returns:
        Deviations of r, relative to the circle's, and of a, psi, in [rad].
    """
    return RelativeState(
        abs(state.r * (1.0 / circle.r) - 1.0),
        abs(side * state.a - circle.a),
        abs(side * state.psi - circle.psi),
    )


@inlined
def compare_with_circle(block: Any, i: Any, circle: RelativeState) -> None:
    """Clear ``apart`` of the games of a block that are on a circle."""
    state = RelativeState(block.r[i], block.a[i], block.psi[i])
    off = deviations(state, block.side[i], circle)
    apart = (off.r > NEAR) | (off.a > NEAR) | (off.psi > NEAR)
    block.apart[i] = (block.apart[i] > 0.0) & apart


@inlined
def update_settling_times(block: Any, i: Any, time: float) -> None:
    """Update the last time at which games are off all circles."""
    block.settled[i] = np.maximum(block.settled[i], block.apart[i] * time)


@inlined
def state_before_step(block: Any, i: int) -> tuple[RelativeState, Mode]:
    """Return state and mode of one game before its last step."""
    r, a, psi = block.was_r[i], block.was_a[i], block.was_psi[i]
    mode = Mode(int(block.side[i]), branch_from_code(block.branch[i]))
    return RelativeState(float(r), float(a), float(psi)), mode


@inlined
def store_located_step(
    geometry_of: GeometryFunction,
    block: Any,
    i: int,
    begin: float,
    done: LocatedStep,
    rules: FlatParameters,
) -> None:
    """Store a step with event location of one game in its block.

    Args:
        geometry_of: Computes the geometry of a state.
        block: Block of type :func:`block_type`.
        i: Index of the game.
        begin: Time at the begin of the step, in [s].
        done: The game after the step.
        rules: Rules of the game.
    """
    state, mode = done.state, done.mode
    store_state(block, i, state, geometry_of(state, rules))
    block.side[i], block.branch[i] = mode.side, mode.branch
    piece = piece_of(mode, rules)
    block.low[i], block.high[i] = piece.low, piece.high
    block.constant[i], block.slope[i] = piece.constant, piece.slope
    block.free[i] = piece.free
    if done.closest < block.closest[i]:
        block.closest[i] = done.closest
        block.closest_time[i] = begin + done.closest_time
    if done.capture_time >= 0.0:
        block.capture_time[i] = begin + done.capture_time
        block.step[i] = 0.0
