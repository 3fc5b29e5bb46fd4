"""Vector environment over duels in physics, played side by side."""

from collections.abc import Generator, Sequence
from typing import Any, ClassVar

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from ..core.errors import ConfigurationError, PlanError, check_within
from ..locomotion.policy.network_pool import NetworkPool
from ..strategies.strategy import Strategy
from .duel_env import DuelEnv
from .vector_duel import VectorDuel

MOST_GAMES = 1000
Batch = NDArray[np.float32]


class VectorPhysicsDuel(VectorEnv[Batch, Any, Any]):
    """Duels of :class:`.duel_env.DuelEnv` in physics, in one process.

    All advance tick by tick, and networks of robots on learned legs are
    evaluated for all games at once; each game has the same bits as alone.
    Seeds and resets are those of :class:`.vector_duel.VectorDuel`.
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
        **settings: Any,
    ) -> None:
        """Build the environments.

        Args:
            num_envs: Number of games.
            role: Role of the player, "pursuer" or "evader".
            opponent: Any strategy of the opponent; see
                :class:`.duel_env.DuelEnv`.
            settings: Fields of :class:`.EnvironmentSettings`, with level
                "physics".

        Raises:
            ConfigurationError: If a value is invalid.
        """
        check_within(
            num_envs, 1, MOST_GAMES, "num_envs", "1", ConfigurationError
        )
        self.num_envs = int(num_envs)
        self._networks = NetworkPool()
        self._envs = [
            DuelEnv(
                role, opponent=opponent, networks=self._networks, **settings
            )
            for _ in range(self.num_envs)
        ]
        self.single_action_space = self._envs[0].action_space
        self.single_observation_space = self._envs[0].observation_space
        self.action_space = batch_space(
            self.single_action_space, self.num_envs
        )
        self.observation_space = batch_space(
            self.single_observation_space, self.num_envs
        )

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
            options: Not used.
        """
        seeds: Sequence[int | None]
        if seed is None or isinstance(seed, int | np.integer):
            seeds = [
                None if seed is None else int(seed) + i
                for i in range(self.num_envs)
            ]
        else:
            seeds = seed
        if len(seeds) != self.num_envs:
            raise PlanError(
                f"there must be {self.num_envs} seeds, got {len(seeds)}"
            )
        found = [
            env.reset(seed=own)
            for env, own in zip(self._envs, seeds, strict=True)
        ]
        return np.stack([seen for seen, _ in found]), self._infos(
            [info for _, info in found]
        )

    def step(
        self, actions: Any
    ) -> tuple[Batch, Any, Any, Any, dict[str, Any]]:
        """Play one decision of all games.

        Returns:
            Observations, rewards, whether each game ended, whether each was
            truncated, and infos.

        Raises:
            PlanError: If an action is invalid, or nothing was reset.
        """
        if len(actions) != self.num_envs:
            raise PlanError(
                f"there must be {self.num_envs} actions, got {len(actions)}"
            )
        steps = [
            env.begin_step(action)
            for env, action in zip(self._envs, actions, strict=True)
        ]
        rewards = self._play(steps)
        results = [
            env.end_step(reward)
            for env, reward in zip(self._envs, rewards, strict=True)
        ]
        seen, signed, ended, late, infos = zip(*results, strict=True)
        over = np.array(ended) | np.array(late)
        info = self._infos(infos)
        observations = np.stack(seen)
        if over.any():
            info["final_obs"], info["_final_obs"] = observations.copy(), over
            info["final_info"] = {
                "closest_m": info["closest_m"],
                "_closest_m": over,
            }
            for i in np.flatnonzero(over):
                observations[i], _ = self._envs[i].reset()
        return (
            observations,
            np.array(signed, dtype=np.float64),
            np.array(ended),
            np.array(late),
            info,
        )

    def close_extras(self, **_: Any) -> None:
        """Release the robots."""
        for env in self._envs:
            env.close()

    def _play(
        self, steps: Sequence[Generator[None, None, float]]
    ) -> list[float]:
        """Play one step of all games, tick by tick."""
        rewards: dict[int, float] = {}
        while len(rewards) < len(steps):
            for i, step in enumerate(steps):
                if i in rewards:
                    continue
                try:
                    next(step)
                except StopIteration as end:
                    rewards[i] = float(end.value)
            self._networks.flush()
        return [rewards[i] for i in range(len(steps))]

    def _infos(self, infos: Sequence[dict[str, Any]]) -> dict[str, Any]:
        return {
            "closest_m": np.array([info["closest_m"] for info in infos]),
            "_closest_m": np.ones(self.num_envs, np.bool_),
        }


def make_vector_env(
    num_envs: int = 1, **settings: Any
) -> VectorDuel | VectorPhysicsDuel:
    """Build the vector environment of a level.

    Args:
        num_envs: Number of games.
        settings: Arguments of :class:`.VectorDuel`, or of
            :class:`VectorPhysicsDuel` if ``level`` is "physics".
    """
    if settings.get("level") != "physics":
        return VectorDuel(num_envs, **settings)
    if settings.pop("render_mode", None) is not None:
        raise ConfigurationError(
            "render_mode must be None for many games, got one"
        )
    return VectorPhysicsDuel(num_envs, **settings)
