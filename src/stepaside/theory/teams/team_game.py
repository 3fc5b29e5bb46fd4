"""Games of several unicycles under the paper's laws, many at once.

Each player pursues its target by (1)-(2), or evades it by (3)-(5) at an
angle, to the side behind itself. Poses are integrated in the world by
fourth-order Runge-Kutta steps, with the bearings of the targets as further
states, so that a step needs no inverse tangent. Sides, wrapped errors and
nearest opponents are those at the begin of each step: unlike
:mod:`stepaside.theory.unicycle`, edges within a step are not located.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import ArrayLike

from ...core.brief_repr import brief_repr
from ...core.compilation import load_numba
from ...core.errors import PlanError, check_positive
from ...core.poses import Array
from .team_players import TeamPlayer, check_team, team_rules

STEP_TIMES_GAIN = 0.025  # as in the game of two
CHUNK = 16_384  # games between two reports of progress


@dataclass(frozen=True, slots=True)
class TeamOutcomes:
    """Outcomes of many games of several unicycles.

    Attributes:
        closest: Smallest distance of each pair at the steps, in [m]; the
            diagonal is inf. Shape (games, players, players).
        poses: Final poses (x [m], y [m], heading [rad]). Shape (games,
            players, 3).
    """

    __repr__ = brief_repr

    closest: Array
    poses: Array

    def closest_to(self, player: int, others: Sequence[int]) -> Array:
        """Return the closest approach of a player to others, in [m].

        Args:
            player: Index of the player.
            others: Indices of the others.

        Returns:
            Smallest distance in each game. Shape (games,).
        """
        nearest: Array = self.closest[:, player, list(others)].min(axis=1)
        return nearest


def play_team_games(
    players: Sequence[TeamPlayer],
    starts: ArrayLike,
    duration: float,
    *,
    step: float | None = None,
    backend: str = "auto",
    progress: Callable[[int], None] | None = None,
) -> TeamOutcomes:
    """Simulate one game from each of many initial states.

    Args:
        players: The players.
        starts: Initial poses (x [m], y [m], heading [rad]). Shape (games,
            players, 3).
        duration: Duration of a game, in [s].
        step: Step size, in [s]; by default the largest one up to 0.025 over
            the largest gain that divides the duration.
        backend: "numba", "numpy", or "auto" for the first one available.
        progress: Called with the number of games of each finished chunk.

    Returns:
        Outcomes, in the order of the starts.

    Raises:
        PlanError: If a value is out of range, or the backend is missing.
    """
    from . import compiled_team, team_arrays  # lazily: they import Numba

    check_team(players)
    check_positive(duration, "duration", "s")
    if step is None:
        accurate = STEP_TIMES_GAIN / max(player.gain for player in players)
        step = duration / ceil(duration / accurate - 1e-9)
    check_positive(step, "step", "s")
    steps = ceil(duration / step - 1e-9)
    poses = np.array(starts, dtype=np.float64)
    count = len(players)
    if poses.ndim != 3 or poses.shape[1:] != (count, 3):
        raise PlanError(
            f"starts must have shape (games, {count}, 3), got {poses.shape}"
        )
    if not np.isfinite(poses).all():
        raise PlanError("starts must be finite [m], [rad]")
    if backend not in ("auto", "numba", "numpy"):
        raise PlanError(f"backend must be auto, numba or numpy, got {backend}")
    if backend == "numba" and load_numba() is None:
        raise PlanError(
            "backend numba needs numba: pip install 'stepaside[fast]'"
        )
    fast = backend != "numpy" and load_numba() is not None
    play = compiled_team.play_chunk if fast else team_arrays.play_chunk
    rules = team_rules(players)
    closest = np.empty((len(poses), count, count))
    final = np.empty_like(poses)
    for first in range(0, len(poses), CHUNK):
        part = slice(first, first + CHUNK)
        closest[part], final[part] = play(poses[part], rules, steps, step)
        if progress is not None:
            progress(len(final[part]))
    return TeamOutcomes(closest, final)
