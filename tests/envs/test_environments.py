"""Test the environments by the checks of their libraries and by the rules."""

import warnings
from collections.abc import Iterator
from dataclasses import replace
from math import pi
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from pettingzoo.test import parallel_api_test, parallel_seed_test

from stepaside.arena import RoomRecipe
from stepaside.core.errors import ConfigurationError, PlanError
from stepaside.envs import IDS, DuelEnv, ParallelDuel, VectorDuel
from stepaside.envs.environment_settings import EnvironmentSettings
from stepaside.games import duel as make_duel
from stepaside.strategies import (
    Evasion,
    LearnedStrategy,
    LookAhead,
    Pursuit,
    StandStill,
)
from stepaside.strategies.learned import dense_network
from stepaside.theory.unicycle import RelativeStart

ROOM: dict[str, Any] = {"room": RoomRecipe(discs=2), "arenas": 8}
SHORT: dict[str, Any] = {"arenas": 8, "duration": 8.0}
VARIANTS: list[dict[str, Any]] = [
    {"level": "unicycle", **SHORT},
    {"level": "steps", **SHORT, **ROOM, "action": "discrete"},
    {"level": "steps", **SHORT, "full_state": True},
]
BACK = np.array([0.0, 1.0], np.float32)


@pytest.fixture(autouse=True)
def _quiet() -> Iterator[None]:
    """Actions are in SI units, which the checkers advise against."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


@pytest.mark.parametrize("settings", VARIANTS)
@pytest.mark.parametrize("name", IDS)
def test_gymnasium_finds_no_fault(name: str, settings: dict[str, Any]) -> None:
    check_env(
        gymnasium.make(name, render_mode="rgb_array", **settings).unwrapped
    )


@pytest.mark.parametrize("settings", VARIANTS)
def test_pettingzoo_finds_no_fault(settings: dict[str, Any]) -> None:
    parallel_api_test(ParallelDuel(**settings), num_cycles=60)
    parallel_seed_test(lambda: ParallelDuel(**settings), num_cycles=20)


def learned() -> LearnedStrategy:
    """Return a network of random weights that walks backward in a room."""
    random = np.random.default_rng(2)
    layers = [
        (random.normal(size=(23, 16)), random.normal(size=16)),
        (random.normal(size=(16, 8)), random.normal(size=8)),
    ]
    return LearnedStrategy(
        dense_network(layers),
        EnvironmentSettings(
            action="discrete", headings=7, room=RoomRecipe()
        ).contract("evader"),
    )


STEPS: dict[str, Any] = {"level": "steps", **SHORT}
GAMES: dict[str, tuple[str, Any, dict[str, Any]]] = {
    "evader": ("evader", None, {**STEPS, "full_state": True}),
    "pursuer": ("pursuer", None, {**STEPS, "full_state": True}),
    "discrete": ("evader", None, VARIANTS[1]),
    "triggered": (
        "pursuer",
        Evasion(0.6, safety_radius=0.7, release_distance=0.9),
        {**STEPS, **ROOM},
    ),
    "saturated": (
        "pursuer",
        Evasion(saturated=True, safety_radius=1e6),
        STEPS,
    ),
    "sharp": ("evader", Pursuit(gain=np.inf), {**STEPS, **ROOM}),
    "turning by (6)": ("evader", Pursuit(saturated=True), STEPS),
    "standing": ("pursuer", StandStill(), STEPS),
    "learned": ("pursuer", learned(), {**STEPS, **ROOM}),
}


@pytest.mark.parametrize("name", GAMES)
def test_vector_games_are_those_of_single_environments(name: str) -> None:
    """Over several episodes."""
    role, opponent, settings = GAMES[name]
    games = VectorDuel(3, role=role, opponent=opponent, **settings)
    singles = [DuelEnv(role, opponent=opponent, **settings) for _ in range(3)]
    found, _ = games.reset(seed=5)
    space = singles[0].action_space
    if isinstance(space, gymnasium.spaces.Box):  # any heading
        np.testing.assert_allclose(space.high, [np.pi, 1.0], rtol=1e-6)
        np.testing.assert_allclose(space.low, [-np.pi, 0.0], rtol=1e-6)
    for i, single in enumerate(singles):
        first, _ = single.reset(seed=5 + i)
        np.testing.assert_allclose(found[i], first, atol=1e-6)
    games.action_space.seed(1)
    ends = 0
    for _ in range(50):
        actions = games.action_space.sample()
        found, rewards, ended, late, info = games.step(actions)
        for i, single in enumerate(singles):
            seen, reward, over, truncated, _ = single.step(actions[i])
            assert (ended[i], late[i]) == (over, truncated)
            assert single.observation_space.contains(seen)
            assert rewards[i] == pytest.approx(reward, abs=1e-9)
            if over or truncated:
                ends += 1
                last = info["final_obs"][i]
                np.testing.assert_allclose(last, seen, atol=1e-5)
                seen, _ = single.reset()
            np.testing.assert_allclose(found[i], seen, atol=1e-5)
    assert ends >= 6


def test_a_law_that_the_kernel_does_not_know_is_refused() -> None:
    for opponent in (LookAhead(), replace(Evasion(), trigger="time")):
        word = f"got a {type(opponent).__name__}; others"
        with pytest.raises(ConfigurationError, match=word):
            VectorDuel(role="pursuer", opponent=opponent)
    for changes, word in (
        ({"pursuer": {"gait": {"speed": 0.15}}}, "gaits of duel must be"),
        ({"gait": {"outer_stride": 0.05}}, "without outer_stride"),
        ({"gait": {"gain": 2.0}}, "turns of duel.evader.gait must be"),
    ):
        with pytest.raises(ConfigurationError, match=word):
            VectorDuel(role="evader", level="steps", duel=make_duel(**changes))


def test_any_strategy_is_an_opponent() -> None:
    env = DuelEnv("pursuer", opponent=LookAhead(), level="steps", **SHORT)
    env.reset(seed=1)
    assert np.isfinite(env.step(BACK)[0]).all()
    with pytest.raises(ConfigurationError, match="must walk forward, as a"):
        DuelEnv("evader", opponent="look-ahead")


def test_any_heading_draws_starts_of_all_headings() -> None:
    env = DuelEnv("evader", any_heading=True, arenas=40)
    bearings = [
        RelativeStart.from_world(*env_starts(env, n)).bearing
        for n in range(40)
    ]
    assert np.ptp(bearings) > 1.5 * pi


def env_starts(env: DuelEnv, seed: int) -> Any:
    env.reset(seed=seed)
    return env.settings.draw_arenas()[1][seed]


def test_images_show_the_game() -> None:
    env = DuelEnv("evader", render_mode="rgb_array", **VARIANTS[1])
    env.reset(seed=1)
    first = env.render()
    for _ in range(4):
        env.step(7)
    assert env.render().shape == first.shape == (400, 400, 3)
    assert (env.render() != first).any()


STORED = [
    [69.2525, 0.0, 69.0764, 0.0],
    [211.356, 0.782422, 258.774, 0.0],
    [136.394, 0.0, 137.763, -0.281059],
]
"""Of each variant and role: sums of observations and rewards."""


@pytest.mark.parametrize("number", range(3))
def test_episodes_turn_out_as_stored(number: int) -> None:
    found = []
    for role in ("pursuer", "evader"):
        env = DuelEnv(role, any_heading=number != 1, **VARIANTS[number])
        rows, rewards = [env.reset(seed=4)[0]], [0.0]
        for step in range(12):
            action = step % 7 if number == 1 else BACK * (0.1 * step)
            row, reward, *_ = env.step(action)
            rows.append(row)
            rewards.append(float(reward))
        found += [float(np.abs(rows).sum()), sum(rewards)]
    assert found == pytest.approx(STORED[number], rel=1e-4)


def test_an_episode_after_others_is_that_of_a_new_environment() -> None:
    games = VectorDuel(2, role="evader", level="unicycle", **SHORT)
    found = []
    for steps in (3, 200, 3):
        games.reset(seed=[3, 4])
        for _ in range(steps):
            row = games.step(np.tile(BACK, (2, 1)))
        found.append(row)
    np.testing.assert_array_equal(found[0][0], found[2][0])
    for before, after in zip(found[0][1:4], found[2][1:4], strict=True):
        np.testing.assert_array_equal(before, after)


def test_steps_need_an_episode() -> None:
    games = VectorDuel(2, role="evader", **SHORT)
    with pytest.raises(PlanError, match="reset the environment first"):
        games.step(np.tile(BACK, (2, 1)))
    assert len(games.reset(seed=[0, None])[0]) == 2
    with pytest.raises(PlanError, match="there must be 2 seeds, got 3"):
        games.reset(seed=[0, 1, 2])
    with pytest.raises(PlanError, match="there must be 2 actions, got 3"):
        games.step(np.tile(BACK, (3, 1)))
    env = ParallelDuel(**SHORT)
    with pytest.raises(PlanError, match="reset the environment first"):
        env.step({})
    env.reset(seed=0)
    with pytest.raises(PlanError, match="one of the pursuer, got those of no"):
        env.step({})


PHYSICS: dict[str, Any] = {"level": "physics", "duration": 2.0}


def test_physics_is_an_environment() -> None:
    env = gymnasium.make("stepaside/Evade-v0", **PHYSICS)
    rows = []
    for _ in range(2):
        _, first = env.reset(seed=3)
        for _ in range(3):
            row, *_, info = env.step(np.array([0.0, 0.0], np.float32))
        rows.append(row)
    assert info["distance_m"] < first["distance_m"]  # only the pursuer walks
    np.testing.assert_array_equal(*rows)
    env.close()


def test_a_person_is_an_opponent_in_physics() -> None:
    duel = make_duel(pursuer={"body": "person"})
    env = DuelEnv("evader", duel=duel, level="physics", duration=1.0)
    env.reset(seed=1)
    assert np.isfinite(env.step(BACK)[0]).all()
    env.close()
    with pytest.raises(ConfigurationError, match="if the pursuer learns"):
        DuelEnv("pursuer", duel=duel, level="physics")
