"""Gymnasium environment of one player against a strategy."""

from typing import Any, ClassVar

import gymnasium
import numpy as np
from numpy.typing import NDArray

from ..core.errors import ConfigurationError, check_choice, shown
from ..games.duel_settings import PLAYERS
from ..strategies.registry import load_strategy
from ..strategies.strategy import Strategy
from .duel_v0 import DuelParallelEnv
from .environment_settings import direction_of
from .parallel_games import SEEDS

USUAL = {"evader": "pursuit", "pursuer": "evasion"}  # opponent of a role


def load_opponent(
    name: str | Strategy | None, role: str
) -> dict[str, Strategy]:
    """Load the strategy of the opponent of a role.

    Args:
        name: Name or file of a strategy, or a strategy; None for the paper's.
        role: "pursuer" or "evader", the role that learns.

    Returns:
        The strategy, by the role of the opponent.

    Raises:
        ConfigurationError: If there is none, or it is of the same role.
    """
    check_choice(role, PLAYERS, "role")
    loaded = load_strategy(USUAL[role] if name is None else name)
    other = PLAYERS[1 - PLAYERS.index(role)]
    if loaded.direction is not direction_of(other):
        raise ConfigurationError(
            f"opponent must walk {direction_of(other).name.lower()}, as a "
            f"{other} does, got {shown(name)}"
        )
    return {other: loaded}


class DuelEnv(gymnasium.Env[NDArray[np.float32], Any]):
    """One player against a strategy; a step is one decision.

    The observation holds the terms of ``settings.terms``; the reward is that
    of :mod:`.distance_reward`. Capture and contact with an obstacle, in
    physics falls and contacts, terminate an episode; the time limit
    truncates it. ``info`` holds "closest_m", "distance_m", "time_s" and
    "outcome", in one word.

    Attributes:
        role: "pursuer" or "evader".
        settings: Settings of the environment.
        observation_space: Space of observations.
        action_space: Space of actions.
        render_mode: "rgb_array" or None.
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]
        "render_modes": ["rgb_array"],
        "render_fps": 10,
    }

    def __init__(
        self,
        role: str,
        *,
        opponent: str | Strategy | None = None,
        render_mode: str | None = None,
        **settings: Any,
    ) -> None:
        """Build the environment.

        Args:
            role: Role of the player, "pursuer" or "evader".
            opponent: Strategy of the opponent: a name, FILE.py:NAME,
                FILE.onnx or a strategy; by default that of the paper.
            render_mode: "rgb_array" for images from above, or None.
            settings: Fields of :class:`.EnvironmentSettings`.

        Raises:
            ConfigurationError: If a value is invalid.
        """
        self._both = DuelParallelEnv(
            render_mode=render_mode,
            opponents=load_opponent(opponent, role),
            **settings,
        )
        self.role, self.render_mode = role, render_mode
        self.settings = self._both.settings
        self.action_space = self._both.action_space(role)
        self.observation_space: Any = self._both.observation_space(role)
        self._is_seeded = False

    def reset(
        self,
        *,
        seed: int | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begin the next episode of a seed.

        Args:
            seed: Seed; None continues with the next episode.
            options: Not used.
        """
        super().reset(seed=seed)
        if seed is None and not self._is_seeded:
            seed = int(self.np_random.integers(SEEDS))
        self._is_seeded = True
        observations, infos = self._both.reset(seed)
        return observations[self.role], infos[self.role]

    def step(
        self, action: Any
    ) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Play one decision.

        Raises:
            PlanError: If the action is invalid, or the episode is over.
        """
        role = self.role
        observed, reward, ended, late, info = self._both.step({role: action})
        return (
            observed[role],
            reward[role],
            ended[role],
            late[role],
            info[role],
        )

    def render(self) -> Any:
        """Return an image from above.

        Raises:
            PlanError: If there is no episode.
        """
        return self._both.render()

    def close(self) -> None:
        """End the episode and release its resources."""
        self._both.close()
