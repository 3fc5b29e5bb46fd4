"""Many games side by side: how they lie in memory, and what plays them.

A block holds some games, quantity after quantity. What is done to every game
at every step has no branch, so that one text serves one game of a compiled
loop (``i`` a number) and all games of a block in NumPy (``i`` a slice). The
few games that need care in a step are flagged and done one by one by
:func:`.event_located.event_located_step`.
"""

from math import pi
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .compilation import inlined
from .event_location import TURN_PER_STEP, LocatedStep
from .game_parameters import FlatParameters
from .relative_motion import Look, LookNear, RelativeState, SightGeometry, rk4
from .smooth_pieces import Mode, SmoothPiece, branch_at, piece_of

Array = NDArray[np.float64]
NEAR = 0.02  # off a circle by less than 2 % and 0.02 rad is "on it"
LOOSE = 2.0 * TURN_PER_STEP  # a step longer than this is done with care
QUANTITIES = (
    *RelativeState._fields,
    *SightGeometry._fields,
    *("was_r", "was_a", "was_psi"),  # before the last step
    *SmoothPiece._fields,
    "step",  # its length, in [s]; 0 once the game is over
    "care",  # whether it is to be done again with care
    "side",
    "apart",  # whether the game is under way and off all circles
    *("settled", "closest", "closest_time", "capture_time"),
)


class BatchTiming(NamedTuple):
    """How long games are played.

    Attributes:
        steps: Number of steps.
        step: Length of each, in [s].
    """

    steps: int
    step: float


def block_type(size: int) -> np.dtype[Any]:
    """Layout of a block of so many games."""
    fields = [(name, np.float64, (size,)) for name in QUANTITIES]
    return np.dtype([*fields, ("branch", np.int64, (size,))])


@inlined
def needs_care(
    state: RelativeState,
    after: RelativeState,
    was: SightGeometry,
    now: SightGeometry,
    piece: SmoothPiece,
    step: Any,
    rules: FlatParameters,
) -> Any:
    """Whether a step holds an event, or is long against the distance."""
    turned = (was.opening < 0.0) & (now.opening >= 0.0)
    caught = after.r <= rules.capture_distance
    wrapped = abs(after.a) > pi
    left = (after.psi < piece.low) | (after.psi > piece.high)
    released = (1.0 - piece.free) * abs(now.sight) > rules.evader_gain
    speeds = rules.pursuer_speed + rules.evader_speed
    far = speeds * step > LOOSE * state.r
    return (turned | caught | wrapped | left | released | far) & (step > 0.0)


@inlined
def put_state(
    block: Any, i: Any, state: RelativeState, view: SightGeometry
) -> None:
    """Write states of games, and their views, into a block."""
    block.r[i], block.a[i], block.psi[i] = state
    block.sin_a[i], block.cos_a[i] = view.sin_a, view.cos_a
    block.sin_psi[i], block.cos_psi[i] = view.sin_psi, view.cos_psi
    block.opening[i], block.sight[i] = view.opening, view.sight


@inlined
def step_games(
    look_near: LookNear,
    look: Look,
    block: Any,
    i: Any,
    rules: FlatParameters,
) -> Any:
    """Do one step of some games of a block; tell which need care."""
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
    after = rk4(look_near, state, was, step, piece, rules)
    now = look(after, rules)
    care = needs_care(state, after, was, now, piece, step, rules)
    block.was_r[i], block.was_a[i], block.was_psi[i] = state
    put_state(block, i, after, now)
    block.care[i] = care
    block.apart[i] = step > 0.0
    return care


@inlined
def deviations(
    state: RelativeState, side: Any, circle: RelativeState
) -> RelativeState:
    """How far states are off a circle.

    Args:
        state: States of games.
        side: Their sides.
        circle: State on the circle at side +1.

    Returns:
        Deviations of r, as a share of the circle's, and of a, psi, in
        [rad]; none is negative.
    """
    return RelativeState(
        abs(state.r * (1.0 / circle.r) - 1.0),
        abs(side * state.a - circle.a),
        abs(side * state.psi - circle.psi),
    )


@inlined
def compare_games(block: Any, i: Any, circle: RelativeState) -> None:
    """Tell games of a block that are off one more circle from those on it."""
    state = RelativeState(block.r[i], block.a[i], block.psi[i])
    off = deviations(state, block.side[i], circle)
    apart = (off.r > NEAR) | (off.a > NEAR) | (off.psi > NEAR)
    block.apart[i] = (block.apart[i] > 0.0) & apart


@inlined
def settle_games(block: Any, i: Any, time: float) -> None:
    """Take note of the time where games under way are off all circles."""
    block.settled[i] = np.maximum(block.settled[i], block.apart[i] * time)


@inlined
def before_step(block: Any, i: int) -> tuple[RelativeState, Mode]:
    """State and mode of one game before its last step."""
    r, a, psi = block.was_r[i], block.was_a[i], block.was_psi[i]
    mode = Mode(int(block.side[i]), branch_at(block.branch[i]))
    return RelativeState(float(r), float(a), float(psi)), mode


@inlined
def take_over(
    look: Look,
    block: Any,
    i: int,
    begin: float,
    done: LocatedStep,
    rules: FlatParameters,
) -> None:
    """Put a step of one game that was done with care into its block.

    Args:
        look: How a state is viewed.
        block: See :func:`block_type`.
        i: Place of the game in it.
        begin: Time at the start of the step, in [s].
        done: The game after the step.
        rules: Rules of the game.
    """
    state, mode = done.state, done.mode
    put_state(block, i, state, look(state, rules))
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
