"""Gymnasium environment of one player of a duel against a strategy."""

from typing import Any, ClassVar

import gymnasium

from ..core.errors import ConfigurationError, check_choice, shown
from ..games.player_settings import PLAYERS
from ..strategies.registry import load_strategy
from ..strategies.strategy import Strategy
from .environment_settings import direction_of
from .parallel_games import ParallelDuel, Row

USUAL = {"evader": "pursuit", "pursuer": "evasion"}  # opponent of a role


def load_opponent(
    name: str | Strategy | None, role: str
) -> dict[str, Strategy]:
    """Load the opponent of the role that learns, by its own role.

    None stands for the paper's strategy.
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


class DuelEnv(gymnasium.Env[Row, Any]):
    """One player against a strategy; a step is one decision.

    Observation, action, reward, end and ``info`` are those of
    :class:`.ParallelDuel`.

    Attributes:
        role: "pursuer" or "evader".
        settings: Settings of the environment.
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
        """Build the environment, with fields of :class:`.EnvironmentSettings`.

        The opponent is the name of a strategy, FILE.py:NAME, FILE.onnx or a
        strategy; by default that of the paper.
        """
        opponents = load_opponent(opponent, role)
        self._both = ParallelDuel(
            render_mode=render_mode, opponents=opponents, **settings
        )
        self.role, self.render_mode = role, render_mode
        self.settings = self._both.settings
        self.action_space = self._both.action_space(role)
        self.observation_space: Any = self._both.observation_space(role)

    def reset(
        self,
        *,
        seed: int | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Row, dict[str, Any]]:
        """Begin the next episode of a seed; options are not used."""
        super().reset(seed=seed)
        observations, infos = self._both.reset(seed)
        return observations[self.role], infos[self.role]

    def step(
        self, action: Any
    ) -> tuple[Row, float, bool, bool, dict[str, Any]]:
        """Play one decision.

        Raises:
            PlanError: If the action is invalid, or the episode is over.
        """
        role = self.role
        seen, reward, ended, late, info = self._both.step({role: action})
        return seen[role], reward[role], ended[role], late[role], info[role]

    def render(self) -> Any:
        """Return an image from above."""
        return self._both.render()

    def close(self) -> None:
        """End the episode and release its resources."""
        self._both.close()
