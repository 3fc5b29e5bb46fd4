"""Live game in its own thread, paced by the wall clock."""

import logging
import threading
from collections import deque
from collections.abc import Callable
from math import degrees
from pathlib import Path
from time import perf_counter, sleep

from ...core.errors import ConfigurationError, StepAsideError
from ...core.player_identity import Role
from ...games.forecast import circle_of_theory
from ...games.game import Outcome
from ...games.game_settings import GameSettings
from ...games.game_starts import with_starts
from ...games.physics_world import PhysicsWorld
from ...games.players import RobotPlayer
from ...games.recorded_game import RecordedGame
from ...sim.push import Push
from ..palette import colours_in
from ..run_folder import free_folder, write_run
from .live_history import LiveHistory

LOG = logging.getLogger(__name__)
MAX_DELAY = 0.25  # beyond which lost time is not caught up, in [s]


class LiveSession:
    """Runs a game against the wall clock.

    The page never blocks it: requests go into a queue that the loop empties
    between two ticks, and the page copies the state under a lock that is
    held for microseconds.

    Attributes:
        settings: Settings of the game, which a reset uses again.
        played: The same with nothing left open.
        game: The game that is played; it has no end by time.
        running: Whether simulated time passes.
        speed: Simulated time per wall-clock time; inf for no limit.
        error: Message of an error in the loop.
        history: Recent history of the game.
        colours: Colour of each player, by name.
        lock: Held while the game changes.
        driven: Name of the player that is driven by hand, or empty; theory
            does not apply then.
        generation: Number of games that have begun.
        real_time_factor: Measured simulated time per wall-clock time; 0
            before the first measurement.
    """

    def __init__(self, settings: GameSettings) -> None:
        """Start the loop with a game that is paused."""
        self.lock = threading.RLock()
        self.running = False
        self.speed = 1.0
        self.real_time_factor = 0.0
        self.error: str | None = None
        self.generation = 0
        self._requests: deque[Callable[[], None]] = deque()
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._loop, daemon=True)
        self._open: RecordedGame | None = None
        self._thread.start()
        try:
            self.call(lambda: self._begin(settings))
        except BaseException:
            self._closing.set()
            raise

    def call(self, request: Callable[[], None]) -> None:
        """Call a function between two ticks, and wait for it.

        It runs in the loop's thread, which owns the graphics.

        Raises:
            Exception: What the function raises.
        """
        done = threading.Event()
        failed: list[Exception] = []

        def run() -> None:
            try:
                request()
            except Exception as error:
                failed.append(error)
            finally:
                done.set()

        self._requests.append(run)
        done.wait()
        if failed:
            raise failed[0]

    def _begin(self, settings: GameSettings) -> None:
        if settings.level != "physics":
            raise ConfigurationError(
                "level must be physics for a live page, got "
                f"{settings.level!r}"
            )
        history = LiveHistory()
        game = RecordedGame(
            settings, [history], recorded=False, rendered=True, endless=True
        )
        self._close_game()
        self._open = self.game = game
        self.history = history
        self.driven = ""
        self.adopt_settings(settings)
        self.generation += 1

    def adopt_settings(self, settings: GameSettings) -> None:
        """Take settings that changed during the game, with their theory."""
        self.settings = settings
        self.played = with_starts(settings)
        self.colours = colours_in("light", self.names, self.played.identities)
        self._circle = None
        if settings.game == "duel":
            self._circle = circle_of_theory(settings)

    @property
    def world(self) -> PhysicsWorld:
        """World of the game."""
        return self.game.in_physics

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the players, in the order in which they act."""
        return tuple(player.name for player in self.world.players)

    @property
    def opponents(self) -> tuple[tuple[str, str], ...]:
        """Names of all pairs of a pursuer and an evader."""
        identities = self.played.identities.items()
        return tuple(
            (one, other)
            for one, own in identities
            for other, theirs in identities
            if own.role is Role.PURSUER and own.opposes(theirs)
        )

    @property
    def theory(self) -> tuple[float, float, float] | None:
        """Radius [m], distance [m] and angle [deg] of the circle of theory.

        None without one, and while a player is driven by hand.
        """
        circle = self._circle
        if self.driven or circle is None or not circle.exists:
            return None
        angle = degrees(circle.headings_apart_rad)
        return circle.radius_evader_m, circle.distance_m, angle

    def close(self) -> None:
        """Stop the loop and wait for it."""
        self._closing.set()
        if self._thread.is_alive():
            self._thread.join(timeout=5.0)

    def reset(self, settings: GameSettings | None = None) -> None:
        """Start a new game, with the settings of the last one if None.

        Raises:
            StepAsideError: If the settings are invalid; the current game
                continues then.
        """
        new_settings = self.settings if settings is None else settings
        self.call(lambda: self._begin(new_settings))
        self.error = None

    def step(self, duration: float) -> None:
        """Advance a paused game by a simulated time, in [s]."""
        ticks = max(1, round(duration / self.world.physics.tick))
        self._requests.append(lambda: self._advance(ticks))

    def push(self, player: str, impulse: float, direction: float) -> None:
        """Push a robot now by an impulse, in [N s].

        The direction is relative to its heading, in [rad].

        Raises:
            ConfigurationError: If the push is invalid or the player is not a
                robot.
        """
        push = Push(impulse, self.world.time, direction)
        robot = self.world.player(player)
        if not isinstance(robot, RobotPlayer):
            raise ConfigurationError(
                f"only a robot can be pushed, got {player}"
            )
        self.call(lambda: robot.robot.push(push))

    def save(self, parent: Path) -> Path:
        """Write the game so far into a new run folder, and return that.

        Raises:
            ConfigurationError: If nothing has been recorded yet.
            OutputError: If it cannot be written.
        """
        with self.lock:
            if len(self.game.recorder.times) < 3:
                raise ConfigurationError(
                    "nothing has been recorded yet: start the game first"
                )
            run = self.game.run()
            name = f"live-seed{run.settings.seed}"
            return write_run(free_folder(parent, name), run).parent

    @property
    def outcome(self) -> Outcome | None:
        """Outcome of the game; None while it is played."""
        return self.game.outcome

    def _loop(self) -> None:
        due = perf_counter()
        measured, simulated = due, 0.0
        while not self._closing.is_set():
            try:
                while self._requests:
                    with self.lock:
                        self._requests.popleft()()
                if not self.running or self.outcome is not None:
                    sleep(0.01)
                    due = measured = perf_counter()
                    simulated = 0.0
                    continue
                tick = self.world.physics.tick
                self._advance(1)
                simulated += tick
                now = perf_counter()
                if now - measured > 0.5:
                    self.real_time_factor = simulated / (now - measured)
                    measured, simulated = now, 0.0
                due += tick / self.speed
                if due < now - MAX_DELAY:
                    due = now
                elif due > now + 0.002:
                    sleep(due - now)
            except StepAsideError as error:
                self._fail(str(error))
            except Exception as error:
                LOG.exception("the game stopped")
                self._fail(f"{type(error).__name__}: {error}")
        self._close_game()

    def _close_game(self) -> None:
        """Close the game in the thread that owns its graphics."""
        if self._open is not None:
            self._open.world.close()
            self._open = None

    def _fail(self, message: str) -> None:
        LOG.error("%s", message)
        self.error, self.running = message, False

    def _advance(self, ticks: int) -> None:
        for _ in range(ticks):
            if self.outcome is not None:
                return
            with self.lock:
                self.game.tick()
