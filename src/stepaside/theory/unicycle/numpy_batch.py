"""Many games at once in NumPy, where nothing is compiled."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from .compilation import compiled
from .compiled_batch import locate
from .event_location import LocatedStep
from .game_batch import (
    Array,
    BatchTiming,
    before_step,
    compare_games,
    settle_games,
    step_games,
    take_over,
)
from .game_parameters import FlatParameters
from .relative_motion import RelativeState, SightGeometry, look, look_many
from .smooth_pieces import Mode, branch_at

_ALL = slice(None)


def look_near(
    state: RelativeState,
    near: RelativeState,
    view: SightGeometry,
    rules: FlatParameters,
) -> SightGeometry:
    """View of states, whatever is known nearby."""
    return look_many(state, rules)


@compiled
def _plain_locate(
    state: tuple[float, ...],
    side: int,
    code: int,
    step: float,
    rules: tuple[Any, ...],
) -> tuple[tuple[float, ...], tuple[int, int], float, float, float]:
    """Do an event-located step from and to plain tuples.

    Python hands them to compiled code a hundred times faster than named
    ones.
    """
    mode = Mode(side, branch_at(code))
    done = locate(RelativeState(*state), mode, step, FlatParameters(*rules))
    return (
        (done.state.r, done.state.a, done.state.psi),
        (done.mode.side, done.mode.branch.value),
        done.closest,
        done.closest_time,
        done.capture_time,
    )


def step_again(block: Any, i: int, rules: FlatParameters) -> LocatedStep:
    """Do the last step of one game again, from event to event."""
    state, mode = before_step(block, i)
    step, code = float(block.step[i]), mode.branch.value
    numbers, (side, code), *times = _plain_locate(
        tuple(state), mode.side, code, step, tuple(rules)
    )
    return LocatedStep(
        RelativeState(*numbers), Mode(side, branch_at(code)), *times
    )


def step_block(
    block: Any, circles: Array, begin: float, end: float, rules: FlatParameters
) -> None:
    """Do one step of every game of a block."""
    care = step_games(look_near, look_many, block, _ALL, rules)
    for circle in circles.tolist():
        compare_games(block, _ALL, RelativeState(*circle))
    settle_games(block, _ALL, end)
    for i in np.flatnonzero(care).tolist():
        done = step_again(block, i, rules)
        take_over(look, block, i, begin, done, rules)


def play_blocks(
    blocks: Any, circles: Array, clock: BatchTiming, rules: FlatParameters
) -> None:
    """Play all games to the end; twin of the compiled ``play_blocks``."""
    names = blocks.dtype.names
    with np.errstate(all="ignore"):
        for row in blocks:
            block = SimpleNamespace(**{name: row[name] for name in names})
            for n in range(clock.steps):
                begin, end = n * clock.step, (n + 1) * clock.step
                step_block(block, circles, begin, end, rules)
