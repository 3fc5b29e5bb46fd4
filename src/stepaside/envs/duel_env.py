"""Gymnasium environment of one player against a strategy."""

from collections.abc import Generator
from typing import Any, ClassVar

import gymnasium
import numpy as np
from numpy.typing import NDArray

from ..core.errors import ConfigurationError, PlanError
from ..games.duel_settings import PLAYERS, PURSUER
from ..locomotion.policy.network_pool import NetworkPool
from ..strategies.registry import load_strategy
from ..strategies.strategy import Strategy
from .distance_reward import reward_sign
from .environment_settings import (
    EnvironmentSettings,
    check_choice,
    direction_of,
)
from .episode import (
    SEEDS,
    EnvironmentEpisode,
    EpisodeSource,
    check_render_mode,
)
from .intent_actions import IntentActions, observation_space

USUAL = {"evader": "pursuit", "pursuer": "evasion"}  # opponent of a role


def load_opponent(name: str | Strategy | None, role: str) -> Strategy:
    """Load the strategy of the opponent of a role.

    Args:
        name: Name or file of a strategy, or a strategy; None for the paper's.
        role: "pursuer" or "evader", the role that learns.

    Raises:
        ConfigurationError: If there is none, or it is of the same role.
    """
    check_choice(role, PLAYERS, "role")
    loaded = load_strategy(USUAL[role] if name is None else name)
    other = PLAYERS[1 - PLAYERS.index(role)]
    if loaded.direction is not direction_of(other):
        raise ConfigurationError(
            f"opponent must walk {direction_of(other).name.lower()}, as a "
            f"{other} does, got {name!r:.60}"
        )
    return loaded


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
        "render_modes": ["human", "rgb_array"],
        "render_fps": 10,
    }

    def __init__(
        self,
        role: str,
        *,
        opponent: str | Strategy | None = None,
        render_mode: str | None = None,
        networks: NetworkPool | None = None,
        **settings: Any,
    ) -> None:
        """Build the environment.

        Args:
            role: Role of the player, "pursuer" or "evader".
            opponent: Strategy of the opponent: a name, FILE.py:NAME,
                FILE.onnx or a strategy; by default that of the paper.
            render_mode: "rgb_array" for images from above, "human" for a
                page with them, or None.
            networks: Networks of learned legs, shared with other
                environments.
            settings: Fields of :class:`.EnvironmentSettings`.

        Raises:
            ConfigurationError: If a value is invalid.
        """
        check_choice(role, PLAYERS, "role")
        check_render_mode(render_mode, self.metadata)
        self.role, self.render_mode = role, render_mode
        self.settings = given = EnvironmentSettings(**settings)
        is_person = given.level == "physics" and given.duel.pursuer != "robot"
        if is_person and role == PURSUER:
            raise ConfigurationError(
                "role must be evader against a person as pursuer"
            )
        played = load_opponent(opponent, role)
        strategies = (None, played) if role == PURSUER else (played, None)
        self._source = EpisodeSource(
            given,
            strategies,
            images=render_mode is not None,
            networks=networks,
        )
        self._index = PLAYERS.index(role)
        self._actions = IntentActions(given)
        self.action_space = self._actions.space
        self.observation_space: Any = observation_space(given.terms)
        self._seed: int | None = None
        self._number = 0
        self._episode: EnvironmentEpisode | None = None

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
        if seed is not None or self._seed is None:
            drawn = int(self.np_random.integers(SEEDS))
            given = drawn if seed is None else seed % SEEDS
            self._seed, self._number = given, 0
        else:
            self._number += 1
        self.close()
        self._episode = self._source.begin(self._seed, self._number)
        return self._observation(), self._episode.info()

    def step(
        self, action: Any
    ) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Play one decision.

        Raises:
            PlanError: If the action is invalid, or the episode is over.
        """
        reward = self._source.play(self.begin_step(action))
        return self.end_step(reward)

    def begin_step(self, action: Any) -> Generator[None, None, float]:
        """Begin a step that is played beside those of other environments.

        Returns:
            Generator that yields whenever networks of robots have to be
            evaluated, and returns the reward of the evader.

        Raises:
            PlanError: If the action is invalid, or the episode is over.
        """
        if self._episode is None or self._episode.over:
            raise PlanError("reset the environment first: no episode is on")
        intent = self._actions.intent(action)
        pair = (intent, None) if self._index == 0 else (None, intent)
        return self._episode.step(pair)

    def end_step(
        self, reward: float
    ) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Return the result of a step with some reward of the evader."""
        episode = self._episode
        assert episode is not None
        return (
            self._observation(),
            reward * reward_sign(self.role),
            episode.terminated,
            episode.truncated,
            episode.info(),
        )

    def render(self) -> Any:
        """Return an image from above; None in mode "human".

        Raises:
            PlanError: If there is no episode.
        """
        return self._source.show(self._episode, self.render_mode)

    def close(self) -> None:
        """End the episode and release its resources."""
        if self._episode is not None:
            self._episode.close()
            self._episode = None

    def _observation(self) -> NDArray[np.float32]:
        assert self._episode is not None
        return self._episode.observation(self._index)
