"""Simulation of many games in NumPy, for installations without Numba."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from ...core.compilation import compiled
from .compiled_batch import locate
from .event_location import LocatedStep
from .game_batch import (
    Array,
    BatchTiming,
    compare_with_circle,
    state_before_step,
    step_games,
    store_located_step,
    update_settling_times,
)
from .game_parameters import FlatParameters
from .piecewise_dynamics import Mode, branch_from_code
from .relative_motion import (
    RelativeState,
    SightGeometry,
    geometry_of,
    geometry_of_arrays,
)

_ALL = slice(None)


def nearby_geometry(
    state: RelativeState,
    near: RelativeState,
    geometry: SightGeometry,
    rules: FlatParameters,
) -> SightGeometry:
    """Return the geometry of states, ignoring the nearby one."""
    return geometry_of_arrays(state, rules)


@compiled
def _plain_locate(
    state: tuple[float, ...],
    side: int,
    code: int,
    step: float,
    rules: tuple[Any, ...],
) -> tuple[tuple[float, ...], tuple[int, int], float, float, float]:
    """Compute a step with event location, from and to plain tuples.

    Passing plain tuples to compiled code is a hundred times faster than
    passing named tuples.
    """
    mode = Mode(side, branch_from_code(code))
    done = locate(RelativeState(*state), mode, step, FlatParameters(*rules))
    return (
        (done.state.r, done.state.a, done.state.psi),
        (done.mode.side, done.mode.branch.value),
        done.closest,
        done.closest_time,
        done.capture_time,
    )


def repeat_step(block: Any, i: int, rules: FlatParameters) -> LocatedStep:
    """Repeat the last step of one game with event location."""
    state, mode = state_before_step(block, i)
    step, code = float(block.step[i]), mode.branch.value
    numbers, (side, code), *times = _plain_locate(
        tuple(state), mode.side, code, step, tuple(rules)
    )
    return LocatedStep(
        RelativeState(*numbers), Mode(side, branch_from_code(code)), *times
    )


def step_block(
    block: Any, circles: Array, begin: float, end: float, rules: FlatParameters
) -> None:
    """Advance every game of a block by one step."""
    flagged = step_games(
        nearby_geometry, geometry_of_arrays, block, _ALL, rules
    )
    for circle in circles.tolist():
        compare_with_circle(block, _ALL, RelativeState(*circle))
    update_settling_times(block, _ALL, end)
    for i in np.flatnonzero(flagged).tolist():
        done = repeat_step(block, i, rules)
        store_located_step(geometry_of, block, i, begin, done, rules)


def play_blocks(
    blocks: Any, circles: Array, clock: BatchTiming, rules: FlatParameters
) -> None:
    """Play all games to the end; see :func:`.compiled_batch.play_blocks`."""
    names = blocks.dtype.names
    with np.errstate(all="ignore"):
        for row in blocks:
            block = SimpleNamespace(**{name: row[name] for name in names})
            for n in range(clock.steps):
                begin, end = n * clock.step, (n + 1) * clock.step
                step_block(block, circles, begin, end, rules)
