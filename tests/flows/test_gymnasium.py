"""Learning environments, by the checks of their libraries and by the rules."""

import warnings
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from flows import calls

for library in ("gymnasium", "pettingzoo"):
    pytest.importorskip(library)

STRIDE, UNIT = 0.04, 0.5  # [m]: stride and v/k of NAO
PERIOD = 0.547  # [s], of decisions
STILL, AHEAD = (
    np.array([0.0, 0.0], np.float32),
    np.array([0.0, 1.0], np.float32),
)
SHORT: dict[str, Any] = {"level": "steps", "arenas": 8, "duration": 8.0}


@pytest.fixture(autouse=True)
def _quiet() -> Iterator[None]:
    """Actions are in SI units, which the checkers advise against."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


def assert_gymnasium_finds_no_fault(env: Any) -> None:
    from gymnasium.utils.env_checker import check_env

    check_env(env.unwrapped)


def assert_pettingzoo_finds_no_fault(make: Callable[[], Any]) -> None:
    from pettingzoo.test import parallel_api_test, parallel_seed_test

    parallel_api_test(make(), num_cycles=40)
    parallel_seed_test(make, num_cycles=5)


@pytest.mark.parametrize("role", ["Evade", "Pursue"])
@pytest.mark.parametrize("level", ["unicycle", "steps"])
def test_gymnasium_finds_no_fault(role: str, level: str) -> None:
    settings = SHORT | {"level": level}
    assert_gymnasium_finds_no_fault(calls.environment(role, **settings))


def test_gymnasium_finds_no_fault_in_physics() -> None:
    settings = {"level": "physics", "duration": 4.0}
    assert_gymnasium_finds_no_fault(calls.environment("Evade", **settings))


def test_pettingzoo_finds_no_fault_in_duels() -> None:
    assert_pettingzoo_finds_no_fault(lambda: calls.duel_environment(**SHORT))


def test_pettingzoo_finds_no_fault_in_games_of_a_file() -> None:
    file = calls.EXAMPLES / "two-pursuers.toml"
    assert_pettingzoo_finds_no_fault(
        lambda: calls.game_environment(file, "steps")
    )


@pytest.mark.parametrize(
    ("duration", "still", "more"),
    [
        (8 * PERIOD, STILL, {}),
        (8 * PERIOD, 7, {"action": "discrete", "headings": 7}),
        (60.0, STILL, {}),
    ],
)
def test_rewards_add_up_to_the_closest_approach(
    duration: float, still: Any, more: dict[str, Any]
) -> None:
    """Of an evader who stands, to a pursuer who walks up to it."""
    env = calls.environment("Evade", **SHORT | more | {"duration": duration})
    _, first = env.reset(seed=3)
    total, steps = 0.0, 0
    while True:
        _, reward, ended, late, info = env.step(still)
        total, steps = total + reward, steps + 1
        if ended or late:
            break
    assert late == (duration < 5.0) and (not late or steps == 8)
    nearer = first["distance_m"] - info["distance_m"]
    assert steps / 2 * STRIDE < nearer <= steps * STRIDE + 1e-6  # it turns
    assert info["closest_m"] == pytest.approx(info["distance_m"])
    assert UNIT * total == pytest.approx(-nearer)


def test_a_vector_of_64_games_is_64_games() -> None:
    """Game i of seed s is the single environment with seed s + i."""
    number, seed = 64, 5
    settings = SHORT | {"full_state": True}
    games = calls.vector_environment("Evade", number, **settings)
    seen, info = games.reset(seed=seed)
    assert seen.shape[0] == number
    singles = [calls.environment("Evade", **settings) for _ in range(number)]
    firsts = [env.reset(seed=seed + i) for i, env in enumerate(singles)]
    np.testing.assert_allclose(seen, [first[0] for first in firsts], atol=1e-6)
    rng, ends = np.random.default_rng(1), 0
    for _ in range(24):  # beyond the end of each
        actions = rng.uniform((-3.0, 0.0), (3.0, 1.0), (number, 2))
        actions = actions.astype(np.float32)
        seen, rewards, ended, late, info = games.step(actions)
        assert not (ended & late).any()
        for i, env in enumerate(singles):
            one, reward, *over, told = env.step(actions[i])
            assert [ended[i], late[i]] == over
            assert rewards[i] == pytest.approx(reward, abs=1e-6)
            if any(over):
                ends += 1
                final = info["final_info"]["closest_m"][i]
                assert final == pytest.approx(told["closest_m"], abs=1e-6)
                np.testing.assert_allclose(
                    info["final_obs"][i], one, atol=1e-5
                )
                one, _ = env.reset()
            np.testing.assert_allclose(seen[i], one, atol=1e-5)
    assert ends >= number


@pytest.mark.parametrize("kind", ["single", "vector", "both", "file"])
def test_a_game_that_ends_when_its_time_is_up_has_ended_only(
    kind: str, tmp_path: Any
) -> None:
    """Capture at the very end is an end, not a lack of time.

    First without a limit that counts, then with that time, and then with
    one decision less.
    """
    steps, time, *end = _play_to_the_end(kind, 60.0, tmp_path)
    assert end == [True, False]
    exact, until, *end = _play_to_the_end(kind, time, tmp_path)
    assert (exact, *end) == (steps, True, False)
    assert until == pytest.approx(time)
    less = PERIOD * (steps - 1)
    short, until, *end = _play_to_the_end(kind, less, tmp_path)
    assert (short, *end) == (steps - 1, False, True)
    assert until == pytest.approx(less)


def _play_to_the_end(
    kind: str, duration: float, folder: Any
) -> tuple[int, float, bool, bool]:
    """Walk up to an evader who stands; steps, time [s], and how it ended."""
    settings = SHORT | {"duration": duration}
    if kind == "single":
        env = calls.environment("Evade", **settings)
    elif kind == "vector":
        env = calls.vector_environment("Evade", 1, **settings)
    elif kind == "both":
        env = calls.duel_environment(**settings)
    else:
        file = folder / "game.toml"
        file.write_text(GAME.format(duration=duration))
        env = calls.game_environment(file, "steps")
    seen, _ = env.reset(seed=3)
    steps = 0
    while True:
        steps += 1
        if kind in ("single", "vector"):
            action = STILL if kind == "single" else STILL[None]
            seen, _, ended, late, _ = env.step(action)
            time = steps * PERIOD
        else:
            _, cos, sin = seen["pursuer"][_bearing(kind)]
            turn = np.array([np.arctan2(sin, cos), 1.0], np.float32)
            seen, rewards, ends, lates, infos = env.step(
                {"pursuer": turn, "evader": STILL}
            )
            assert rewards["pursuer"] == -rewards["evader"] >= 0.0
            assert len(set(ends.values())) == len(set(lates.values())) == 1
            ended, late = ends["evader"], lates["evader"]
            time = infos["evader"]["time_s"]
        if np.any(ended) or np.any(late):
            return steps, time, bool(np.all(ended)), bool(np.all(late))


def _bearing(kind: str) -> slice:
    """Where an observation holds distance or presence, cosine and sine."""
    return slice(0, 3) if kind == "both" else slice(1, 4)


GAME = """
duration = {duration}
[[players]]
name = "pursuer"
role = "pursuer"
start = [0.0, 0.0, 0.0]
[[players]]
name = "evader"
role = "evader"
start = [1.0, 0.0, 0.0]
"""
CROWDED = (
    GAME
    + """
[[players]]
name = "mate"
role = "evader"
strategy = "stand"
start = [1.0, 0.5, 0.0]
[[players]]
name = "guest"
role = "bystander"
strategy = "stand"
start = [1.0, -0.4, 0.0]
"""
)


def test_only_opponents_come_close_to_an_evader(tmp_path: Any) -> None:
    """Not the teammate 0.5 m and the bystander 0.4 m beside it."""
    file = tmp_path / "game.toml"
    file.write_text(CROWDED.format(duration=3.0))
    env = calls.game_environment(file, "steps")
    seen, infos = env.reset(seed=1)
    others = seen["evader"][1:].reshape(3, -1)  # guest, mate, pursuer
    apart = UNIT * others[:, 3]
    np.testing.assert_allclose(apart, [0.4, 0.5, 1.0], rtol=1e-6)
    opposed, allied = others[:, -2:].T
    assert list(opposed) == [0, 0, 1] and list(allied) == [0, 1, 0]
    closest = infos["evader"]["closest_m"]
    assert closest["evader"] == pytest.approx(1.0)
    assert closest["mate"] == pytest.approx(np.hypot(1.0, 0.5))
    still = dict.fromkeys(env.agents, STILL)
    gained = 0.0
    for _ in range(4):
        _, rewards, *_, infos = env.step(still | {"pursuer": AHEAD})
        gained += UNIT * rewards["evader"]
    closest = infos["evader"]["closest_m"]
    assert 1.0 - 4 * STRIDE <= closest["evader"] < 1.0
    assert gained == pytest.approx(closest["evader"] - 1.0)


def test_an_outcome_in_physics_is_one_word() -> None:
    env = calls.environment("Evade", level="physics", duration=60.0)
    env.reset(seed=3)
    ended = late = False
    while not (ended or late):
        _, _, ended, late, info = env.step(STILL)
    assert ended and info["outcome"] in ("contact", "touched", "fall")
