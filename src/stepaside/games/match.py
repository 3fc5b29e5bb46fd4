"""The one loop in which players play, whoever and how many they are."""

from collections.abc import Callable, Sequence
from itertools import combinations
from math import ceil, hypot
from time import perf_counter
from typing import NamedTuple, Protocol

from ..core.constants import CAPTURE_DISTANCE
from ..core.errors import ReachError, StrategyError
from ..core.interrupts import DeferredInterrupt
from ..sim.ground_truth import torsos_apart
from ..sim.world import World
from .outcome import Outcome
from .player import Player

TOLD = 0.2  # time that passes between two words of progress, in [s]


class Progress(NamedTuple):
    """How far a game has come.

    Attributes:
        time: Simulated time, in [s].
        distance: Between the places of the first two, in [m]; None if one
            plays alone.
        real_time_factor: Simulated time over time passed.
    """

    time: float
    distance: float | None
    real_time_factor: float


class MatchObserver(Protocol):
    """Whoever looks on: a recorder, a judge of sight, a page."""

    def before(self, match: "Match") -> None:
        """Look before anybody has moved at a tick."""

    def acted(self, match: "Match") -> None:
        """Look when all have acted, before time passes."""

    def ended(self, match: "Match", outcome: Outcome) -> None:
        """Look when the game is over."""


class Match:
    """Players in a world, tick by tick.

    Attributes:
        world: The physics.
        players: Who plays, in the order in which they act.
        observers: Who looks on.
        message: What ended the game, in words; empty while it goes on.
        touched: Names of who and what met, if that ended it.
        min_distance: Least distance between the first two torsos, in [m].
        captured_at: When that distance first was at most the capture
            distance, in [s]; None if it never was. The game goes on.
        triggered_at: When the last player began to move, in [s]; None if it
            never did.
        triggered_distance: Distance between the places then, in [m].
    """

    def __init__(
        self,
        world: World,
        players: Sequence[Player],
        observers: Sequence[MatchObserver] = (),
        *,
        has_things: bool = False,
    ) -> None:
        """Begin a game.

        Args:
            world: The physics, in which everybody stands.
            players: Who plays.
            observers: Who looks on.
            has_things: Whether there is more to bump into than players.
        """
        self.world = world
        self.players = tuple(players)
        self.observers = tuple(observers)
        self.message = ""
        self.touched: tuple[str, ...] = ()
        self._has_things = has_things
        self.min_distance = self.torsos_apart
        self.captured_at: float | None = None
        self.triggered_at: float | None = None
        self.triggered_distance: float | None = None

    @property
    def distance(self) -> float | None:
        """True distance between the places of the first two, in [m]."""
        if len(self.players) < 2:
            return None
        (x, y), (u, v) = (player.truth.place for player in self.players[:2])
        return hypot(u - x, v - y)

    @property
    def torsos_apart(self) -> float | None:
        """True distance between the first two torsos, in [m]."""
        if len(self.players) < 2:
            return None
        first, second = self.players[:2]
        return torsos_apart(first.truth, second.truth)

    def player(self, name: str) -> Player:
        """Player with a name.

        Raises:
            KeyError: If nobody has it.
        """
        for player in self.players:
            if player.name == name:
                return player
        raise KeyError(name)

    def tick(self) -> Outcome | None:
        """Play one control tick; an outcome if it ends the game."""
        for observer in self.observers:
            observer.before(self)
        for player in self.players:
            try:
                player.tick()
            except ReachError as error:
                self.message = (
                    f"{player.name} lost its footing at "
                    f"{self.world.time:.2f} s: {error}"
                )
                return Outcome.UNREACHABLE
            except StrategyError as error:
                self.message = (
                    f"{player.name}'s strategy failed at "
                    f"{self.world.time:.2f} s: {error}"
                )
                return Outcome.FAILED
        for observer in self.observers:
            observer.acted(self)
        self.world.step()
        return self._judge()

    def _judge(self) -> Outcome | None:
        """Apply the rules: who falls or touches has ended the game."""
        now, apart = self.world.time, self.torsos_apart
        if self.triggered_at is None and self.players[-1].is_moving:
            self.triggered_at = now
            self.triggered_distance = self.distance
        if apart is not None:
            assert self.min_distance is not None
            self.min_distance = min(self.min_distance, apart)
            if self.captured_at is None and apart <= CAPTURE_DISTANCE:
                self.captured_at = now
        fallen = [p.name for p in self.players if p.has_fallen]
        if fallen:
            self.message = f"{' and '.join(fallen)} fell at {now:.2f} s"
            return Outcome.FALL
        if self._can_touch() and self.world.robots_touch():
            self.touched = self.world.touching()
            self.message = f"{' and '.join(self.touched)} touched at "
            self.message += f"{now:.2f} s"
            return Outcome.CONTACT
        return None

    def _can_touch(self) -> bool:
        """Whether anybody is near enough to touch another, or a thing."""
        return self._has_things or any(
            torsos_apart(one.truth, other.truth)
            < one.truth.reach + other.truth.reach
            for one, other in combinations(self.players, 2)
        )

    def close(self) -> None:
        """Let everybody go."""
        for player in self.players:
            player.close()


def play(
    match: Match,
    duration: float,
    report: Callable[[Progress], None] | None = None,
) -> tuple[Outcome, float]:
    """Play a game to its end.

    Whatever ends it, a KeyboardInterrupt included, what was played stays
    with the observers, and the players are let go.

    Args:
        match: The game.
        duration: Simulated time after which it is completed, in [s].
        report: Called about five times a second with the progress.

    Returns:
        How it ended, and the time that it took, in [s].
    """
    ticks = ceil(duration / match.world.physics.tick - 1e-9)
    outcome = Outcome.COMPLETED
    began = perf_counter()
    try:
        with DeferredInterrupt() as held:
            outcome = _play_on(match, ticks, held, began, report)
    except KeyboardInterrupt:
        outcome = Outcome.INTERRUPTED
        match.message = f"interrupted at {match.world.time:.2f} s"
    finally:
        match.close()
    wall = perf_counter() - began
    if outcome is Outcome.COMPLETED:
        match.message = f"played {match.world.time:.2f} s"
    for observer in match.observers:
        observer.ended(match, outcome)
    return outcome, wall


def _play_on(
    match: Match,
    ticks: int,
    held: DeferredInterrupt,
    began: float,
    report: Callable[[Progress], None] | None,
) -> Outcome:
    """Play so many ticks, or to an end; an interrupt waits for whole ones."""
    world, told = match.world, began
    while world.ticks < ticks:
        held.let_through()
        ended = match.tick()
        if ended is not None:
            return ended
        if report is not None and world.ticks % 25 == 0:
            now = perf_counter()
            if now - told > TOLD:
                told = now
                factor = world.time / (now - began)
                report(Progress(world.time, match.distance, factor))
    return Outcome.COMPLETED
