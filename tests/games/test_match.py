"""Test the loop and the judge of games on a fake world."""

import numpy as np
import pytest

from fake_players import TICK, FakeObserver, clock, fake_game, raising
from stepaside.core.errors import ReachError, StrategyError
from stepaside.core.player_identity import Role
from stepaside.games.game import Progress, play
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
    ("duration", "ticks"), [(0.04, 10), (0.0399, 10), (0.0401, 11)]
)
def test_a_game_lasts_its_duration(duration: float, ticks: int) -> None:
    game, world = fake_game(0.0, 2.0, duration=duration)
    play(game)
    assert game.outcome is Outcome.COMPLETED and world.ticks == ticks


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


def test_any_other_error_closes_the_world_as_well() -> None:
    watcher = FakeObserver()
    game, world = fake_game(0.0, 2.0, observers=[watcher])
    world.players[1].does[3] = raising(RuntimeError("a bolt came loose"))
    with pytest.raises(RuntimeError, match="bolt"):
        play(game)
    assert world.closed == 1 and watcher.ended_with == []


def test_a_fall_ends_a_game_before_a_contact() -> None:
    game, world = fake_game(0.0, 0.5)
    world.fell, world.contacts = ("a", "b"), ("a", "b")
    assert game.tick() is Outcome.FALL and world.ticks == 1
    assert game.message == "a and b fell at 0.00 s"
    assert game.fallen == ("a", "b") and game.touched == ()


def test_a_contact_ends_a_game() -> None:
    game, world = fake_game(0.0, 0.5)
    world.contacts = ("a", "thing 0")
    assert game.tick() is Outcome.CONTACT
    assert game.message == "a and thing 0 touched at 0.00 s"
    assert game.touched == ("a", "thing 0") and game.fallen == ()


def test_closest_approach_and_first_capture_are_noted() -> None:
    """In physics a capture ends no game."""
    game, world = fake_game(0.0, 5.0)
    closest = []
    for x in (4.0, 0.3, 3.0, 0.2):
        world.players[1].x = x
        assert game.tick() is None
        closest.append(game.closest["b", "a"])
    assert closest == [4.0, 0.3, 0.3, 0.2]
    assert game.captured_at == {("b", "a"): 2 * TICK}


@pytest.mark.parametrize(
    ("places", "roles", "distance"),
    [
        ((0.0,), (), None),
        ((0.0, 3.0, 1.0), (Role.PURSUER, Role.EVADER), 3.0),
        ((0.0, 3.0, 1.0), (), 1.0),
    ],
)
def test_progress_tells_the_distance_of_opponents_or_of_all(
    places: tuple[float, ...],
    roles: tuple[Role, ...],
    distance: float | None,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock(monkeypatch, 1.0)
    told: list[Progress] = []
    game, _ = fake_game(*places, duration=2 * TICK, roles=roles)
    play(game, report=told.append)
    assert told == [Progress(TICK, distance, TICK)]
