"""Test the vector interface of Stable-Baselines3."""

from typing import Any

import numpy as np
import pytest

from stepaside.envs import VectorDuel

SETTINGS: dict[str, Any] = {"level": "steps", "arenas": 8, "duration": 4.0}


def test_games_are_those_of_the_vector_environment() -> None:
    pytest.importorskip("stable_baselines3")
    from stepaside.envs.stable_baselines import StableBaselinesDuel

    games = StableBaselinesDuel(VectorDuel(3, role="evader", **SETTINGS))
    games.seed(5)
    plain = VectorDuel(3, role="evader", **SETTINGS)
    np.testing.assert_array_equal(games.reset(), plain.reset(seed=5)[0])
    ends = 0
    for _ in range(10):
        actions = np.tile(np.array([0.3, 1.0], np.float32), (3, 1))
        seen, rewards, over, infos = games.step(actions)
        found, gained, ended, late, info = plain.step(actions)
        np.testing.assert_array_equal(seen, found)
        np.testing.assert_allclose(rewards, gained, rtol=1e-6)
        for n in np.flatnonzero(over):
            ends += 1
            last = infos[n]["terminal_observation"]
            np.testing.assert_array_equal(last, info["final_obs"][n])
            assert infos[n]["TimeLimit.truncated"] == late[n]
        np.testing.assert_array_equal(over, ended | late)
    assert ends >= 3
