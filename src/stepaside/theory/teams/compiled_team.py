"""Compiled simulation of games of several unicycles, in blocks.

Loops over the games of a block have no branches, so that the compiler
vectorises them. Bearings of targets are states of the integration; each step
begins with a correction of the bearing by the sine of its error, and only a
change of the target needs an inverse tangent.
"""

from math import atan2
from typing import Any

import numpy as np

from ...core.compilation import compiled, compiled_parallel, parallel_range
from ...core.poses import Array
from ..unicycle.compiled_batch import sine_cosine, turn
from .team_players import TeamRules

SIZE = 64  # games in a block
prange = parallel_range()
TINY = 1e-4  # error of a bearing whose tangent is taken for it, in [rad]
TAU, ROUND = 6.283185307179586, 6755399441055744.0


@compiled
def choose_targets(block: Any, targets: Any, rules: Any) -> None:
    """Set the targets of players that play against the nearest opponent.

    Args:
        block: States of a block, see :func:`play_blocks`.
        targets: Targets now; the bearings of new targets are computed.
            Shape (players, SIZE).
        rules: Rows of velocity, gain, angle, fixed target and evasion.
    """
    x, y, sight = block[0], block[1], block[3]
    least, best = np.empty(SIZE), np.empty(SIZE)
    for i in range(x.shape[0]):
        if rules[i, 3] >= 0.0:
            continue
        least[:] = np.inf
        best[:] = -1.0
        for j in range(x.shape[0]):
            if rules[j, 4] != rules[i, 4]:
                nearer_of(x[i], y[i], x[j], y[j], float(j), least, best)
        for g in range(SIZE):
            found = int(best[g])
            if found != targets[i, g]:
                targets[i, g] = found
                dx, dy = x[found, g] - x[i, g], y[found, g] - y[i, g]
                sight[i, g] = atan2(dy, dx)


@compiled
def nearer_of(
    x: Any, y: Any, u: Any, v: Any, number: float, least: Any, best: Any
) -> None:
    """Take another player as the nearest one where it is nearer."""
    for g in range(SIZE):
        dx, dy = u[g] - x[g], v[g] - y[g]
        square = dx * dx + dy * dy
        best[g] = number if square < least[g] else best[g]
        least[g] = square if square < least[g] else least[g]


@compiled
def gather(rows: Any, targets: Any, found: Any) -> None:
    """Copy the first four rows of each game's target. Shape (4, SIZE)."""
    for g in range(SIZE):
        t = targets[g]
        for k in range(4):
            found[k, g] = rows[k, t, g]


@compiled
def correct_bearing(
    x: Any, y: Any, target_x: Any, target_y: Any, sight: Any, far: Any
) -> float:
    """Correct bearings to the directions of targets; return how many are far.

    Args:
        x: Own positions, in [m]. Shape (SIZE,).
        y: Likewise.
        target_x: Positions of the targets, in [m].
        target_y: Likewise.
        sight: Bearings, in [rad]; those that are far off stay.
        far: Output: 1 where the bearing is far off.
    """
    flagged = 0.0
    for g in range(SIZE):
        dx, dy = target_x[g] - x[g], target_y[g] - y[g]
        s, c = sine_cosine(sight[g])
        along = c * dx + s * dy
        error = (c * dy - s * dx) / along  # its tangent, as it is tiny
        off = (along <= 0.0) | (abs(error) > TINY)
        far[g] = 1.0 if off else 0.0
        flagged += far[g]
        sight[g] += 0.0 if off else error
    return flagged


@compiled
def initial_errors(
    theta: Any, sight: Any, sin0: Any, cos0: Any, shift: Any, angle: float
) -> None:
    """Compute sines, and errors less bearing plus heading, of a step."""
    for g in range(SIZE):
        sin0[g], cos0[g] = sine_cosine(theta[g])
        raw = sight[g] - theta[g]
        psi = raw - TAU * ((raw * (1.0 / TAU) + ROUND) - ROUND)
        side = -1.0 if psi > 0.0 else 1.0
        full = psi + side * angle
        wrapped = full - TAU * ((full * (1.0 / TAU) + ROUND) - ROUND)
        shift[g] = wrapped - raw


@compiled
def begin_step(
    block: Any, shift: Any, targets: Any, rules: Any, seen: Any
) -> None:
    """Correct the bearings, and compute sines and errors of a step.

    Args:
        block: States of a block.
        shift: Output: error less (bearing less heading). Shape (players,
            SIZE).
        targets: Targets. Shape (players, SIZE).
        rules: Parameters of the players.
        seen: Memory for the states of targets. Shape (4, SIZE).
    """
    x, y, theta, sight, sin0, cos0 = block[:6]
    for i in range(x.shape[0]):
        target, far = int(rules[i, 3]), seen[2]
        if target >= 0:
            seen[0], seen[1] = x[target], y[target]
        else:
            gather(block, targets[i], seen)
        flagged = correct_bearing(x[i], y[i], seen[0], seen[1], sight[i], far)
        for g in range(SIZE if flagged > 0.0 else 0):
            if far[g] > 0.0:
                dx, dy = seen[0, g] - x[i, g], seen[1, g] - y[i, g]
                sight[i, g] = atan2(dy, dx)
        initial_errors(
            theta[i], sight[i], sin0[i], cos0[i], shift[i], rules[i, 2]
        )


@compiled
def velocities(
    theta: Any,
    theta0: Any,
    sin0: Any,
    cos0: Any,
    u: Any,
    v: Any,
    velocity: float,
) -> None:
    """Compute the velocities at headings near those of known sines."""
    for g in range(SIZE):
        s, c = turn(sin0[g], cos0[g], theta[g] - theta0[g])
        u[g], v[g] = velocity * c, velocity * s


@compiled
def sight_rates(stage: Any, i: int, seen: Any, rate: Any) -> None:
    """Compute the rates of the bearings of targets, in [rad/s].

    Args:
        stage: Rows x, y, u, v, ... of all players. Shape (8, players, SIZE).
        i: Index of the player.
        seen: x, y, u, v of the targets. Shape (4, SIZE).
        rate: Output. Shape (SIZE,).
    """
    x, y, u, v = stage[0, i], stage[1, i], stage[2, i], stage[3, i]
    for g in range(SIZE):
        dx, dy = seen[0, g] - x[g], seen[1, g] - y[g]
        du, dv = seen[2, g] - u[g], seen[3, g] - v[g]
        rate[g] = (dx * dv - dy * du) / (dx * dx + dy * dy)


@compiled
def accumulate(total: Any, slope: Any, weight: float) -> None:
    """Add a weighted slope to a sum. Shapes (SIZE,)."""
    for g in range(SIZE):
        total[g] += weight * slope[g]


@compiled
def advance(value: Any, start: Any, slope: Any, ahead: float) -> None:
    """Set values ahead of their start at constant rates. Shapes (SIZE,)."""
    for g in range(SIZE):
        value[g] = start[g] + ahead * slope[g]


@compiled
def turning_rates(
    sight: Any, theta: Any, shift: Any, gain: float, turning: Any
) -> None:
    """Compute the turning rates by (2) and (4), in [rad/s]."""
    for g in range(SIZE):
        turning[g] = gain * (sight[g] - theta[g] + shift[g])


@compiled
def add_slope(
    block: Any,
    stage: Any,
    shift: Any,
    targets: Any,
    rules: Any,
    seen: Any,
    weight: float,
    ahead: float,
) -> None:
    """Add the slope of a stage to the sum, and set up the next stage.

    Args:
        block: States, sines and cosines at the begin of the step; rows 6 to
            9 hold the weighted sum of slopes.
        stage: x, y, velocities, heading, bearing of the stage, then turning
            rate and rate of the bearing. Shape (8, players, SIZE).
        shift: As :func:`begin_step`.
        targets: Targets.
        rules: Parameters of the players.
        seen: Memory for the states of targets. Shape (4, SIZE).
        weight: Weight of the slope.
        ahead: Time from the begin of the step to the next stage, in [s].
    """
    x, y, u, v, theta, sight, turning, rate = stage
    for i in range(x.shape[0]):
        velocities(
            theta[i],
            block[2, i],
            block[4, i],
            block[5, i],
            u[i],
            v[i],
            rules[i, 0],
        )
    for i in range(x.shape[0]):
        target = int(rules[i, 3])
        if target >= 0:
            for k in range(4):
                seen[k] = stage[k, target]
        else:
            gather(stage, targets[i], seen)
        sight_rates(stage, i, seen, rate[i])
        turning_rates(sight[i], theta[i], shift[i], rules[i, 1], turning[i])
    for i in range(x.shape[0]):
        accumulate(block[6, i], u[i], weight)
        accumulate(block[7, i], v[i], weight)
        accumulate(block[8, i], turning[i], weight)
        accumulate(block[9, i], rate[i], weight)
        advance(x[i], block[0, i], u[i], ahead)
        advance(y[i], block[1, i], v[i], ahead)
        advance(theta[i], block[2, i], turning[i], ahead)
        advance(sight[i], block[3, i], rate[i], ahead)


@compiled
def note_pairs(block: Any, least: Any) -> None:
    """Update the smallest squared distances of all pairs of a block."""
    x, y = block[0], block[1]
    pair = 0
    for i in range(x.shape[0]):
        for j in range(i):
            for g in range(SIZE):
                dx, dy = x[i, g] - x[j, g], y[i, g] - y[j, g]
                square = dx * dx + dy * dy
                before = least[pair, g]
                least[pair, g] = square if square < before else before
            pair += 1


@compiled_parallel
def play_blocks(
    blocks: Any, least: Any, rules: Any, steps: int, step: float
) -> None:
    """Play all games to the end, blocks in parallel.

    Args:
        blocks: x, y, heading, bearing of the target, sine and cosine of the
            heading, and the sums of slopes of the first four. Shape (blocks,
            10, players, SIZE).
        least: Smallest squared distance of each pair. Shape (blocks, pairs,
            SIZE).
        rules: Rows of velocity, gain, angle, fixed target or -1, and 1 for
            an evader. Shape (players, 5).
        steps: Number of steps.
        step: Step size, in [s].
    """
    count = rules.shape[0]
    for number in prange(len(blocks)):
        block = blocks[number]
        stage = np.empty((8, count, SIZE))
        shift, seen = np.empty((count, SIZE)), np.empty((4, SIZE))
        targets = np.empty((count, SIZE), np.int64)
        for i in range(count):
            targets[i] = int(rules[i, 3])
        note_pairs(block, least[number])
        for _ in range(steps):
            choose_targets(block, targets, rules)
            begin_step(block, shift, targets, rules, seen)
            stage[:2], stage[4:6] = block[:2], block[2:4]
            block[6:] = 0.0
            for k in range(4):
                weight = 1.0 if k in (0, 3) else 2.0
                ahead = 0.5 * step if k < 2 else step
                add_slope(
                    block, stage, shift, targets, rules, seen, weight, ahead
                )
            block[:4] += (step / 6.0) * block[6:]
            note_pairs(block, least[number])


def play_chunk(
    starts: Array, rules: TeamRules, steps: int, step: float
) -> tuple[Array, Array]:
    """Play games to the end; see :func:`.team_arrays.play_chunk`."""
    games, count = starts.shape[:2]
    padded = np.concatenate(
        [starts, np.repeat(starts[:1], -games % SIZE, axis=0)]
    )
    blocks = np.zeros((len(padded) // SIZE, 10, count, SIZE))
    rows = padded.reshape(-1, SIZE, count, 3).transpose(0, 3, 2, 1)
    blocks[:, :3] = rows
    flat = np.column_stack(
        [
            rules.velocities,
            rules.gains,
            rules.angles,
            rules.targets,
            rules.evades,
        ]
    ).astype(np.float64)
    for i, target in enumerate(rules.targets.tolist()):
        if target >= 0:
            dx = rows[:, 0, target] - rows[:, 0, i]
            dy = rows[:, 1, target] - rows[:, 1, i]
            blocks[:, 3, i] = np.arctan2(dy, dx)
    pairs = count * (count - 1) // 2
    least = np.full((len(blocks), pairs, SIZE), np.inf)
    play_blocks(blocks, least, flat, steps, step)
    closest = np.full((len(padded), count, count), np.inf)
    found = np.sqrt(least).transpose(0, 2, 1).reshape(-1, pairs)
    pair = 0
    for i in range(count):
        for j in range(i):
            closest[:, i, j] = closest[:, j, i] = found[:, pair]
            pair += 1
    final = blocks[:, :3].transpose(0, 3, 2, 1).reshape(-1, count, 3)
    return closest[:games], final[:games]
