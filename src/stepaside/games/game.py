"""The one game: a world, rules, a judge, and the loop that plays it.

The world is one of bodies in physics or a floor of templates.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from math import hypot, inf
from time import perf_counter
from typing import NamedTuple, Protocol

from ..core.errors import ReachError, StrategyError
from ..core.player_identity import PlayerIdentity
from ..core.poses import Pose
from ..core.signal_handling import DeferredInterrupt
from .outcome import Outcome

ARRIVAL = 0.3  # distance from a goal at which it is reached, in [m]
REPORT_PERIOD = 0.2  # between two progress reports, in [s]


class Networks(Protocol):
    """Networks of players, evaluated between decisions and motion."""

    def flush(self) -> None:
        """Evaluate all that wait."""


class PlayedWorld(Protocol):
    """World in which a game is played.

    Attributes:
        time: Time, in [s].
    """

    time: float

    @property
    def networks(self) -> Networks | None:
        """Networks of the players, which games side by side share."""

    def states(self) -> Mapping[str, Pose]:
        """Return the pose of each player in the world, by name."""

    def decide(self) -> None:
        """Let the players decide that are due.

        Raises:
            ReachError: If a robot cannot take its next step.
            StrategyError: If a strategy fails.
        """

    def step(self, limit: float) -> None:
        """Move all players on, at most to a time, in [s]."""

    def fallen(self) -> Sequence[str]:
        """Return the names of the players that have fallen."""

    def touching(self) -> Sequence[str]:
        """Return the names of bodies in contact, or of one at an obstacle."""

    def close(self) -> None:
        """Release what the players hold."""


class GameObserver(Protocol):
    """Observer of a game, such as a recorder."""

    def before(self, game: "GameInPlay") -> None:
        """Observe the world before the players decide."""

    def acted(self, game: "GameInPlay") -> None:
        """Observe the world after they have decided, before they move."""

    def ended(self, game: "GameInPlay") -> None:
        """Observe the end."""


class Progress(NamedTuple):
    """Progress of a game.

    Attributes:
        time: Simulated time, in [s].
        distance: Smallest distance between opponents, in [m]; None without.
        real_time_factor: Simulated time over time passed.
    """

    time: float
    distance: float | None
    real_time_factor: float


@dataclass(frozen=True)
class GameRules:
    """What ends a game, at every level.

    Attributes:
        duration: Time limit, in [s].
        capture: Distance at which an evader is captured, in [m]; 0 if that
            ends no game.
        identities: Identities of the players, by name.
        goals: Positions (x, y) in the world, in [m], by name of the player.
    """

    duration: float = inf
    capture: float = 0.0
    identities: Mapping[str, PlayerIdentity] = field(default_factory=dict)
    goals: Mapping[str, tuple[float, ...]] = field(default_factory=dict)


class Ended(NamedTuple):
    """End of a game.

    Attributes:
        outcome: How it ended.
        message: The reason, as text.
        players: Names of the players and things that ended it.
    """

    outcome: Outcome
    message: str
    players: tuple[str, ...] = ()


class GameInPlay:
    """One game that is being played.

    Attributes:
        world: World of the game.
        rules: Its rules.
        observers: Its observers.
        ended: How it ended; None while it goes on.
        failure: Error of a player that ended it.
        goals_at: Time at which players reached their goals, in [s], by name.
    """

    def __init__(
        self,
        world: PlayedWorld,
        rules: GameRules,
        observers: Sequence[GameObserver] = (),
    ) -> None:
        """Judge the initial state."""
        self.world, self.rules = world, rules
        self.observers = tuple(observers)
        self.goals_at: dict[str, float] = {}
        self.failure: Exception | None = None
        ids = rules.identities
        self._pairs = [
            (evader, pursuer)
            for evader in ids
            for pursuer in ids
            if ids[evader].role == "evader"
            and ids[evader].opposes(ids[pursuer])
        ]
        self.ended = self._judge()

    @property
    def distance(self) -> float | None:
        """Smallest distance between opponents, in [m]; None without."""
        poses = self.world.states()
        return min(
            (
                hypot(poses[a].x - poses[b].x, poses[a].y - poses[b].y)
                for a, b in self._pairs
            ),
            default=None,
        )

    def decide(self) -> None:
        """Let the players decide; a failure ends the game."""
        for observer in self.observers:
            observer.before(self)
        try:
            self.world.decide()
        except (ReachError, StrategyError) as error:
            self.failure = error
            unreachable = isinstance(error, ReachError)
            self.ended = Ended(
                Outcome.UNREACHABLE if unreachable else Outcome.FAILED,
                f"{error} at {self.world.time:.2f} s",
            )

    def advance(self) -> None:
        """Move the players to the next instant, and judge."""
        for observer in self.observers:
            observer.acted(self)
        self.world.step(self.rules.duration)
        self.ended = self._judge()

    def _judge(self) -> Ended | None:
        """Apply the rules."""
        world, rules = self.world, self.rules
        now = world.time
        if names := tuple(world.fallen()):
            return _ended(Outcome.FALL, names, f"fell at {now:.2f} s")
        if names := tuple(world.touching()):
            alone = len(names) == 1
            return _ended(
                Outcome.TOUCHED if alone else Outcome.CONTACT,
                names,
                f"touched{' an obstacle' * alone} at {now:.2f} s",
            )
        if rules.capture:
            poses = world.states()
            for evader, pursuer in self._pairs:
                (x, y, _), (u, v, _) = poses[evader], poses[pursuer]
                if hypot(u - x, v - y) <= rules.capture:
                    return Ended(
                        Outcome.CAPTURED,
                        f"{pursuer} captured {evader} at {now:.2f} s",
                        (evader, pursuer),
                    )
        if rules.goals and self._all_arrived():
            return Ended(
                Outcome.COMPLETED, f"all goals reached at {now:.2f} s"
            )
        if now >= rules.duration - 1e-9:
            return Ended(Outcome.COMPLETED, f"played {now:.2f} s")
        return None

    def _all_arrived(self) -> bool:
        """Note arrivals; return whether all goals have been reached."""
        poses = self.world.states()
        for name, (u, v) in self.rules.goals.items():
            x, y, _ = poses[name]
            if name not in self.goals_at and hypot(u - x, v - y) < ARRIVAL:
                self.goals_at[name] = self.world.time
        return self.goals_at.keys() == self.rules.goals.keys()


def _ended(outcome: Outcome, names: tuple[str, ...], what: str) -> Ended:
    return Ended(outcome, f"{' and '.join(names)} {what}", names)


def play(
    games: Sequence[GameInPlay],
    report: Callable[[Progress], None] | None = None,
) -> float:
    """Play games side by side, each to its end.

    A KeyboardInterrupt ends those that still go on. At any end observers
    are told, and the worlds are closed.

    Args:
        games: The games.
        report: Called about five times a second with the progress of the
            first one.

    Returns:
        Computing time of each game, in [s].
    """
    began = reported = perf_counter()
    shared = {id(n): n for g in games if (n := g.world.networks) is not None}
    playing = [game for game in games if game.ended is None]
    try:
        with DeferredInterrupt() as interrupt:
            while playing:
                interrupt.let_through()
                for game in playing:
                    game.decide()
                for networks in shared.values():
                    networks.flush()
                for game in playing:
                    if game.ended is None:
                        game.advance()
                playing = [game for game in playing if game.ended is None]
                if report is not None:
                    now = perf_counter()
                    if now - reported > REPORT_PERIOD:
                        reported, first = now, games[0]
                        time = first.world.time
                        pace = time / (now - began)
                        report(Progress(time, first.distance, pace))
    except KeyboardInterrupt:
        for game in games:
            if game.ended is None:
                message = f"interrupted at {game.world.time:.2f} s"
                game.ended = Ended(Outcome.INTERRUPTED, message)
    finally:
        for game in games:
            game.world.close()
    for game in games:
        for observer in game.observers:
            observer.ended(game)
    return (perf_counter() - began) / max(1, len(games))
