"""Game: a world, rules, a judge, and the loop that plays it."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from itertools import combinations
from math import hypot, inf
from time import perf_counter
from typing import NamedTuple, Protocol

from ..core.constants import CAPTURE_DISTANCE
from ..core.errors import ReachError, StrategyError
from ..core.player_identity import PlayerIdentity
from ..core.poses import Pose
from ..core.signal_handling import DeferredInterrupt
from ..strategies.knowledge import Knowledge

ARRIVAL = 0.3  # distance from a goal at which it is reached, in [m]
REPORT_PERIOD = 0.2  # between two progress reports, in [s]


class Outcome(StrEnum):
    """Outcome of a game or a play.

    Bodies are in contact in physics; a body on the floor touches an obstacle.
    """

    COMPLETED = "completed"
    CAPTURED = "captured"
    TOUCHED = "touched"
    FALL = "fall"
    CONTACT = "contact"
    UNREACHABLE = "unreachable"
    FAILED = "failed"
    INTERRUPTED = "interrupted"


class PlayedWorld(Protocol):
    """World in which a game is played: in physics, or on a floor."""

    contact: Outcome  # of a game that ends because players touch something

    @property
    def time(self) -> float:
        """Time, in [s]."""

    @property
    def acting(self) -> str:
        """Name of the player that decides, or decided last."""

    def states(self) -> Mapping[str, Pose]:
        """Return the pose of each player in the world, by name."""

    def is_moving(self, name: str) -> bool:
        """Return whether a player walks."""

    def due(
        self, names: Collection[str], *, ended: bool
    ) -> dict[str, Knowledge]:
        """Return what players know for decisions that are due, by name."""

    def apart(self, one: str, other: str) -> float:
        """Return the distance of two bodies by the rules, in [m]."""

    def decide(self) -> None:
        """Let the players decide that are due.

        A strategy that fails raises a StrategyError, legs that cannot reach
        their references a ReachError.
        """

    def step(self, limit: float) -> None:
        """Move all players on, at most to a time, in [s]."""

    def fallen(self) -> tuple[str, ...]:
        """Return the names of the players that have fallen."""

    def touching(self) -> tuple[str, ...]:
        """Return the names of players whose contact ends the game."""

    def close(self) -> None:
        """Release what the players hold."""


class GameObserver:
    """Observer of a game, such as a recorder or a live page."""

    def before(self, game: "GameInPlay") -> None:
        """Observe the world before the players decide."""

    def acted(self, game: "GameInPlay") -> None:
        """Observe the world after they have decided, before they move."""

    def ended(self, game: "GameInPlay") -> None:
        """Observe the end."""


class Progress(NamedTuple):
    """Progress of a game."""

    time: float  # simulated [s]
    distance: float | None  # see `GameInPlay.distance`
    real_time_factor: float  # simulated time over time passed


@dataclass(frozen=True)
class GameRules:
    """What ends a game."""

    duration: float = inf  # [s]
    capture: float = 0.0  # distance [m]; 0 if capture ends no game
    identities: Mapping[str, PlayerIdentity] = field(default_factory=dict)
    # Places (x, y) in the world [m] that all players with one must reach.
    goals: Mapping[str, tuple[float, ...]] = field(default_factory=dict)


class Ended(NamedTuple):
    """End of a game."""

    outcome: Outcome
    message: str  # the reason
    players: tuple[str, ...] = ()  # and things that ended it


class GameInPlay:
    """One game that is being played.

    Attributes:
        ended: How it ended; None while it goes on.
        closest: Least distance so far of each evader and pursuer, in [m].
        captured_at: Time at which that first was at most the capture
            distance, in [s]; it ends a game only by its rules.
        goals_at: Time at which players reached their goals, in [s], by name.
        wall_time: Time that the computation took, in [s].
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
        self.closest = dict.fromkeys(self._pairs, inf)
        self.captured_at: dict[tuple[str, str], float] = {}
        self.wall_time = 0.0
        self.ended = self._judge()

    @property
    def outcome(self) -> Outcome | None:
        """How it ended; None while it goes on."""
        return None if self.ended is None else self.ended.outcome

    @property
    def message(self) -> str:
        """Reason for the end, as text; empty while it goes on."""
        return "" if self.ended is None else self.ended.message

    @property
    def real_time_factor(self) -> float:
        """Simulated time over computing time; 1 while it goes on."""
        time = self.world.time
        return time / self.wall_time if self.wall_time > 0.0 else 1.0

    @property
    def touched(self) -> tuple[str, ...]:
        """Names of what was in contact, if that ended the game."""
        by_contact = self.outcome in (Outcome.CONTACT, Outcome.TOUCHED)
        return self.ended.players if self.ended and by_contact else ()

    @property
    def fallen(self) -> tuple[str, ...]:
        """Names of the players that fell, if that ended the game."""
        fell = self.outcome is Outcome.FALL
        return self.ended.players if self.ended and fell else ()

    @property
    def distance(self) -> float | None:
        """Smallest distance between opponents, in [m].

        Without opponents that of all players; None with one player.
        """
        poses = self.world.states()
        pairs = self._pairs or combinations(poses, 2)
        return min(
            (
                hypot(poses[a].x - poses[b].x, poses[a].y - poses[b].y)
                for a, b in pairs
            ),
            default=None,
        )

    def tick(self, limit: float = inf) -> Outcome | None:
        """Let the players decide and move on, and judge; return the outcome.

        They move no farther than to a limit, in [s]. If one fails, that ends
        the game before they move.
        """
        for observer in self.observers:
            observer.before(self)
        try:
            self.world.decide()
        except (ReachError, StrategyError) as error:
            failed, now = isinstance(error, StrategyError), self.world.time
            what = "'s strategy failed" if failed else " lost its footing"
            who = self.world.acting
            self.ended = Ended(
                Outcome.FAILED if failed else Outcome.UNREACHABLE,
                f"{who}{what} at {now:.2f} s: {error}",
                (who,),
            )
            return self.outcome
        for observer in self.observers:
            observer.acted(self)
        self.world.step(min(limit, self.rules.duration))
        self.ended = self._judge()
        return self.outcome

    def _judge(self) -> Ended | None:
        """Apply the rules, and note approaches."""
        world, rules = self.world, self.rules
        now, caught = world.time, None
        for pair in self._pairs:
            apart = world.apart(*pair)
            if apart < self.closest[pair]:
                self.closest[pair] = apart
            if apart <= CAPTURE_DISTANCE:
                self.captured_at.setdefault(pair, now)
            if caught is None and apart <= rules.capture:
                caught = pair
        if names := world.fallen():
            message = f"{' and '.join(names)} fell at {now:.2f} s"
            return Ended(Outcome.FALL, message, names)
        if names := world.touching():
            message = f"{' and '.join(names)} touched at {now:.2f} s"
            return Ended(world.contact, message, names)
        if rules.capture and caught is not None:
            evader, pursuer = caught
            message = f"{pursuer} captured {evader} by {now:.2f} s"
            return Ended(Outcome.CAPTURED, message, caught)
        if rules.goals and self._all_arrived():
            message = f"all goals reached at {now:.2f} s"
            return Ended(Outcome.COMPLETED, message)
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
    """Play a game to its end.

    At any end, including a KeyboardInterrupt, the observers keep the record
    of what was played, and the world is closed. Progress is reported about
    five times a second.
    """
    began = reported = perf_counter()
    try:
        with DeferredInterrupt() as interrupt:
            while game.ended is None:
                interrupt.let_through()
                game.tick()
                now, time = perf_counter(), game.world.time
                if report and now - reported > REPORT_PERIOD:
                    reported, factor = now, time / (now - began)
                    report(Progress(time, game.distance, factor))
    except KeyboardInterrupt:
        if game.ended is None:
            message = f"interrupted at {game.world.time:.2f} s"
            game.ended = Ended(Outcome.INTERRUPTED, message)
    finally:
        game.world.close()
    game.wall_time = perf_counter() - began
    for observer in game.observers:
        observer.ended(game)
