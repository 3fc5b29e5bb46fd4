"""Test the match loop on fake players."""

import numpy as np
import pytest

from fake_players import TICK, FakeObserver, clock, game, pair, raising
from stepaside.core.errors import ReachError, StrategyError
from stepaside.games.game import Progress
from stepaside.games.match import play
from stepaside.games.outcome import Outcome
from stepaside.games.recorder import Recorder


def test_three_players_act_in_turn_before_physics_advances() -> None:
    """Observers are called before and after all players act."""
    watcher = FakeObserver()
    match, world, players = game(0.0, 2.0, 5.0, observers=[watcher])
    outcome, _ = play(match, 3 * TICK)
    assert outcome is Outcome.COMPLETED and match.message == "played 0.01 s"
    turn = ["before", "a", "b", "c", "acted", "time passes"]
    assert world.told == 3 * turn
    assert watcher.ended_with == [(outcome, match.message, world.time)]
    assert [player.closed for player in players] == [1, 1, 1]


@pytest.mark.parametrize(
    ("duration", "ticks"), [(0.04, 10), (0.0399, 10), (0.0401, 11)]
)
def test_a_game_lasts_its_duration(duration: float, ticks: int) -> None:
    match, world, _ = game(0.0, 2.0)
    assert play(match, duration)[0] is Outcome.COMPLETED
    assert world.ticks == ticks


@pytest.mark.parametrize("clumsy", [0, 1, 2])
def test_an_unreachable_reference_ends_a_game_and_it_is_recorded(
    clumsy: int,
) -> None:
    """Of any player; players after it do not act any more."""
    watcher = FakeObserver()
    match, world, players = game(0.0, 2.0, 5.0)
    recorder = Recorder(players, tick=TICK)
    match.observers = (recorder, watcher)
    name = players[clumsy].name
    players[clumsy].does[12] = raising(ReachError("a leg is too short"))
    outcome, _ = play(match, 1.0)
    assert outcome is Outcome.UNREACHABLE and world.ticks == 12
    said = f"{name} lost its footing at 0.05 s: a leg is too short"
    assert match.message == said
    assert watcher.ended_with == [(outcome, said, world.time)]
    assert world.told[-2 - clumsy :] == ["before", *"abc"[: clumsy + 1]]
    assert [player.closed for player in players] == [1, 1, 1]
    np.testing.assert_allclose(recorder.times, [0.0, 0.02, 0.04, 0.048])
    assert all(len(t.com) == 4 for t in recorder.tracks().values())


def test_a_failing_strategy_ends_a_game_and_it_is_recorded() -> None:
    watcher = FakeObserver()
    match, world, players = game(0.0, 2.0, observers=[watcher])
    players[1].does[3] = raising(StrategyError("KeyError: 'x'"))
    outcome, _ = play(match, 1.0)
    said = "b's strategy failed at 0.01 s: KeyError: 'x'"
    assert outcome is Outcome.FAILED and match.message == said
    assert watcher.ended_with == [(outcome, said, 3 * TICK)]
    assert [player.closed for player in players] == [1, 1]


@pytest.mark.parametrize("at", [10, 12])
@pytest.mark.parametrize("who", [0, 1, 2])
def test_an_interrupted_game_is_recorded_and_its_players_closed(
    who: int, at: int
) -> None:
    """No instant is recorded twice, even an incomplete one."""
    watcher = FakeObserver()
    match, world, players = game(0.0, 2.0, 5.0)
    recorder = Recorder(players, tick=TICK)
    match.observers = (recorder, watcher)
    players[who].does[at] = raising(KeyboardInterrupt())
    outcome, _ = play(match, 1.0)
    assert outcome is Outcome.INTERRUPTED
    assert match.message == f"interrupted at {at * TICK:.2f} s"
    assert watcher.ended_with == [(outcome, match.message, world.time)]
    assert [player.closed for player in players] == [1, 1, 1]
    rest = [] if at == 10 else [0.048]
    np.testing.assert_allclose(recorder.times, [0.0, 0.02, 0.04, *rest])


def test_any_other_error_closes_the_players_as_well() -> None:
    watcher = FakeObserver()
    match, _, players = game(0.0, 2.0, observers=[watcher])
    players[1].does[3] = raising(RuntimeError("a bolt came loose"))
    with pytest.raises(RuntimeError, match="bolt"):
        play(match, 1.0)
    assert [player.closed for player in players] == [1, 1]
    assert watcher.ended_with == []


@pytest.mark.parametrize(
    ("fallen", "who"), [((0,), "a"), ((2,), "c"), ((0, 2), "a and c")]
)
def test_a_fall_of_any_player_ends_a_game(
    fallen: tuple[int, ...], who: str
) -> None:
    """A player that falls onto another has fallen."""
    match, world, players = game(0.0, 0.5, 1.0)
    world.contacts = ("a", "b")
    for number in fallen:
        players[number].has_fallen = True
    outcome, _ = play(match, 1.0)
    assert outcome is Outcome.FALL and world.ticks == 1
    assert match.message == f"{who} fell at 0.00 s"


@pytest.mark.parametrize(
    ("places", "asked"),
    [((0.0, 0.79), 1), ((0.0, 0.81), 0), ((0.0, 3.0, 3.5), 1), ((0.0,), 0)],
)
def test_contact_is_checked_where_any_two_players_are_near(
    places: tuple[float, ...], asked: int
) -> None:
    match, world, _ = game(*places)
    assert match.tick() is None
    assert world.asked == asked
    world.contacts = ("b", "c")
    assert match.tick() is (Outcome.CONTACT if asked else None)
    assert match.message == ("b and c touched at 0.01 s" if asked else "")


def test_contact_is_always_checked_with_obstacles() -> None:
    match, world, _ = game(0.0, has_things=True)
    world.contacts = ("a", "thing 0")
    assert match.tick() is Outcome.CONTACT
    assert match.message == "a and thing 0 touched at 0.00 s"


def test_closest_approach_and_first_motion_of_the_evader_are_recorded() -> (
    None
):
    match, _, players = pair(0.0, 5.0)
    others = []

    def stand(x: float, *, moves: bool) -> None:
        players[1].truth.position_torso_in_world = (x, 0.0)
        players[1].is_moving = moves
        assert match.tick() is None
        others.append(match.min_distance)

    players[0].is_moving = True
    for x, moves in ((4.0, False), (2.0, True), (3.0, True), (1.5, True)):
        stand(x, moves=moves)
    assert others == [4.0, 2.0, 2.0, 1.5]
    assert match.triggered_at == 2 * TICK
    assert match.triggered_distance == 2.0


def test_a_single_player_has_no_distance(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock(monkeypatch, 1.0)
    told: list[Progress] = []
    match, _, _ = game(0.0)
    play(match, 0.1, told.append)
    assert told == [Progress(0.1, None, 0.1)]


def test_a_progress_report_may_interrupt(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock(monkeypatch, 1.0)
    watcher = FakeObserver()
    match, _, players = game(0.0, 1.3, observers=[watcher])

    def interrupt(progress: Progress) -> None:
        raise KeyboardInterrupt

    outcome, _ = play(match, 5.0, interrupt)
    assert outcome is Outcome.INTERRUPTED
    assert match.message == "interrupted at 0.10 s"
    assert len(watcher.ended_with) == 1
    assert [player.closed for player in players] == [1, 1]


def test_a_game_begins_when_all_players_are_ready() -> None:
    """Each is told once; earlier motion of the evader is no trigger."""
    match, world, players = pair(0.0, 5.0)
    players[0].is_ready = False
    players[1].is_moving = True

    def finish() -> None:
        players[0].is_ready = True

    players[0].does[2] = finish
    for _ in range(3):
        match.tick()
        assert match.started_at is None and match.triggered_at is None
        assert [player.starts for player in players] == [0, 0]
    begun = world.time
    for _ in range(2):
        match.tick()
        assert match.started_at == begun
        assert [player.starts for player in players] == [1, 1]
    assert match.triggered_at == pytest.approx(begun + world.physics.tick)
