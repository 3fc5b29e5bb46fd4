"""PettingZoo environment over the games of episodes."""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

import numpy as np
from gymnasium.spaces import Box, Space
from numpy.typing import NDArray
from pettingzoo import ParallelEnv

from ..core.errors import PlanError, check_choice
from ..report.palette import colours_in
from .distance_reward import evader_reward
from .environment_settings import EnvironmentSettings
from .episode_games import EpisodeGame
from .intent_actions import IntentActions
from .top_view import draw_top_view

SEEDS = 2**31
Observations = dict[str, NDArray[np.float32]]
Infos = dict[str, dict[str, Any]]


class ParallelGames(ParallelEnv[str, NDArray[np.float32], Any]):
    """Players of a game act at the same time; a step is one decision.

    Attributes:
        possible_agents: Names of the players that learn.
        agents: The same during an episode, else empty.
        render_mode: "rgb_array" or None.
        episode: Game of the episode; None before the first.
    """

    metadata: ClassVar[dict[str, Any]] = {
        "name": "stepaside_game_v0",
        "render_modes": ["rgb_array"],
        "render_fps": 10,
        "is_parallelizable": True,
    }

    def __init__(
        self,
        names: Sequence[str],
        choice: EnvironmentSettings,
        space: Box,
        render_mode: str | None,
    ) -> None:
        """Build the spaces.

        Args:
            names: Names of the players that learn.
            choice: Settings of actions and rewards.
            space: Space of the observations of each.
            render_mode: "rgb_array" for images from above, or None.

        Raises:
            ConfigurationError: If the render mode is unknown.
        """
        if render_mode is not None:
            modes = tuple(self.metadata["render_modes"])
            check_choice(render_mode, modes, "render_mode")
        self.render_mode, self._choice = render_mode, choice
        self.possible_agents = list(names)
        self.agents: list[str] = []
        self._actions = {n: IntentActions(choice) for n in names}
        self._observed = {n: Box(space.low, space.high) for n in names}
        self._random = np.random.default_rng()
        self._seed: int | None = None
        self._number = 0
        self.episode: EpisodeGame | None = None
        self._paths: dict[str, list[Any]] = {}

    @abstractmethod
    def begin(self, seed: int, number: int) -> EpisodeGame:
        """Begin the game of an episode.

        Args:
            seed: Seed of the environment, below 2^31.
            number: Number of the episode since it was seeded.
        """

    @abstractmethod
    def observe(self, game: EpisodeGame, name: str) -> NDArray[np.float32]:
        """Return the observation of a player."""

    @abstractmethod
    def unit(self, game: EpisodeGame, name: str) -> float:
        """Return the unit of length of a player, v/k, in [m]."""

    @abstractmethod
    def info(self, game: EpisodeGame) -> dict[str, Any]:
        """Return what an environment says besides the observation."""

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
            seed: Seed, 0 or above; None continues with the next episode.
            options: Not used.
        """
        if seed is not None or self._seed is None:
            drawn = int(self._random.integers(SEEDS))
            self._seed = (drawn if seed is None else seed) % SEEDS
            self._number = 0
        else:
            self._number += 1
        self.close()
        self.episode = game = self.begin(self._seed, self._number)
        self.agents = list(self.possible_agents)
        self._paths = {name: [] for name in game.poses}
        self._note(game)
        return self._observations(game), self._infos(game)

    def step(
        self, actions: Mapping[str, Any]
    ) -> tuple[
        Observations,
        dict[str, float],
        dict[str, bool],
        dict[str, bool],
        Infos,
    ]:
        """Play one decision of all players.

        Args:
            actions: Action of each agent.

        Raises:
            PlanError: If an action is missing or invalid, or the episode is
                over.
        """
        game, names = self.episode, self.possible_agents
        if game is None or not self.agents:
            raise PlanError("reset the environment first: no episode is on")
        missing = [name for name in names if name not in actions]
        if missing:
            raise PlanError(
                f"actions must have one of the {missing[0]}, got those of "
                f"{', '.join(actions) or 'no agent'}"
            )
        intents = {n: self._actions[n].intent(actions[n]) for n in names}
        closest, distances = dict(game.closest), game.distances
        game.step(intents)
        self._note(game)
        choice, ended = self._choice, bool(game.ended)
        gains = {
            name: evader_reward(
                (closest[name], game.closest[name]),
                (distances[name], apart),
                float(ended),
                (choice.shaping, choice.discount),
            )
            for name, apart in game.distances.items()
        }
        taken = -sum(gains.values()) / len(gains)  # by each pursuer
        result = (
            self._observations(game),
            {n: gains.get(n, taken) / self.unit(game, n) for n in names},
            dict.fromkeys(names, ended),
            dict.fromkeys(names, game.truncated),
            self._infos(game),
        )
        if game.over:
            self.agents = []
        return result

    def state(self) -> NDArray[np.float32]:
        """Return the poses (x [m], y [m], heading [rad]) of all players."""
        if self.episode is None:
            raise PlanError("reset the environment first: there is no state")
        return np.array([*self.episode.poses.values()], np.float32).ravel()

    def render(self) -> Any:
        """Return an image from above, shape (400, 400, 3), or None.

        Raises:
            PlanError: If there is no episode.
        """
        game = self.episode
        if self.render_mode is None:
            return None
        if game is None:
            raise PlanError("reset the environment first: nothing to render")
        poses = game.poses
        colours = colours_in("light", poses, game.identities)
        return draw_top_view(game.room, poses, self._paths, colours)

    def close(self) -> None:
        """End the episode and release its resources."""
        if self.episode is not None:
            self.episode.close()
            self.episode = None

    def _observations(self, game: EpisodeGame) -> Observations:
        return {n: self.observe(game, n) for n in self.possible_agents}

    def _infos(self, game: EpisodeGame) -> Infos:
        return {name: self.info(game) for name in self.possible_agents}

    def _note(self, game: EpisodeGame) -> None:
        if self.render_mode is not None:
            for name, pose in game.poses.items():
                self._paths[name].append(pose[:2])
