"""Match loop: players in a simulated world, advanced tick by tick."""

from collections.abc import Callable, Sequence
from itertools import combinations
from math import ceil
from time import perf_counter
from typing import Protocol

from ..core.errors import ReachError, StrategyError
from ..core.signal_handling import DeferredInterrupt
from ..locomotion.policy.network_pool import NetworkPool
from ..sim.ground_truth import torsos_apart
from ..sim.world import World
from .game import REPORT_PERIOD, Progress
from .outcome import Outcome
from .player import Player


class MatchObserver(Protocol):
    """Observer of a match, such as a recorder or a live page."""

    def before(self, match: "Match") -> None:
        """Observe a tick before the players act."""

    def acted(self, match: "Match") -> None:
        """Observe a tick after the players have acted, before physics."""

    def ended(self, match: "Match", outcome: Outcome) -> None:
        """Observe the end of the game."""


class Match:
    """One game that is being played.

    Attributes:
        world: The simulation.
        players: The players, in the order in which they act.
        observers: The observers.
        networks: Networks of players on learned legs.
        message: Reason for the end, as text; empty during the game.
        touched: Names of the bodies in contact, if contact ended the game.
        fallen: Names of the players that have fallen.
        started_at: Time at which the game began, in [s]: all players were
            ready, for example had scanned the room; None before.
    """

    def __init__(
        self,
        world: World,
        players: Sequence[Player],
        observers: Sequence[MatchObserver] = (),
        *,
        has_things: bool = False,
        networks: NetworkPool | None = None,
    ) -> None:
        """Prepare a match.

        Args:
            world: The simulation, with all players in it.
            players: The players.
            observers: The observers.
            has_things: Whether there are obstacles besides the players.
            networks: Networks of players on learned legs, if any.
        """
        self.world = world
        self.networks = networks or NetworkPool()
        self.players = tuple(players)
        self.observers = tuple(observers)
        self.message = ""
        self.touched: tuple[str, ...] = ()
        self.fallen: tuple[str, ...] = ()
        self._has_things = has_things
        self._pairs = [
            (one.truth, other.truth, one.truth.reach + other.truth.reach)
            for one, other in combinations(self.players, 2)
        ]
        self.started_at: float | None = None

    @property
    def distance(self) -> float | None:
        """True distance of the players, in [m], as the rules define it."""
        return None

    def player(self, name: str) -> Player:
        """Return the player with a name.

        Raises:
            KeyError: If there is none.
        """
        for player in self.players:
            if player.name == name:
                return player
        raise KeyError(name)

    def tick(self) -> Outcome | None:
        """Advance by one control tick; return the outcome at the end."""
        ended = self.decide()
        if ended is not None:
            return ended
        self.networks.flush()
        return self.advance()

    def decide(self) -> Outcome | None:
        """Let all players act at one control tick, before the networks.

        Returns:
            The outcome, if a player failed.
        """
        for observer in self.observers:
            observer.before(self)
        self._start()
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
        return None

    def advance(self) -> Outcome | None:
        """Advance the world to the next tick, once all targets are sent.

        Returns:
            The outcome at the end of the game.
        """
        for observer in self.observers:
            observer.acted(self)
        self.world.step()
        return self._judge()

    def _start(self) -> None:
        """Begin the game once all players are ready."""
        if self.started_at is not None:
            return
        if all(player.is_ready for player in self.players):
            self.started_at = self.world.time
            for player in self.players:
                player.start()

    def _judge(self) -> Outcome | None:
        """Apply the rules: a fall or a contact ends the game."""
        now = self.world.time
        fallen = [p.name for p in self.players if p.has_fallen]
        if fallen:
            self.fallen = tuple(fallen)
            self.message = f"{' and '.join(fallen)} fell at {now:.2f} s"
            return Outcome.FALL
        if self._can_touch() and self.world.robots_touch():
            self.touched = self.world.touching()
            self.message = f"{' and '.join(self.touched)} touched at "
            self.message += f"{now:.2f} s"
            return Outcome.CONTACT
        return None

    def _can_touch(self) -> bool:
        """Return whether a contact is possible."""
        return self._has_things or any(
            torsos_apart(one, other) < reach
            for one, other, reach in self._pairs
        )

    def close(self) -> None:
        """Close all players."""
        for player in self.players:
            player.close()


def play(
    match: Match,
    duration: float,
    report: Callable[[Progress], None] | None = None,
) -> tuple[Outcome, float]:
    """Play a match to its end; see :func:`play_together`."""
    return play_together([match], [duration], report)[0]


def play_together(
    matches: Sequence[Match],
    durations: Sequence[float],
    report: Callable[[Progress], None] | None = None,
) -> list[tuple[Outcome, float]]:
    """Play matches side by side, with one evaluation of their networks.

    Each match has the same bits as when it is played alone. At any end,
    including a KeyboardInterrupt, which interrupts those that still go on,
    the observers keep the record of what was played, and the players are
    closed.

    Args:
        matches: Matches, which share their networks.
        durations: Simulated time after which each is completed, in [s].
        report: Called about five times a second with the progress of the
            first match.

    Returns:
        Outcome, and share of the computing time in [s], of each match.
    """
    outcomes: dict[Match, Outcome] = {}
    began = reported = perf_counter()
    ends = {
        match: ceil(duration / match.world.physics.tick - 1e-9)
        for match, duration in zip(matches, durations, strict=True)
    }
    pools = {match.networks for match in matches}
    try:
        with DeferredInterrupt() as interrupt:
            while playing := [m for m in matches if m not in outcomes]:
                interrupt.let_through()
                for match in playing:
                    if (ended := match.decide()) is not None:
                        outcomes[match] = ended
                for pool in pools:
                    pool.flush()
                for match in playing:
                    if match in outcomes:
                        continue
                    if (ended := match.advance()) is not None:
                        outcomes[match] = ended
                    elif match.world.ticks >= ends[match]:
                        outcomes[match] = Outcome.COMPLETED
                first = matches[0]
                if report is None or first not in playing:
                    continue
                if first.world.ticks % 25:
                    continue
                now, time = perf_counter(), first.world.time
                if now - reported > REPORT_PERIOD:
                    reported, factor = now, time / (now - began)
                    report(Progress(time, first.distance, factor))
    except KeyboardInterrupt:
        for match in matches:
            if match not in outcomes:
                outcomes[match] = Outcome.INTERRUPTED
                match.message = f"interrupted at {match.world.time:.2f} s"
    finally:
        for match in matches:
            match.close()
    wall = (perf_counter() - began) / max(1, len(matches))
    for match in matches:
        _end(match, outcomes[match])
    return [(outcomes[match], wall) for match in matches]


def _end(match: Match, outcome: Outcome) -> None:
    """Tell the observers how a match ended."""
    if outcome is Outcome.COMPLETED and not match.message:
        match.message = f"played {match.world.time:.2f} s"
    for observer in match.observers:
        observer.ended(match, outcome)
