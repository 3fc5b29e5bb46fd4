"""Blocks of games from initial states, with the smooth piece of each."""

from typing import Any

import numpy as np

from ...core.compilation import compiled
from .game_batch import Array, block_type
from .game_parameters import FlatParameters
from .piecewise_dynamics import SmoothPiece, initial_mode, piece_of
from .relative_motion import (
    RelativeState,
    SightGeometry,
    geometry_of,
    geometry_of_arrays,
)


@compiled
def initialise_pieces(
    states: Any,
    sides: Any,
    branches: Any,
    pieces: Any,
    side: int,
    rules: FlatParameters,
) -> None:
    """Find the smooth piece of each initial state.

    Args:
        states: Rows of r [m], a, psi [rad]; a whole turn may be added to
            psi, in place. Shape (n, 3).
        sides: Output: side of each game. Shape (n,).
        branches: Output: branch of each game. Shape (n,).
        pieces: Output: fields of the piece of each game. Shape (n, 5).
        side: Initial side, or 0 for the one behind the evader.
        rules: Rules of the game.
    """
    for j in range(len(states)):
        state = RelativeState(states[j, 0], states[j, 1], states[j, 2])
        sight = geometry_of(state, rules).sight
        states[j, 2], mode = initial_mode(state.psi, sight, side, rules)
        sides[j], branches[j] = mode.side, mode.branch
        piece = piece_of(mode, rules)
        pieces[j, 0], pieces[j, 1] = piece.low, piece.high
        pieces[j, 2], pieces[j, 3] = piece.constant, piece.slope
        pieces[j, 4] = piece.free


def make_blocks(
    starts: Array, side: int, size: int, step: float, rules: FlatParameters
) -> Any:
    """Arrange games in blocks of one size, padded by games that do not move.

    Args:
        starts: Rows of r [m], a, psi in [-pi, pi] [rad]. Shape (n, 3).
        side: Initial side, or 0 for the one behind the evader.
        size: Number of games in a block.
        step: Time step of the integration, in [s].
        rules: Rules of the game.

    Returns:
        Blocks of type :func:`.game_batch.block_type`.
    """
    padding = -len(starts) % size
    states = np.concatenate([starts, np.tile((1.0, 0.0, 0.0), (padding, 1))])
    sides, branches = np.empty((2, len(states)), dtype=np.int64)
    pieces = np.empty((len(states), len(SmoothPiece._fields)))
    initialise_pieces(states, sides, branches, pieces, side, rules)
    r = states[:, 0]
    geometry = geometry_of_arrays(RelativeState(*states.T), rules)
    caught = r <= rules.capture_distance
    over = caught | (np.arange(len(r)) >= len(starts))
    quantities = {
        **dict(zip(RelativeState._fields, states.T, strict=True)),
        **dict(zip(SmoothPiece._fields, pieces.T, strict=True)),
        **dict(zip(SightGeometry._fields, geometry, strict=True)),
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
