"""Test the loop and the judge of games on a fake world."""

from collections.abc import Callable
from math import hypot, inf
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from stepaside.core.errors import ReachError, StrategyError
from stepaside.core.player_identity import PlayerIdentity, Role
from stepaside.core.poses import Pose
from stepaside.games.game import (
    GameInPlay,
    GameObserver,
    GameRules,
    Outcome,
    play,
)
from stepaside.games.recorder import Recorder

TICK = 0.004


class FakePlayer:
    """Stands where it is told, and does what it is told at a tick."""

    begun = frame = maneuvers = None
    pushes = ()

    def __init__(self, world: "FakeWorld", name: str, x: float) -> None:
        self.world, self.name, self.x = world, name, x
        self.does: dict[int, Callable[[], None]] = {}

    def sample(self, *, closely: bool) -> dict[str, Any]:
        """Return what every player has."""
        pose = (self.x, 0.0, 0.0)
        return {"com": (self.x, 0.0, 0.3), "place": pose, "torso": pose}


class FakeWorld:
    """A clock, players on a line, and falls and contacts as they are told."""

    contact = Outcome.CONTACT

    def __init__(self, *places: float) -> None:
        self.ticks, self.closed, self.acting = 0, 0, ""
        self.physics = SimpleNamespace(tick=TICK)
        self.fell: tuple[str, ...] = ()
        self.contacts: tuple[str, ...] = ()
        self.told: list[str] = []
        self.players = [
            FakePlayer(self, name, x)
            for name, x in zip("abcdef", places, strict=False)
        ]

    @property
    def time(self) -> float:
        """Time, in [s]."""
        return self.ticks * float(self.physics.tick)

    def states(self) -> dict[str, Pose]:
        """Poses of all players."""
        return {p.name: Pose(p.x, 0.0, 0.0) for p in self.players}

    def apart(self, one: str, other: str) -> float:
        """Distance of two players."""
        x, y = (self.states()[name].x for name in (one, other))
        return hypot(x - y, 0.0)

    def decide(self) -> None:
        """Let all players do what they were told for this tick."""
        for player in self.players:
            self.acting = player.name
            self.told.append(player.name)
            player.does.get(self.ticks, lambda: None)()

    def step(self, limit: float = inf) -> None:
        """Let a tick pass."""
        self.told.append("time passes")
        self.ticks += 1

    def fallen(self) -> tuple[str, ...]:
        """Players whose fall was requested."""
        return self.fell if self.ticks else ()

    def touching(self) -> tuple[str, ...]:
        """Players whose contact was requested."""
        return self.contacts if self.ticks else ()

    def close(self) -> None:
        """Count it."""
        self.closed += 1


class FakeObserver(GameObserver):
    """Tells the world's list when it looked."""

    def __init__(self) -> None:
        self.ended_with: list[tuple[Outcome | None, str, float]] = []

    def before(self, game: GameInPlay) -> None:
        """Look first."""
        self._tell(game, "before")

    def acted(self, game: GameInPlay) -> None:
        """Look after all acted."""
        self._tell(game, "acted")

    def ended(self, game: GameInPlay) -> None:
        """Note how it ended."""
        self.ended_with.append((game.outcome, game.message, game.world.time))

    def _tell(self, game: GameInPlay, word: str) -> None:
        world: Any = game.world
        world.told.append(word)


def fake_game(
    *places: float,
    duration: float = 1.0,
    observers: Any = (),
    roles: tuple[Role, ...] = (Role.PURSUER, Role.EVADER),
) -> tuple[GameInPlay, Any]:
    """Players on a line, named a, b, c, ...: by default a pursues b."""
    world: Any = FakeWorld(*places)
    identities = {
        player.name: PlayerIdentity(player.name, role, role)
        for player, role in zip(world.players, roles, strict=False)
    }
    rules = GameRules(duration, identities=identities)
    return GameInPlay(world, rules, observers), world


def raising(error: BaseException) -> Callable[[], None]:
    """Callable that raises an error."""

    def act() -> None:
        raise error

    return act


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
        (StrategyError("Key"), Outcome.FAILED, "b's strategy failed"),
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


def test_a_contact_ends_a_game() -> None:
    game, world = fake_game(0.0, 0.5)
    world.contacts = ("a", "thing 0")
    assert game.tick() is Outcome.CONTACT
    assert game.message == "a and thing 0 touched at 0.00 s"
    assert game.touched == ("a", "thing 0") and game.fallen == ()


def test_a_game_that_begins_with_a_fall_is_over() -> None:
    game, world = fake_game(0.0, 0.5)
    assert game.ended is None
    world.fell, world.ticks = ("a",), 1
    over = GameInPlay(world, game.rules, ())
    assert over.ended is not None and over.fallen == ("a",)
