"""Starts of many games: the piece of each, and its place in a block."""

from typing import Any

import numpy as np

from .compilation import compiled
from .game_batch import Array, block_type
from .game_parameters import FlatParameters
from .relative_motion import RelativeState, SightGeometry, look, look_many
from .smooth_pieces import SmoothPiece, enter, piece_of


@compiled
def enter_all(
    states: Any,
    sides: Any,
    branches: Any,
    pieces: Any,
    side: int,
    rules: FlatParameters,
) -> None:
    """Find the piece of each start; its bearing may turn round.

    Args:
        states: Rows of r [m], a, psi [rad]; psi is overwritten. (n, 3).
        sides: Side of each game, written here. Shape (n,).
        branches: Branch of each, likewise. Shape (n,).
        pieces: Numbers of the piece of each, likewise. Shape (n, 5).
        side: Side asked for, or 0 for the one behind the evader.
        rules: Rules of the game.
    """
    for j in range(len(states)):
        state = RelativeState(states[j, 0], states[j, 1], states[j, 2])
        sight = look(state, rules).sight
        states[j, 2], mode = enter(state.psi, sight, side, rules)
        sides[j], branches[j] = mode.side, mode.branch
        piece = piece_of(mode, rules)
        pieces[j, 0], pieces[j, 1] = piece.low, piece.high
        pieces[j, 2], pieces[j, 3] = piece.constant, piece.slope
        pieces[j, 4] = piece.free


def lay_blocks(
    starts: Array, side: int, size: int, step: float, rules: FlatParameters
) -> Any:
    """Lay games into blocks of one size; spare places hold games at rest.

    Args:
        starts: Rows of r [m], a, psi in [-pi, pi] [rad]. Shape (n, 3).
        side: Side asked for, or 0 for the one behind the evader.
        size: Number of games in a block.
        step: Step of the integration, in [s].
        rules: Rules of the game.

    Returns:
        Blocks of :func:`.batch.block_type`.
    """
    spare = -len(starts) % size
    states = np.concatenate([starts, np.tile((1.0, 0.0, 0.0), (spare, 1))])
    sides, branches = np.empty((2, len(states)), dtype=np.int64)
    pieces = np.empty((len(states), len(SmoothPiece._fields)))
    enter_all(states, sides, branches, pieces, side, rules)
    r = states[:, 0]
    view = look_many(RelativeState(*states.T), rules)
    caught = r <= rules.capture_distance
    over = caught | (np.arange(len(r)) >= len(starts))
    quantities = {
        **dict(zip(RelativeState._fields, states.T, strict=True)),
        **dict(zip(SmoothPiece._fields, pieces.T, strict=True)),
        **dict(zip(SightGeometry._fields, view, strict=True)),
        "side": sides,
        "branch": branches,
        "step": np.where(over, 0.0, step),
        "closest": r,
        "capture_time": np.where(caught, 0.0, -1.0),
    }
    blocks = np.zeros(len(states) // size, block_type(size))
    for name, values in quantities.items():
        blocks[name] = values.reshape(-1, size)
    return blocks
