"""Test the loop and the judge of games on a fake world."""

import numpy as np
import pytest

from fake_players import TICK, FakeObserver, fake_game, raising
from stepaside.core.errors import ReachError, StrategyError
from stepaside.games.game import play
from stepaside.games.outcome import Outcome
from stepaside.games.recorder import Recorder


def test_players_act_in_turn_before_physics() -> None:
    watcher = FakeObserver()
    game, world = fake_game(
        0.0, 2.0, 5.0, duration=3 * TICK, observers=[watcher]
    )
    play(game)
    assert game.outcome is Outcome.COMPLETED
    assert game.message == "played 0.01 s"
    turn = ["before", "a", "b", "c", "acted", "time passes"]
    assert world.told == 3 * turn
    assert watcher.ended_with == [(game.outcome, game.message, world.time)]
    assert world.closed == 1


@pytest.mark.parametrize(
    ("error", "outcome", "said"),
    [
        (ReachError("too short"), Outcome.UNREACHABLE, "b lost its footing"),
        (
            StrategyError("KeyError"),
            Outcome.FAILED,
            "b's strategy failed",
        ),
    ],
)
def test_a_player_that_fails_ends_a_game_which_is_recorded(
    error: Exception, outcome: Outcome, said: str
) -> None:
    """Players after it do not act any more."""
    watcher = FakeObserver()
    game, world = fake_game(0.0, 2.0, 5.0)
    recorder = Recorder(world)
    game.observers = (recorder, watcher)
    world.players[1].does[12] = raising(error)
    play(game)
    assert game.outcome is outcome and world.ticks == 12
    assert game.message == f"{said} at 0.05 s: {error}"
    assert watcher.ended_with == [(outcome, game.message, world.time)]
    assert world.closed == 1
    np.testing.assert_allclose(recorder.times, [0.0, 0.02, 0.04, 0.048])
    assert all(len(t.com) == 4 for t in recorder.tracks().values())


@pytest.mark.parametrize("at", [10, 12])
def test_an_interrupted_game_is_recorded_and_closed(at: int) -> None:
    """No instant is recorded twice, even an incomplete one."""
    game, world = fake_game(0.0, 2.0, 5.0)
    recorder = Recorder(world)
    game.observers = (recorder,)
    world.players[1].does[at] = raising(KeyboardInterrupt())
    play(game)
    assert game.outcome is Outcome.INTERRUPTED and world.closed == 1
    assert game.message == f"interrupted at {at * TICK:.2f} s"
    rest = [] if at == 10 else [0.048]
    np.testing.assert_allclose(recorder.times, [0.0, 0.02, 0.04, *rest])


def test_an_interrupt_keeps_games_that_have_ended() -> None:
    ended, _ = fake_game(0.0, 2.0, duration=2 * TICK)
    going, world = fake_game(0.0, 2.0)
    world.players[0].does[5] = raising(KeyboardInterrupt())
    play(ended, going)
    assert ended.outcome is Outcome.COMPLETED
    assert going.outcome is Outcome.INTERRUPTED


def test_a_contact_ends_a_game() -> None:
    game, world = fake_game(0.0, 0.5)
    world.contacts = ("a", "thing 0")
    assert game.tick() is Outcome.CONTACT
    assert game.message == "a and thing 0 touched at 0.00 s"
    assert game.touched == ("a", "thing 0") and game.fallen == ()
