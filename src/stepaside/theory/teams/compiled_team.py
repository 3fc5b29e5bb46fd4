"""Compiled simulation of games of several unicycles, in blocks.

A block holds some games; each player of it is one record, a structure of
arrays over the games. Loops over the games have no branches, and touch the
arrays of one record only: so the compiler knows that these do not overlap,
and vectorises them. Bearings are not integrated: from one stage to the next
they turn by the angle that the line of sight sweeps, whose tangent follows
from the positions.
"""

from math import atan2
from typing import Any

import numpy as np

from ...core.compilation import (
    compiled,
    compiled_parallel,
    inlined,
    parallel_range,
)
from ...core.poses import Array
from ..unicycle.compiled_batch import sine_cosine, turn
from .team_players import TeamRules

SIZE = 32  # games in a block
prange = parallel_range()
MOST_SWEPT = 0.125  # tangent up to which its series is exact to 2e-16
TAU, ROUND = 6.283185307179586, 6755399441055744.0
QUANTITIES = (
    *("x", "y", "theta"),  # pose at the begin of a step, in [m], [rad]
    *("sine", "cosine"),  # of that heading
    *("line_x", "line_y"),  # from there to the target, in [m]
    *("sight", "error"),  # bearing of the target; error of the heading [rad]
    *("at_x", "at_y", "turned"),  # pose at a stage; heading less theta
    *("u", "v"),  # velocity at a stage, in [m/s]
    *("swept", "far"),  # by the line of sight; whether it has to be repeated
    *("sum_u", "sum_v", "sum_turning"),  # weighted sums over the stages
    "least",  # squared distance of the nearest opponent, in [m^2]
)
PLAYER = np.dtype(
    [
        *((name, np.float64, (SIZE,)) for name in QUANTITIES),
        ("target", np.int64, (SIZE,)),
        ("nearest", np.int64, (SIZE,)),  # number of the nearest opponent
    ]
)


@inlined
def small_arc_tangent(t: float) -> float:
    """Return the inverse tangent of at most MOST_SWEPT, branch-free."""
    z = t * t
    high = 1.1111111111111111e-01 - z * 9.0909090909090912e-02
    high += z * z * (7.6923076923076927e-02 - z * 6.6666666666666666e-02)
    low = -3.3333333333333331e-01 + z * 2.0000000000000001e-01
    low += z * z * (z * high - 1.4285714285714285e-01)
    return t + t * (z * low)


@compiled
def target_of(players: Any, i: int, fixed: int, seen: Any) -> Any:
    """Return the record of the targets of a player.

    Args:
        players: Records of the players of a block. Shape (players,).
        i: Number of the player.
        fixed: Number of its target in all games; negative if they differ.
        seen: Memory for the positions of targets that differ.
    """
    if fixed >= 0:
        return players[fixed]
    own = players[i]
    for g in range(SIZE):
        other = players[own.target[g]]
        seen.at_x[g], seen.at_y[g] = other.at_x[g], other.at_y[g]
    return seen


@compiled
def sweep(own: Any, target: Any) -> None:
    """Compute the angles that lines of sight have swept since the begin."""
    count = 0
    for g in range(SIZE):
        dx, dy = target.at_x[g] - own.at_x[g], target.at_y[g] - own.at_y[g]
        x, y = own.line_x[g], own.line_y[g]
        along = x * dx + y * dy
        t = (x * dy - y * dx) / along
        far = (along <= 0.0) | (abs(t) > MOST_SWEPT)
        own.swept[g] = small_arc_tangent(t)
        own.far[g] = far
        count += 1 if far else 0
    for g in range(SIZE if count > 0 else 0):
        if own.far[g] > 0.0:
            dx = target.at_x[g] - own.at_x[g]
            dy = target.at_y[g] - own.at_y[g]
            x, y = own.line_x[g], own.line_y[g]
            own.swept[g] = atan2(x * dy - y * dx, x * dx + y * dy)


@compiled
def first_stage(
    own: Any, velocity: float, gain: float, angle: float, ahead: float
) -> None:
    """Begin a step, and move to the second stage.

    Args:
        own: Record of a player.
        velocity: Its driving velocity, in [m/s].
        gain: Its steering gain, in [1/s].
        angle: Its evasion angle, in [rad]; 0 of a pursuer.
        ahead: Time from the begin of the step to the next stage, in [s].
    """
    for g in range(SIZE):
        raw = own.sight[g] - own.theta[g]
        psi = raw - TAU * ((raw * (1.0 / TAU) + ROUND) - ROUND)
        side = -1.0 if psi > 0.0 else 1.0
        full = psi + side * angle
        error = full - TAU * ((full * (1.0 / TAU) + ROUND) - ROUND)
        u, v = velocity * own.cosine[g], velocity * own.sine[g]
        turned = ahead * gain * error
        own.error[g], own.turned[g] = error, turned
        own.sum_u[g], own.sum_v[g], own.sum_turning[g] = u, v, gain * error
        own.at_x[g] = own.x[g] + ahead * u
        own.at_y[g] = own.y[g] + ahead * v
        s, c = turn(own.sine[g], own.cosine[g], turned)
        own.u[g], own.v[g] = velocity * c, velocity * s


@compiled
def next_stage(own: Any, velocity: float, gain: float, ahead: float) -> None:
    """Add the slope of the second or third stage, and move to the next.

    Args:
        own: Record of a player.
        velocity: Its driving velocity, in [m/s].
        gain: Its steering gain, in [1/s].
        ahead: Time from the begin of the step to the next stage, in [s].
    """
    for g in range(SIZE):
        turning = gain * (own.error[g] + own.swept[g] - own.turned[g])
        u, v, turned = own.u[g], own.v[g], ahead * turning
        own.sum_u[g] += 2.0 * u
        own.sum_v[g] += 2.0 * v
        own.sum_turning[g] += 2.0 * turning
        own.at_x[g] = own.x[g] + ahead * u
        own.at_y[g] = own.y[g] + ahead * v
        own.turned[g] = turned
        s, c = turn(own.sine[g], own.cosine[g], turned)
        own.u[g], own.v[g] = velocity * c, velocity * s


@compiled
def end_step(own: Any, gain: float, sixth: float) -> None:
    """Move to the end of a step, from its last stage.

    Args:
        own: Record of a player.
        gain: Its steering gain, in [1/s].
        sixth: Sixth of the step size, in [s].
    """
    for g in range(SIZE):
        turning = gain * (own.error[g] + own.swept[g] - own.turned[g])
        x = own.x[g] + sixth * (own.sum_u[g] + own.u[g])
        y = own.y[g] + sixth * (own.sum_v[g] + own.v[g])
        theta = own.theta[g] + sixth * (own.sum_turning[g] + turning)
        own.x[g], own.y[g], own.theta[g] = x, y, theta
        own.at_x[g], own.at_y[g] = x, y
        own.sine[g], own.cosine[g] = sine_cosine(theta)


@compiled
def renew_lines(own: Any, target: Any) -> None:
    """Set bearings and lines of sight to those of the present positions."""
    for g in range(SIZE):
        own.sight[g] += own.swept[g]
        own.line_x[g] = target.at_x[g] - own.at_x[g]
        own.line_y[g] = target.at_y[g] - own.at_y[g]


@compiled
def note_pair(own: Any, other: Any, least: Any) -> None:
    """Update the smallest squared distances of a pair. Shape (SIZE,)."""
    for g in range(SIZE):
        dx, dy = own.x[g] - other.x[g], own.y[g] - other.y[g]
        square = dx * dx + dy * dy
        least[g] = square if square < least[g] else least[g]


@compiled
def note_pairs(players: Any, least: Any) -> None:
    """Update the smallest squared distances of all pairs of a block."""
    pair = 0
    for i in range(len(players)):
        for j in range(i):
            note_pair(players[i], players[j], least[pair])
            pair += 1


@compiled
def nearer_of(own: Any, other: Any, number: int) -> None:
    """Take another player as the nearest one where it is nearer."""
    for g in range(SIZE):
        dx, dy = other.x[g] - own.x[g], other.y[g] - own.y[g]
        square = dx * dx + dy * dy
        nearer = square < own.least[g]
        own.nearest[g] = number if nearer else own.nearest[g]
        own.least[g] = square if nearer else own.least[g]


@compiled
def choose_targets(players: Any, i: int, rules: Any) -> None:
    """Set the targets of a player that plays against the nearest opponent.

    Args:
        players: Records of the players of a block.
        i: Number of the player.
        rules: Parameters of the players, see :func:`play_blocks`.
    """
    own = players[i]
    own.least[:] = np.inf
    for j in range(len(players)):
        if rules[j, 4] != rules[i, 4]:
            nearer_of(own, players[j], j)
    changes = 0
    for g in range(SIZE):
        changes += 1 if own.nearest[g] != own.target[g] else 0
    for g in range(SIZE if changes > 0 else 0):
        found = own.nearest[g]
        if found != own.target[g]:
            own.target[g] = found
            other = players[found]
            dx, dy = other.x[g] - own.x[g], other.y[g] - own.y[g]
            own.line_x[g], own.line_y[g] = dx, dy
            own.sight[g] = atan2(dy, dx)


@compiled
def play_step(players: Any, rules: Any, seen: Any, step: float) -> None:
    """Advance the games of a block by one step of fourth order."""
    count = len(players)
    for i in range(count):
        own, velocity, gain = players[i], rules[i, 0], rules[i, 1]
        if rules[i, 3] < 0.0:
            choose_targets(players, i, rules)
        first_stage(own, velocity, gain, rules[i, 2], 0.5 * step)
    for k in range(4):
        for i in range(count):
            target = target_of(players, i, int(rules[i, 3]), seen)
            sweep(players[i], target)
            if k == 3:
                renew_lines(players[i], target)
        for i in range(count):
            own, velocity, gain = players[i], rules[i, 0], rules[i, 1]
            if k < 2:
                next_stage(
                    own, velocity, gain, (0.5 if k == 0 else 1.0) * step
                )
            elif k == 2:
                end_step(own, gain, step / 6.0)


@compiled_parallel
def play_blocks(
    blocks: Any, least: Any, rules: Any, steps: int, step: float
) -> None:
    """Play all games to the end, blocks in parallel.

    Args:
        blocks: Records of the players. Shape (blocks, players).
        least: Smallest squared distance of each pair. Shape (blocks, pairs,
            SIZE).
        rules: Rows of velocity, gain, angle, fixed target or -1, and 1 for
            an evader. Shape (players, 5).
        steps: Number of steps.
        step: Step size, in [s].
    """
    for number in prange(len(blocks)):
        players, seen = blocks[number], np.empty(1, PLAYER)[0]
        note_pairs(players, least[number])
        for _ in range(steps):
            play_step(players, rules, seen, step)
            note_pairs(players, least[number])


def make_blocks(starts: Array, rules: TeamRules) -> Any:
    """Arrange games in blocks, padded by repetitions of the first game.

    Args:
        starts: Initial poses. Shape (games, players, 3).
        rules: Parameters of the players.

    Returns:
        Records of the players. Shape (blocks, players).
    """
    games, count = starts.shape[:2]
    padded = np.concatenate(
        [starts, np.repeat(starts[:1], -games % SIZE, axis=0)]
    )
    blocks = np.zeros((len(padded) // SIZE, count), PLAYER)
    poses = padded.reshape(-1, SIZE, count, 3).transpose(0, 2, 3, 1)
    for k, name in enumerate(("x", "y", "theta")):
        blocks[name] = poses[:, :, k]
    blocks["at_x"], blocks["at_y"] = blocks["x"], blocks["y"]
    blocks["sine"], blocks["cosine"] = (
        np.sin(blocks["theta"]),
        np.cos(blocks["theta"]),
    )
    for i, target in enumerate(rules.targets.tolist()):
        blocks["target"][:, i] = target
        if target >= 0:
            own, other = blocks[:, i], blocks[:, target]
            dx, dy = other["x"] - own["x"], other["y"] - own["y"]
            own["line_x"], own["line_y"] = dx, dy
            own["sight"] = np.arctan2(dy, dx)
    return blocks


def play_chunk(
    starts: Array, rules: TeamRules, steps: int, step: float
) -> tuple[Array, Array]:
    """Play games to the end; see :func:`.team_arrays.play_chunk`."""
    games, count = starts.shape[:2]
    flat = np.column_stack(
        [
            rules.velocities,
            rules.gains,
            rules.angles,
            rules.targets,
            rules.evades,
        ]
    ).astype(np.float64)
    blocks = make_blocks(starts, rules)
    pairs = count * (count - 1) // 2
    least = np.full((len(blocks), pairs, SIZE), np.inf)
    play_blocks(blocks, least, flat, steps, step)
    closest = np.full((len(blocks) * SIZE, count, count), np.inf)
    found = np.sqrt(least).transpose(0, 2, 1).reshape(-1, pairs)
    pair = 0
    for i in range(count):
        for j in range(i):
            closest[:, i, j] = closest[:, j, i] = found[:, pair]
            pair += 1
    rows = [blocks[name] for name in ("x", "y", "theta")]
    final = np.stack(rows, axis=-1).transpose(0, 2, 1, 3)
    return closest[:games], final.reshape(-1, count, 3)[:games]
