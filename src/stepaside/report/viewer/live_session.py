"""Live game in its own thread, paced by the wall clock."""

import logging
import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from math import nan
from pathlib import Path
from time import perf_counter, sleep
from typing import TYPE_CHECKING

from ...core.errors import StepAsideError
from ...core.player_identity import Role
from ...core.poses import Array
from ...games.duel_settings import DuelSettings
from ...games.game import GameObserver
from ...games.outcome import Outcome
from ...games.player import Snapshot
from ...games.recorded_game import RecordedGame
from ...locomotion.walk_snapshots import Phase
from ...sim.push import Push
from ...strategies.approach import Approach
from ..figure_style import colours_of
from .live_match import (
    LiveSettings,
    identities_of,
    open_match,
    predict,
)
from .plot_history import PlotHistory
from .run_saving import LiveRecording, RunSaver
from .status_text import phases_of

if TYPE_CHECKING:
    from ...perception.pipeline import FrameReport

LOG = logging.getLogger(__name__)
MAX_COMMANDS = 10_000  # of teleoperation that are recorded
MAX_DELAY = 0.25  # beyond which lost time is not caught up, in [s]


@dataclass(frozen=True, slots=True)
class LiveSnapshot:
    """State of a game at one instant, as the page shows it.

    Attributes:
        time: Simulated time, in [s].
        positions: Of all bodies in the world, in [m]. Shape (bodies, 3).
        quaternions: (w, x, y, z) of all bodies. Shape (bodies, 4).
        players: Snapshot of each player.
        phases: Phase of each player.
        distance: Of the players, as the rules define it, in [m]; NaN if
            they do not.
        closest: Closest approach so far, in [m].
        angle: Between the headings of a duel at the last sample, in [deg].
        approach: Of the pursuer of a duel to the evader; None before it is
            known.
        message: Message of the game.
    """

    time: float
    positions: Array
    quaternions: Array
    players: tuple[Snapshot, ...]
    phases: tuple[Phase, ...]
    distance: float
    closest: float
    angle: float
    approach: Approach | None
    message: str


class LiveSession:
    """Runs a game against the wall clock.

    The page never blocks it: requests go into a queue that the loop empties
    between two ticks, and snapshots are copied under a lock that is held for
    microseconds.

    Attributes:
        settings: Settings of the game, which a reset uses again.
        match: The game that is played.
        running: Whether simulated time passes.
        speed: Simulated time per wall-clock time; inf for no limit.
        error: Message of an error in the loop; None if there was none.
        trail: Recent history of the game.
        colours: Colour of each player, by name.
        lock: Held while the game changes.
        commands: Recorded commands of teleoperation.
        driven: Name of the player that is teleoperated, or empty; theory
            does not apply then.
        real_time_factor: Measured simulated time per wall-clock time; 0
            before the first measurement.
    """

    def __init__(self, settings: LiveSettings) -> None:
        """Start the loop with a game that is paused.

        Args:
            settings: Settings of the game.

        Raises:
            StepAsideError: If the settings are invalid.
        """
        self.lock = threading.RLock()
        self.running = False
        self.speed = 1.0
        self.real_time_factor = 0.0
        self.error: str | None = None
        self._requests: deque[Callable[[], None]] = deque()
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._loop, daemon=True)
        self.generation = 0
        self._open: RecordedGame | None = None
        self._thread.start()
        try:
            self._in_loop(lambda: self._begin(settings))
        except BaseException:
            self._closing.set()
            raise

    def _in_loop(self, call: Callable[[], None]) -> None:
        """Call a function in the loop's thread, which owns the graphics."""
        done = threading.Event()
        failed: list[Exception] = []

        def run() -> None:
            try:
                call()
            except Exception as error:
                failed.append(error)
            finally:
                done.set()

        self._requests.append(run)
        done.wait()
        if failed:
            raise failed[0]

    def _begin(self, settings: LiveSettings) -> None:
        # A live game has no end, so that its history is bounded.
        trail = PlotHistory()
        recorders: tuple[GameObserver, ...] = trail, LiveRecording()
        match = open_match(settings, recorders)
        self._close_match()
        self._open = match
        self.match = match
        self.trail = trail
        self.driven = ""
        self.adopt_settings(settings)
        self.commands: list[dict[str, float | str | bool]] = []
        self.generation += 1

    @property
    def outcome(self) -> Outcome | None:
        """Outcome of the game; None while it is played."""
        return self.match.outcome

    @property
    def opponents(self) -> tuple[tuple[str, str], ...]:
        """Names of all pairs of a pursuer and an evader."""
        identities = identities_of(self.settings).items()
        return tuple(
            (one, other)
            for one, own in identities
            for other, theirs in identities
            if own.role is Role.PURSUER and own.opposes(theirs)
        )

    def adopt_settings(self, settings: LiveSettings) -> None:
        """Take settings that changed during the game, with their theory."""
        self.settings = settings
        self.colours = colours_of(self.names, identities_of(settings))
        self._predicted = predict(settings)
        self.settling = self._predicted.settling

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the players, in the order in which they act."""
        return tuple(player.name for player in self.match.in_physics.players)

    @property
    def theory(self) -> tuple[float, float] | None:
        """Distance [m] and angle [deg] of the circle; None without one."""
        return None if self.driven else self._predicted.circle

    @property
    def theory_radius(self) -> float | None:
        """Radius of the evader's circle, in [m]; None without a circle."""
        return None if self.driven else self._predicted.radius

    def close(self) -> None:
        """Stop the loop and wait for it."""
        self._closing.set()
        if self._thread.is_alive():
            self._thread.join(timeout=5.0)

    def reset(self, settings: LiveSettings | None = None) -> None:
        """Start a new game.

        Args:
            settings: Its settings; None for those of the last game.

        Raises:
            StepAsideError: If the settings are invalid; the current game
                continues then.
        """
        new_settings = self.settings if settings is None else settings
        self._in_loop(lambda: self._begin(new_settings))
        self.error = None

    def step(self, duration: float) -> None:
        """Advance a paused game.

        Args:
            duration: Simulated time, in [s].
        """
        ticks = max(1, round(duration / self.match.in_physics.physics.tick))
        self._requests.append(lambda: self._advance(ticks))

    def push(self, player: str, impulse: float, direction: float) -> None:
        """Push a robot now.

        Args:
            player: Name of the player.
            impulse: In [N s].
            direction: Relative to its heading, in [rad].

        Raises:
            ConfigurationError: If the push is invalid or the player is not a
                robot.
        """
        match = self.match
        push = Push(impulse, match.world.time, direction)
        self._in_loop(lambda: match.in_physics.player(player).push(push))

    def change(self, request: Callable[[RecordedGame], None]) -> None:
        """Request a change of the game between two ticks.

        Args:
            request: Called with the game in the loop's thread.
        """
        match = self.match
        self._requests.append(lambda: request(match))

    def save(self, saving: RunSaver) -> Path:
        """Write the game so far, which pauses meanwhile.

        Args:
            saving: Writer of run folders.

        Returns:
            The run folder.

        Raises:
            StepAsideError: If it cannot be written.
        """
        with self.lock:
            return saving.save(self.match, self.commands)

    def record_command(self, **command: float | str | bool) -> None:
        """Record a command of teleoperation with the simulated time.

        Args:
            command: Its values.
        """
        if len(self.commands) < MAX_COMMANDS:
            time = self.match.world.time
            self.commands.append({"time_s": time, **command})

    def new_frames(self) -> "dict[str, FrameReport]":
        """Return images that arrived since the last call, by camera."""
        with self.lock:
            frames = dict(self.trail.frames)
            self.trail.frames.clear()
        return frames

    def snapshot(self) -> LiveSnapshot:
        """Return a copy of the present state."""
        with self.lock:  # no tick may change the state meanwhile
            match, history = self.match, self.trail.history
            world, distance = match.in_physics, match.distance
            is_duel = isinstance(self.settings, DuelSettings)
            return LiveSnapshot(
                world.time,
                world.data.xpos.copy(),
                world.data.xquat.copy(),
                tuple(player.snapshot() for player in world.players),
                phases_of(world.players),
                nan if distance is None else distance,
                min(match.closest.values(), default=self.trail.closest),
                history[-1][2] if history else 0.0 if is_duel else nan,
                self.trail.approach(self.settings.cycle),
                match.message,
            )

    def _loop(self) -> None:
        due = perf_counter()
        measured, simulated = due, 0.0
        while not self._closing.is_set():
            try:
                self._run_requests()
                if not self.running or self.outcome is not None:
                    sleep(0.01)
                    due = measured = perf_counter()
                    simulated = 0.0
                    continue
                tick = self.match.in_physics.physics.tick
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
        self._close_match()

    def _close_match(self) -> None:
        """Close the game in the thread that owns its graphics."""
        if self._open is not None:
            self._open.world.close()
            self._open = None

    def _fail(self, message: str) -> None:
        LOG.error("%s", message)
        self.error, self.running = message, False

    def _run_requests(self) -> None:
        while self._requests:
            with self.lock:
                self._requests.popleft()()

    def _advance(self, ticks: int) -> None:
        for _ in range(ticks):
            if self.outcome is not None:
                return
            with self.lock:
                self.match.tick()
