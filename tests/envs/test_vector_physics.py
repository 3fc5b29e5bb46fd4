"""Test the vector environment of duels in physics."""

from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest

from legs_robot import nao_on_legs
from stepaside.envs import DuelEnv, VectorPhysicsDuel
from stepaside.games import DuelSettings
from stepaside.games.robot_settings import with_robot

SETTINGS: dict[str, Any] = {"level": "physics", "duration": 2.0}
BACK = np.array([0.4, 1.0], np.float32)


@pytest.mark.parametrize("legs", ["paper", "learned"])
def test_games_are_those_of_single_environments(
    legs: str, tmp_path: Path
) -> None:
    """Over the end of an episode, with the bits of single ones."""
    settings = SETTINGS
    if legs == "learned":
        pytest.importorskip("onnxruntime")
        robot = str(nao_on_legs(tmp_path / "nao"))
        duel = with_robot(DuelSettings(), robot)
        settings = SETTINGS | {"duel": duel, "duration": 1.0}
    games = gymnasium.make_vec("stepaside/Evade-v0", num_envs=2, **settings)
    assert isinstance(games.unwrapped, VectorPhysicsDuel)
    singles = [DuelEnv("evader", **settings) for _ in range(2)]
    found, _ = games.reset(seed=5)
    for i, single in enumerate(singles):
        np.testing.assert_array_equal(found[i], single.reset(seed=5 + i)[0])
    ends = 0
    for _ in range(6):
        found, rewards, ended, late, info = games.step(np.stack([BACK, BACK]))
        for i, single in enumerate(singles):
            seen, reward, over, truncated, own = single.step(BACK)
            assert (ended[i], late[i]) == (over, truncated)
            assert rewards[i] == reward
            assert info["closest_m"][i] == own["closest_m"]
            if over or truncated:
                ends += 1
                np.testing.assert_array_equal(info["final_obs"][i], seen)
                seen, _ = single.reset()
            np.testing.assert_array_equal(found[i], seen)
    assert ends >= 2
    games.close()
