"""Test games side by side against the same games one by one."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from stepaside.arena import Room, RoomRecipe
from stepaside.core.errors import ConfigurationError
from stepaside.envs.environment_settings import EnvironmentSettings
from stepaside.envs.step_batch import CAPTURED, RUNNING, TOUCHED
from stepaside.envs.vector_duel import BatchedDuel, law_of
from stepaside.games import play_strategies
from stepaside.planning import Direction
from stepaside.strategies import (
    Evasion,
    LearnedStrategy,
    LookAhead,
    Pursuit,
    StandStill,
    Strategy,
)
from stepaside.strategies.learned import (
    StrategyContract,
    dense_network,
    discrete_headings,
)

ROOM = RoomRecipe(3.0, 3.0, discs=2, boxes=1)
OUTCOMES = {"completed": RUNNING, "captured": CAPTURED, "touched": TOUCHED}


def learned(terms: Sequence[str], width: int) -> LearnedStrategy:
    random = np.random.default_rng(2)
    layers = [
        (random.normal(size=(width, 16)), random.normal(size=16)),
        (random.normal(size=(16, 8)), random.normal(size=8)),
    ]
    contract = StrategyContract(
        Direction.BACKWARD, tuple(terms), discrete_headings(7)
    )
    return LearnedStrategy(dense_network(layers), contract)


SENSES = ("distance", "bearing", "bearing_rate", "closing_speed", "moving")
PAIRS: dict[str, tuple[Strategy, Strategy, Any]] = {
    "paper": (Pursuit(), Evasion(), None),
    "triggered": (
        Pursuit(gain=3.0),
        Evasion(0.6, safety_radius=0.7, release_distance=0.9),
        ROOM,
    ),
    "saturated": (
        Pursuit(saturated=True),
        Evasion(saturated=True, safety_radius=1e6),
        None,
    ),
    "standing": (Pursuit(gain=np.inf), StandStill(), ROOM),
    "learned": (Pursuit(), learned((*SENSES, "clearances"), 23), ROOM),
}


@pytest.mark.parametrize("pair", PAIRS)
@pytest.mark.parametrize("level", ["steps", "unicycle"])
def test_many_games_are_those_of_the_rules(pair: str, level: str) -> None:
    if (pair, level) == ("learned", "unicycle"):
        pytest.skip("its rates are differences of sightings that are thinned")
    pursuer, evader, room = PAIRS[pair]
    settings = EnvironmentSettings(
        level=level, room=room, arenas=12, duration=24.0
    )
    games = BatchedDuel(settings, 12, (pursuer, evader))
    games.start(np.arange(12), np.arange(12))
    goes_on = np.ones(12, np.bool_)
    closest, outcomes = np.zeros(12), np.zeros(12)
    for _ in range(games.rules.limit):
        games.step((None, None))
        closest[goes_on] = games.state.closest[goes_on]
        outcomes[goes_on] = games.outcomes[goes_on]
        goes_on &= games.outcomes == RUNNING
    arenas = games.arenas
    for i in range(12):
        track = play_strategies(
            pursuer,
            evader,
            arenas.starts[i],
            room=arenas.rooms[i],
            game=settings.step_game,
        )
        assert outcomes[i] == OUTCOMES[str(track.outcome)]
        if outcomes[i] == TOUCHED:
            assert closest[i] == 0.0
        else:
            expected = track.closest_distance
            assert closest[i] == pytest.approx(expected, abs=1e-9)
    assert pair != "standing" or (outcomes == CAPTURED).all()


def test_a_law_that_the_kernel_does_not_know_is_refused() -> None:
    with pytest.raises(ConfigurationError, match="got a LookAhead; others"):
        law_of(LookAhead())
    with pytest.raises(ConfigurationError, match="got a Evasion"):
        law_of(replace(Evasion(), trigger="time"))


def test_a_given_room_is_that_of_all_games() -> None:
    settings = EnvironmentSettings(room=Room(4.0, 3.0), arenas=5)
    rooms, starts = settings.draw_arenas()
    assert len({id(room) for room in rooms}) == 1
    assert len(set(starts)) == 5
