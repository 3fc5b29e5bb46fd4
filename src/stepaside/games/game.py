"""Game without bodies: a world, rules, a judge, and the loop that plays it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from math import hypot, inf
from time import perf_counter
from typing import NamedTuple, Protocol

from ..core.player_identity import PlayerIdentity
from ..core.poses import Pose
from ..core.signal_handling import DeferredInterrupt
from .outcome import Outcome

ARRIVAL = 0.3  # distance from a goal at which it is reached, in [m]
REPORT_PERIOD = 0.2  # between two progress reports, in [s]


class PlayedWorld(Protocol):
    """World in which a game is played.

    Attributes:
        time: Time, in [s].
    """

    time: float

    def states(self) -> Mapping[str, Pose]:
        """Return the pose of each player in the world, by name."""

    def decide(self) -> None:
        """Let the players decide that are due.

        Raises:
            StrategyError: If a strategy fails.
        """

    def step(self, limit: float) -> None:
        """Move all players on, at most to a time, in [s]."""

    def touching(self) -> str:
        """Return the name of a player at an obstacle; empty for none."""


class GameObserver(Protocol):
    """Observer of a game, such as a recorder."""

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
    """What ends a game.

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
        players: Names of the players that ended it.
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

    def advance(self, until: float = inf) -> None:
        """Let the players decide and move to the next instant, and judge.

        Args:
            until: Time at which the next instant is at the latest, in [s].

        Raises:
            StrategyError: If a strategy fails.
        """
        self.world.decide()
        for observer in self.observers:
            observer.acted(self)
        self.world.step(min(until, self.rules.duration))
        self.ended = self._judge()

    def _judge(self) -> Ended | None:
        """Apply the rules."""
        world, rules = self.world, self.rules
        now = world.time
        if name := world.touching():
            message = f"{name} touched an obstacle at {now:.2f} s"
            return Ended(Outcome.TOUCHED, message, (name,))
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


def play(
    game: GameInPlay, report: Callable[[Progress], None] | None = None
) -> None:
    """Play a game to its end; a KeyboardInterrupt ends it, too.

    Args:
        game: The game.
        report: Called about five times a second with the progress.

    Raises:
        StrategyError: If a strategy fails.
    """
    began = reported = perf_counter()
    try:
        with DeferredInterrupt() as interrupt:
            while game.ended is None:
                interrupt.let_through()
                game.advance()
                now = perf_counter()
                if report is not None and now - reported > REPORT_PERIOD:
                    reported, time = now, game.world.time
                    report(Progress(time, game.distance, time / (now - began)))
    except KeyboardInterrupt:
        if game.ended is None:
            message = f"interrupted at {game.world.time:.2f} s"
            game.ended = Ended(Outcome.INTERRUPTED, message)
    for observer in game.observers:
        observer.ended(game)
