"""The compiled games as a vector environment of Stable-Baselines3."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from stable_baselines3.common.vec_env import VecEnv

from .duel_env import VectorDuel


class StableBaselinesDuel(VecEnv):
    """Games of :class:`.VectorDuel` for Stable-Baselines3.

    Seeds, observations, actions and rewards are the same. An episode that
    ends has "terminal_observation", "TimeLimit.truncated" and "closest_m" in
    its info.
    """

    def __init__(self, games: VectorDuel) -> None:
        """Take some games."""
        self.games = games
        super().__init__(
            games.num_envs,
            games.single_observation_space,
            games.single_action_space,
        )

    def reset(self) -> Any:
        """Begin an episode of all games; return the observations."""
        seed = self._seeds[0]
        self._reset_seeds()
        return self.games.reset(seed=seed)[0]

    def step_async(self, actions: Any) -> None:
        """Keep the actions of the next step."""
        self._given = actions

    def step_wait(self) -> tuple[Any, Any, Any, list[dict[str, Any]]]:
        """Play one decision; return observations, rewards, ends, infos."""
        found, rewards, ended, late, info = self.games.step(self._given)
        infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        over = ended | late
        for n in np.flatnonzero(over):
            infos[n] = {
                "terminal_observation": info["final_obs"][n],
                "TimeLimit.truncated": bool(late[n]),
                "closest_m": float(info["final_info"]["closest_m"][n]),
            }
        return found, rewards.astype(np.float32), over, infos

    def close(self) -> None:
        """Release the games."""
        self.games.close()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """Return an attribute of the games, once for each."""
        value = getattr(self.games, attr_name)
        return [value for _ in self._get_indices(indices)]

    def set_attr(
        self, attr_name: str, value: Any, indices: Any = None
    ) -> None:
        """Set an attribute of all games."""
        setattr(self.games, attr_name, value)

    def env_method(
        self, method_name: str, *args: Any, indices: Any = None, **given: Any
    ) -> list[Any]:
        """Call a method of the games; return the result, once for each."""
        result = getattr(self.games, method_name)(*args, **given)
        return [result for _ in self._get_indices(indices)]

    def env_is_wrapped(
        self, wrapper_class: Any, indices: Any = None
    ) -> Sequence[bool]:
        """Return False for each: the games have no wrappers."""
        return [False for _ in self._get_indices(indices)]
