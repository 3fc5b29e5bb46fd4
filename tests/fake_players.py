"""Fake players and a fake world, for tests of matches and recorders."""

from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import Array, Pose
from stepaside.games import match as loop
from stepaside.games.match import Match
from stepaside.games.outcome import Outcome
from stepaside.games.pair_match import PairMatch
from stepaside.games.player import Snapshot
from stepaside.locomotion.walk_snapshots import StepStarted
from stepaside.planning import Foot
from stepaside.sim.push import Push

TICK = 0.004


class FakeTruth:
    """A place on the floor."""

    reach = 0.4

    def __init__(self, x: float, y: float) -> None:
        self.position_torso_in_world, self.heading_in_world = (x, y), 0.0

    @property
    def position_reference_in_world(self) -> tuple[float, float]:
        """Reference point: 0.1 m to the left."""
        x, y = self.position_torso_in_world
        return x, y + 0.1


class FakeWorld:
    """A clock, and contacts as they are told."""

    def __init__(self, tick: float = TICK) -> None:
        self.ticks = 0
        self.physics = SimpleNamespace(tick=tick)
        self.contacts: tuple[str, ...] = ()
        self.asked = 0
        self.told: list[str] = []

    @property
    def time(self) -> float:
        """Time, in [s]."""
        return self.ticks * float(self.physics.tick)

    def step(self) -> None:
        """Let a tick pass."""
        self.told.append("time passes")
        self.ticks += 1

    def robots_touch(self) -> bool:
        """Whether a contact was requested."""
        self.asked += 1
        return bool(self.contacts)

    def touching(self) -> tuple[str, ...]:
        """Players whose contact was requested."""
        return self.contacts


class FakeLog:
    """Samples of what a player was told to be seen as."""

    def __init__(self, player: "FakePlayer") -> None:
        self._player = player
        self._seen: list[Snapshot] = []

    def add(self) -> None:
        """Take a sample."""
        self._seen.append(self._player.snapshot())

    def truncate(self, count: int) -> None:
        """Keep the first samples."""
        del self._seen[count:]

    def arrays(self) -> dict[str, Array]:
        """Return what every player has."""
        return {
            name: np.array(
                [getattr(seen, name) for seen in self._seen], dtype=float
            ).reshape(-1, 3)
            for name in ("com", "place", "torso")
        }


class FakePlayer:
    """Does what it is told at a tick; its ticks are told to its world."""

    def __init__(
        self, world: FakeWorld, name: str, x: float = 0.0, y: float = 0.0
    ) -> None:
        self.world, self.name = world, name
        self.truth: Any = FakeTruth(x, y)
        self.begun: StepStarted | None = None
        self.reports: Any = ()
        self.is_ready = True
        self.starts = 0
        self.is_moving = self.has_fallen = False
        self.closed = 0
        self.does: dict[int, Callable[[], None]] = {}
        self.seen: dict[str, Any] = {}

    def start(self) -> None:
        """Count it."""
        self.starts += 1

    def tick(self) -> None:
        """Do what was told for this tick."""
        self.world.told.append(self.name)
        self.does.get(self.world.ticks, lambda: None)()

    def snapshot(self) -> Snapshot:
        """Requested sighting, by default of a position."""
        x, y = self.truth.position_torso_in_world
        values: dict[str, Any] = {
            "place": Pose(x, y + 0.1, self.truth.heading_in_world),
            "torso": Pose(x, y, self.truth.heading_in_world),
            "com": (x, y, 0.3),
        } | self.seen
        return Snapshot(self.name, self.world.time, **values)

    def motion_log(self, *, closely: bool) -> FakeLog:
        """Return an empty log."""
        return FakeLog(self)

    def push(self, *pushes: Push) -> None:
        """Stand like a rock."""

    def close(self) -> None:
        """Count it."""
        self.closed += 1


class FakeObserver:
    """Tells the world's list when it looked."""

    def __init__(self) -> None:
        self.ended_with: list[tuple[Outcome, str, float]] = []

    def before(self, match: Match) -> None:
        """Look first."""
        self._tell(match, "before")

    def acted(self, match: Match) -> None:
        """Look after all acted."""
        self._tell(match, "acted")

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Note how it ended."""
        self.ended_with.append((outcome, match.message, match.world.time))

    def _tell(self, match: Match, word: str) -> None:
        world: Any = match.world
        world.told.append(word)


def game(
    *places: float, observers: Any = (), **options: Any
) -> tuple[Match, FakeWorld, list[FakePlayer]]:
    """Players on a line, named a, b, c, ..."""
    world: Any = FakeWorld()
    players = [
        FakePlayer(world, name, x)
        for name, x in zip("abcdef", places, strict=False)
    ]
    match = Match(world, players, observers, **options)
    return match, world, players


def pair(
    *places: float, observers: Any = (), **options: Any
) -> tuple[PairMatch, FakeWorld, list[FakePlayer]]:
    """Pursuer and evader on a line, named a and b."""
    _, world, players = game(*places)
    in_match: Any = world
    match = PairMatch(in_match, players, observers, **options)
    return match, world, players


def raising(error: BaseException) -> Callable[[], None]:
    """Callable that raises an error."""

    def act() -> None:
        raise error

    return act


def begun(**changes: Any) -> StepStarted:
    """A step whose plan has a margin of 2 cm in the part that is walked."""
    plan: Any = SimpleNamespace(
        schedule=SimpleNamespace(first_step_duration=0.5),
        margin=lambda duration: 0.04 * duration,
    )
    values: dict[str, Any] = {
        "plan": plan,
        "started": 0.6,
        "landing_time": 1.0,
        "foot": Foot.LEFT,
        "landing": Pose(0.3, 0.1, 0.2),
        "planning_time": 2e-4,
        "velocity_jump": 0.0,
    } | changes
    return StepStarted(**values)


def clock(monkeypatch: pytest.MonkeyPatch, step: float) -> None:
    """Wall clock that advances at every reading."""

    def ticking() -> Iterator[float]:
        now = 100.0
        while True:
            yield now
            now += step

    times = ticking()
    monkeypatch.setattr(loop, "perf_counter", lambda: next(times))
