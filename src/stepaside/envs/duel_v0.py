"""PettingZoo environment: pursuer and evader act at the same time."""

from typing import Any, ClassVar

import numpy as np
from gymnasium.spaces import Space
from numpy.typing import NDArray
from pettingzoo import ParallelEnv

from ..core.errors import ConfigurationError, PlanError
from ..games.duel_settings import PLAYERS
from .distance_reward import reward_sign
from .environment_settings import EnvironmentSettings
from .episode import (
    SEEDS,
    EnvironmentEpisode,
    EpisodeSource,
    check_render_mode,
)
from .intent_actions import IntentActions, observation_space

Observations = dict[str, NDArray[np.float32]]
Infos = dict[str, dict[str, Any]]


class DuelParallelEnv(ParallelEnv[str, NDArray[np.float32], Any]):
    """Both players of a duel; a step is one decision of each.

    Observations, actions and rewards are those of
    :class:`.duel_env.DuelEnv`; the game is zero-sum.

    Attributes:
        settings: Settings of the environment.
        possible_agents: "pursuer" and "evader".
        agents: The same during an episode, else empty.
        render_mode: "rgb_array", "human" or None.
    """

    metadata: ClassVar[dict[str, Any]] = {
        "name": "stepaside_duel_v0",
        "render_modes": ["human", "rgb_array"],
        "render_fps": 10,
        "is_parallelizable": True,
    }

    def __init__(
        self, *, render_mode: str | None = None, **settings: Any
    ) -> None:
        """Build the environment.

        Args:
            render_mode: "rgb_array" for images from above, "human" for a
                page with them, or None.
            settings: Fields of :class:`.EnvironmentSettings`.

        Raises:
            ConfigurationError: If a value is invalid.
        """
        check_render_mode(render_mode, self.metadata)
        self.render_mode = render_mode
        self.settings = given = EnvironmentSettings(**settings)
        if given.level == "physics" and given.duel.pursuer != "robot":
            raise ConfigurationError(
                "duel.pursuer must be robot with two learning players, got "
                f"{given.duel.pursuer!r}"
            )
        self._source = EpisodeSource(
            given, (None, None), images=render_mode is not None
        )
        self._actions = {n: IntentActions(given) for n in PLAYERS}
        self._observed = {n: observation_space(given.terms) for n in PLAYERS}
        self.possible_agents = list(PLAYERS)
        self.agents: list[str] = []
        self._random = np.random.default_rng()
        self._seed: int | None = None
        self._number = 0
        self._episode: EnvironmentEpisode | None = None

    def observation_space(self, agent: str) -> Space[Any]:
        """Return the space of observations of an agent, always the same."""
        return self._observed[agent]

    def action_space(self, agent: str) -> Space[Any]:
        """Return the space of actions of an agent, always the same."""
        return self._actions[agent].space

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observations, Infos]:
        """Begin the next episode of a seed.

        Args:
            seed: Seed; None continues with the next episode.
            options: Not used.
        """
        if seed is not None or self._seed is None:
            drawn = int(self._random.integers(SEEDS))
            self._seed, self._number = drawn if seed is None else seed, 0
        else:
            self._number += 1
        self.close()
        self._episode = self._source.begin(self._seed, self._number)
        self.agents = list(PLAYERS)
        return self._observations(), self._infos()

    def step(
        self, actions: dict[str, Any]
    ) -> tuple[
        Observations,
        dict[str, float],
        dict[str, bool],
        dict[str, bool],
        Infos,
    ]:
        """Play one decision of both players.

        Args:
            actions: Action of each agent.

        Raises:
            PlanError: If an action is missing or invalid, or the episode is
                over.
        """
        if self._episode is None or not self.agents:
            raise PlanError("reset the environment first: no episode is on")
        for name in PLAYERS:
            if name not in actions:
                raise PlanError(
                    f"actions must have one of the {name}, got those of "
                    f"{', '.join(actions) or 'no agent'}"
                )
        intents = [self._actions[n].intent(actions[n]) for n in PLAYERS]
        episode = self._episode
        reward = self._source.play(episode.step(intents))
        observed, infos = self._observations(), self._infos()
        if episode.over:
            self.agents = []
        return (
            observed,
            {name: reward_sign(name) * reward for name in PLAYERS},
            dict.fromkeys(PLAYERS, episode.terminated),
            dict.fromkeys(PLAYERS, episode.truncated),
            infos,
        )

    def state(self) -> NDArray[np.float32]:
        """Return the poses (x [m], y [m], heading [rad]) of both players."""
        if self._episode is None:
            raise PlanError("reset the environment first: there is no state")
        return np.array(self._episode.game.poses, np.float32).ravel()

    def render(self) -> Any:
        """Return an image from above; None in mode "human"."""
        return self._source.show(self._episode, self.render_mode)

    def close(self) -> None:
        """End the episode and release its resources."""
        if self._episode is not None:
            self._episode.close()
            self._episode = None

    def _observations(self) -> Observations:
        assert self._episode is not None
        return {
            name: self._episode.observation(n)
            for n, name in enumerate(PLAYERS)
        }

    def _infos(self) -> Infos:
        assert self._episode is not None
        return {name: self._episode.info() for name in PLAYERS}


def parallel_env(**settings: Any) -> DuelParallelEnv:
    """Build the environment; see :class:`DuelParallelEnv`.

    Args:
        settings: ``render_mode`` and the fields of
            :class:`.EnvironmentSettings`, such as ``level``.
    """
    return DuelParallelEnv(**settings)
