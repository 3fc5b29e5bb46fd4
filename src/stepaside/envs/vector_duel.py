"""Vector environment over the compiled games."""

from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from ..core.errors import ConfigurationError, PlanError, check_choice
from ..games.duel_settings import PLAYERS
from ..strategies.strategy import Strategy
from .batched_duel import BatchedDuel
from .distance_reward import evader_reward
from .duel_env import load_opponent
from .environment_settings import EnvironmentSettings
from .intent_actions import IntentActions, observation_space
from .parallel_games import SEEDS
from .step_batch import RUNNING

Batch = NDArray[np.float32]


class VectorDuel(VectorEnv[Batch, Any, Any]):
    """Many games of :class:`.duel_env.DuelEnv`, without Python per game.

    Game i with seed s is the game of a single environment with seed s. It is
    reset in the step that ends it (``AutoresetMode.SAME_STEP``): the
    observation is then the first of the next episode, the last one of the
    episode is in ``info["final_obs"]``.

    Attributes:
        role: "pursuer" or "evader".
        settings: Settings of the environment.
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]
        "autoreset_mode": AutoresetMode.SAME_STEP,
        "render_modes": [],
    }

    def __init__(
        self,
        num_envs: int = 1,
        *,
        role: str,
        opponent: str | Strategy | None = None,
        render_mode: str | None = None,
        **settings: Any,
    ) -> None:
        """Build the environments.

        Args:
            num_envs: Number of games.
            role: Role of the player, "pursuer" or "evader".
            opponent: Strategy of the opponent: evasion, pursuit of any
                gain, sharp, stand, FILE.onnx, or such a strategy.
            render_mode: None: many games are not drawn.
            settings: Fields of :class:`.EnvironmentSettings`.

        Raises:
            ConfigurationError: If a value is invalid.
        """
        check_choice(role, PLAYERS, "role")
        if render_mode is not None:
            raise ConfigurationError(
                "render_mode must be None for many games, got "
                f"{render_mode!r:.40}"
            )
        self.role, self.num_envs = role, int(num_envs)
        self.settings = given = EnvironmentSettings(**settings)
        self._index = PLAYERS.index(role)
        played = load_opponent(opponent, role)
        strategies = [played.get(name) for name in PLAYERS]
        self._games = BatchedDuel(given, self.num_envs, strategies)
        unit = self._games.rules.speed / self._games.rules.gain
        self._scale = (1.0 if role == "evader" else -1.0) / unit
        self._actions = IntentActions(given)
        self.single_action_space = self._actions.space
        self.single_observation_space = observation_space(given.terms)
        self.action_space = batch_space(self._actions.space, self.num_envs)
        self.observation_space = batch_space(
            self.single_observation_space, self.num_envs
        )
        self._seeds: NDArray[np.int64] | None = None
        self._numbers = np.zeros(self.num_envs, np.int64)
        self._distances = np.zeros(self.num_envs)

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Batch, dict[str, Any]]:
        """Begin an episode of all games.

        Args:
            seed: Seed of each game; an integer gives game i that many plus
                i; None continues with the next episodes.
            options: "reset_mask": the games to begin, shape (num_envs,);
                all the first time.
        """
        games = self._chosen(options)
        if self._seeds is None:
            games = np.arange(self.num_envs)
        if seed is not None or self._seeds is None:
            self._seeds = self._seeds_of(seed)
            self._numbers[:] = 0
        else:
            self._numbers[games] += 1
        self._begin(games)
        return self._games.observations(self._index), self._info()

    def step(
        self, actions: Any
    ) -> tuple[Batch, Any, Any, Any, dict[str, Any]]:
        """Play one decision of all games.

        Returns:
            Observations, rewards, whether each game ended, whether each was
            truncated, and infos.

        Raises:
            PlanError: If the actions are invalid, or nothing was reset.
        """
        if self._seeds is None:
            raise PlanError("reset the environment first: no episode is on")
        rows = self._actions.rows(actions)
        if len(rows) != self.num_envs:
            raise PlanError(
                f"there must be {self.num_envs} actions, got {len(rows)}"
            )
        games = self._games
        closest = games.state.closest.copy()
        games.step((rows, None) if self._index == 0 else (None, rows))
        ended = games.outcomes != RUNNING
        late = games.state.decisions >= games.rules.limit
        distances = games.distances
        rewards = self._scale * evader_reward(
            (closest, games.state.closest),
            (self._distances, distances),
            ended.astype(np.float64),
            (self.settings.shaping, self.settings.discount),
        )
        self._distances = distances
        over, info = ended | late, self._info()
        observations = games.observations(self._index)
        if over.any():
            info["final_obs"], info["_final_obs"] = observations, over
            info["final_info"] = {
                "closest_m": info["closest_m"],
                "_closest_m": over,
            }
            self._numbers[over] += 1
            self._begin(np.flatnonzero(over))
            observations = games.observations(self._index)
            info |= self._info()
        return observations, rewards, ended, late & ~ended, info

    @property
    def episode_arenas(self) -> NDArray[np.int64]:
        """Arena of the present episode of each game."""
        if self._seeds is None:
            raise PlanError("reset the environment first: no episode is on")
        return self._games.pool.indices(self._seeds, self._numbers)

    def _begin(self, games: NDArray[np.int64]) -> None:
        self._games.start(games, self.episode_arenas[games])
        self._distances = self._games.distances

    def _info(self) -> dict[str, Any]:
        everyone = np.ones(self.num_envs, np.bool_)
        return {
            "closest_m": self._games.state.closest.copy(),
            "_closest_m": everyone,
        }

    def _chosen(self, options: dict[str, Any] | None) -> NDArray[np.int64]:
        """Return the indices of the games to begin."""
        mask = (options or {}).get("reset_mask")
        if mask is None:
            return np.arange(self.num_envs)
        flags = np.asarray(mask)
        if flags.shape != (self.num_envs,) or flags.dtype != np.bool_:
            raise PlanError(
                f"reset_mask must be {self.num_envs} booleans, got shape "
                f"{flags.shape} of {flags.dtype}"
            )
        return np.flatnonzero(flags)

    def _seeds_of(
        self, seed: int | Sequence[int | None] | None
    ) -> NDArray[np.int64]:
        """Return the seed of each game."""
        if seed is None:
            drawn = self.np_random.integers(SEEDS, size=self.num_envs)
            return drawn.astype(np.int64)
        if isinstance(seed, int | np.integer):
            self._np_random = np.random.default_rng(int(seed))
            return (int(seed) % SEEDS + np.arange(self.num_envs)) % SEEDS
        if len(seed) != self.num_envs:
            raise PlanError(
                f"there must be {self.num_envs} seeds, got {len(seed)}"
            )
        return np.array(
            [
                int(self.np_random.integers(SEEDS))
                if one is None
                else one % SEEDS
                for one in seed
            ],
            dtype=np.int64,
        )
