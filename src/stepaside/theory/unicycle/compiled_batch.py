"""Compiled simulation of many games, in blocks that fit the cache.

The loop over the games of a block has no branches, so that the compiler
vectorises it; sines are polynomials for the same reason.
"""

from typing import Any

from ...core.compilation import (
    compiled,
    compiled_parallel,
    inlined,
    parallel_range,
)
from .event_location import event_located_step
from .game_batch import (
    BatchTiming,
    compare_with_circle,
    state_before_step,
    step_games,
    store_located_step,
    update_settling_times,
)
from .game_parameters import FlatParameters
from .relative_motion import RelativeState, SightGeometry, geometry_from_sines

SIZE = 128  # games in a block
prange = parallel_range()
locate = compiled(event_located_step)
_ROUND = 6755399441055744.0  # 1.5 * 2**52: adding it rounds to an integer


@inlined
def sine_cosine(x: float) -> tuple[float, float]:
    """Return sine and cosine to 2e-16 for moderate angles, branch-free."""
    q = (x * 0.3183098861837907 + _ROUND) - _ROUND
    y = (x - q * 3.141592653589793) - q * 1.2246467991473532e-16
    half = q - 2.0 * ((q * 0.5 + _ROUND) - _ROUND)
    sign = 1.0 - 2.0 * half * half
    z = y * y
    # Estrin's scheme: short dependency chains use the vector units better.
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


@inlined
def turn(s: float, c: float, x: float) -> tuple[float, float]:
    """Update a sine and a cosine by a small angle, within a step."""
    z = x * x
    sx = 8.333333333333333e-03 - z * 1.984126984126984e-04
    sx = -1.6666666666666666e-01 + z * (sx + z * z * 2.7557319223985893e-06)
    cx = -1.388888888888889e-03 + z * 2.48015873015873e-05
    cx = z * (-0.5 + z * (4.1666666666666664e-02 + z * cx))
    sx = x + x * (z * sx)
    return s + (s * cx + c * sx), c + (c * cx - s * sx)


@inlined
def geometry_of(state: RelativeState, rules: FlatParameters) -> SightGeometry:
    """Return the geometry of a state, branch-free."""
    sin_a, cos_a = sine_cosine(state.a)
    sin_psi, cos_psi = sine_cosine(state.psi)
    return geometry_from_sines(state.r, sin_a, cos_a, sin_psi, cos_psi, rules)


@inlined
def nearby_geometry(
    state: RelativeState,
    near: RelativeState,
    geometry: SightGeometry,
    rules: FlatParameters,
) -> SightGeometry:
    """Return the geometry of a state within a step of another state."""
    sin_a, cos_a = turn(geometry.sin_a, geometry.cos_a, state.a - near.a)
    sin_psi, cos_psi = turn(
        geometry.sin_psi, geometry.cos_psi, state.psi - near.psi
    )
    return geometry_from_sines(state.r, sin_a, cos_a, sin_psi, cos_psi, rules)


@compiled
def step_block(
    block: Any, circles: Any, begin: float, end: float, rules: FlatParameters
) -> None:
    """Advance every game of a block by one step."""
    flagged = 0
    for i in range(SIZE):
        has_event = step_games(nearby_geometry, geometry_of, block, i, rules)
        flagged += 1 if has_event else 0
    for c in range(len(circles)):
        circle = RelativeState(circles[c, 0], circles[c, 1], circles[c, 2])
        for i in range(SIZE):
            compare_with_circle(block, i, circle)
    for i in range(SIZE):
        update_settling_times(block, i, end)
    if flagged > 0:
        for i in range(SIZE):
            if block.flagged[i] > 0.0:
                state, mode = state_before_step(block, i)
                done = locate(state, mode, block.step[i], rules)
                store_located_step(geometry_of, block, i, begin, done, rules)


@compiled_parallel
def play_blocks(
    blocks: Any, circles: Any, clock: BatchTiming, rules: FlatParameters
) -> None:
    """Play all games to the end, blocks in parallel.

    Args:
        blocks: See :func:`.game_batch.block_type`. Shape (n,).
        circles: Rows of r [m], a, psi [rad] at side +1. Shape (m, 3).
        clock: Number of steps and step size.
        rules: Rules of the game.
    """
    for number in prange(len(blocks)):
        block = blocks[number]
        for n in range(clock.steps):
            begin, end = n * clock.step, (n + 1) * clock.step
            step_block(block, circles, begin, end, rules)
