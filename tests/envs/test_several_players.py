"""Test the environment of any number of players."""

from dataclasses import replace
from math import pi
from typing import Any

import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.envs import ParallelGame
from stepaside.games.game_settings import GameSettings, read_game

AHEAD = np.array([0.0, 1.0], np.float32)
STILL = np.array([0.0, 0.0], np.float32)


def game(level: str = "steps", **changes: Any) -> GameSettings:
    """Return a game of two pursuers and an evader on a line."""
    players = [
        {"name": "red", "role": "pursuer", "start": [1.0, 0.0, pi]},
        {"name": "ruby", "role": "pursuer", "start": [-1.5, 0.0, 0.0]},
        {"name": "blue", "role": "evader", "start": [0.0, 0.0, 0.0]},
    ]
    entries = {"players": players, "level": level, "duration": 6.0}
    return read_game(entries | changes, "game")


def with_more(*more: dict[str, Any]) -> GameSettings:
    """Return that game with further players."""
    settings = game()
    added = read_game({"players": list(more)}, "more").players
    return replace(settings, players=(*settings.players, *added))


def test_observations_list_the_others_nearest_first() -> None:
    env = ParallelGame(game())
    observed, _ = env.reset(seed=1)
    own, others = observed["blue"][0], observed["blue"][1:].reshape(2, 8)
    assert own == 0.0
    unit = 0.5  # v/k of NAO, in [m]
    #                present, cos, sin, distance, velocity, opponent, team
    near = [1.0, 1.0, 0.0, 1.0 / unit, 0.0, 0.0, 1.0, 0.0]
    far = [1.0, -1.0, 0.0, 1.5 / unit, 0.0, 0.0, 1.0, 0.0]
    np.testing.assert_allclose(others, [near, far], atol=1e-6)
    of_red = observed["red"][1:].reshape(2, 8)
    np.testing.assert_array_equal(of_red[:, 6:], [[1, 0], [0, 1]])


def test_velocities_are_observed_in_the_own_frame() -> None:
    env = ParallelGame(game())
    env.reset(seed=1)
    actions = {"red": STILL, "ruby": AHEAD, "blue": STILL}
    for _ in range(3):
        observed, *_ = env.step(actions)
    far = observed["blue"][1:].reshape(2, 8)[1]
    np.testing.assert_allclose(far[4:6], [1.0, 0.0], atol=1e-5)
    ruby = observed["red"][1:].reshape(2, 8)[1]
    np.testing.assert_allclose(ruby[4:6], [-1.0, 0.0], atol=1e-5)


def test_capture_terminates_an_episode() -> None:
    env = ParallelGame(game(duration=30.0))
    env.reset(seed=1)
    ended = False
    while env.agents:
        *_, infos = env.step({"red": AHEAD, "ruby": STILL, "blue": STILL})
        ended = infos["blue"]["outcome"] == "captured"
    assert ended and infos["blue"]["closest_m"]["blue"] <= 0.35


def test_others_follow_their_strategies() -> None:
    env = ParallelGame(game(), learners=["blue"])
    assert env.possible_agents == ["blue"]
    env.reset(seed=1)
    for _ in range(8):
        _, _, _, _, infos = env.step({"blue": STILL})
    assert infos["blue"]["closest_m"]["blue"] < 0.8  # they approach


def test_walls_touch_an_evader() -> None:
    room = {"width": 4.0, "depth": 4.0}
    settings = game(room=room, duration=60.0)
    red, ruby, blue = settings.players
    ruby = replace(ruby, start=(1.0, 1.2, 0.0))  # not behind the evader
    settings = replace(settings, players=(red, ruby, blue))
    env = ParallelGame(settings)
    observed, _ = env.reset(seed=2)
    assert observed["blue"].shape == (1 + 17 + 2 * 8,)
    while env.agents:
        *_, ended, _, infos = env.step(
            {"red": STILL, "ruby": STILL, "blue": AHEAD}
        )
    assert ended["blue"] and infos["blue"]["outcome"] == "touched"
    assert infos["blue"]["closest_m"]["blue"] == 0.0


def test_robots_play_in_physics() -> None:
    settings = game("physics", duration=2.0)
    red, ruby, blue = settings.players
    ruby = replace(ruby, start=(-1.0, 1.5, 0.0))  # not behind the evader
    settings = replace(settings, players=(red, ruby, blue))
    env = ParallelGame(settings)
    env.reset(seed=1)
    steps = 0
    while env.agents:
        observed, *_ = env.step({"red": AHEAD, "ruby": AHEAD, "blue": AHEAD})
        steps += 1
        assert all(
            env.observation_space(name).contains(value)
            for name, value in observed.items()
        )
    assert steps == 3  # footsteps, the last one cut off
    assert observed["red"][0] == 1.0  # it walks
    assert observed["red"][1:].reshape(2, 8)[:, 0].all()  # it sees both
    env.close()


def test_a_step_of_the_environment_is_a_footstep() -> None:
    env = ParallelGame(game(duration=9.0))
    env.reset(seed=1)
    gained = []
    for _ in range(14):
        _, rewards, *_ = env.step({"red": AHEAD, "ruby": STILL, "blue": STILL})
        assert rewards["blue"] == -rewards["ruby"] == -rewards["red"]
        gained.append(rewards["red"])
    # A period of 0.547 s is 27 or 28 samples; the mean is a footstep.
    mean = np.mean(gained[-12:])
    assert mean == pytest.approx(0.04 / 0.5, rel=3e-3)  # stride over v/k


def lonely() -> GameSettings:
    """Return a game of an evader among bystanders."""
    *others, evader = game().players
    players = (replace(p, role="bystander", strategy="stand") for p in others)
    return replace(game(), players=(*players, evader))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"learners": ["guest"]}, "learners must be .*red, ruby, blue.*guest"),
        ({"learners": []}, "learners must be .*none"),
        ({"action": "both"}, "action must be one of"),
        ({"game": lonely()}, "game must have an evader and a pursuer"),
    ],
)
def test_invalid_arguments_are_refused(
    change: dict[str, Any], message: str
) -> None:
    guest = {"name": "guest", "body": "person", "start": [3.0, 3.0, 0.0]}
    with pytest.raises(ConfigurationError, match=message):
        ParallelGame(**{"game": with_more(guest)} | change)


def test_a_unicycle_learns_in_physics() -> None:
    settings = game("physics", duration=2.5)
    *robots, blue = settings.players
    moved = replace(blue, body="unicycle", start=(0.0, 0.0, pi / 2.0))
    env = ParallelGame(replace(settings, players=(*robots, moved)))
    env.reset(seed=1)
    while env.agents:
        env.step(dict.fromkeys(env.agents, STILL) | {"blue": AHEAD})
        x, y, _ = env.state()[6:]
    assert y < -0.03 and abs(x) < 1e-6  # it walks backward
    env.close()
