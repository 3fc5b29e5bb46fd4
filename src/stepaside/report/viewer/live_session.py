"""Live duel in its own thread, paced by the wall clock."""

import logging
import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from math import degrees
from pathlib import Path
from time import perf_counter, sleep
from typing import TYPE_CHECKING, NamedTuple

from ...core.errors import StepAsideError
from ...core.poses import Array
from ...games.approach_forecast import CourseApproach
from ...games.duel import Duel
from ...games.duel_circle import circle_of_theory
from ...games.duel_settings import DuelSettings
from ...games.outcome import Outcome
from ...games.player import Snapshot
from ...locomotion.walk_snapshots import Phase
from ...sim.push import Push
from ..settling_report import settling_time
from .plot_history import PlotHistory
from .run_saving import LiveRecording, RunSaver
from .status_text import phases_of

if TYPE_CHECKING:
    from ...perception.percept_stages import FrameReport

LOG = logging.getLogger(__name__)
MAX_COMMANDS = 10_000  # of teleoperation that are recorded
MAX_DELAY = 0.25  # beyond which lost time is not caught up, in [s]


class LiveTheory(NamedTuple):
    """Predictions of the theory for a duel; each None if it has none.

    Attributes:
        circle: Distance [m] and angle between headings [deg] on the circle.
        radius: Radius of the evader's circle, in [m].
        settling: Time constant of the approach to the circle, in [s].
    """

    circle: tuple[float, float] | None
    radius: float | None
    settling: float | None


def predict(settings: DuelSettings) -> LiveTheory:
    """Return the predictions of the theory for some settings.

    Args:
        settings: Settings of the duel.
    """
    circle, settling = circle_of_theory(settings), settling_time(settings)
    if not circle.exists:
        return LiveTheory(None, None, settling)
    values = circle.distance_m, degrees(circle.headings_apart_rad)
    return LiveTheory(values, circle.radius_evader_m, settling)


@dataclass(frozen=True, slots=True)
class LiveSnapshot:
    """State of a duel at one instant, as the page shows it.

    Attributes:
        time: Simulated time, in [s].
        positions: Of all bodies in the world, in [m]. Shape (bodies, 3).
        quaternions: (w, x, y, z) of all bodies. Shape (bodies, 4).
        players: Snapshot of each player.
        phases: Phases of pursuer and evader.
        distance: Between the two, in [m].
        closest: Closest approach so far, in [m].
        angle: Between their headings at the last sample, in [deg].
        approach: Of the pursuer to the evader; None before it is known.
        message: Message of the duel.
    """

    time: float
    positions: Array
    quaternions: Array
    players: tuple[Snapshot, ...]
    phases: tuple[Phase, Phase]
    distance: float
    closest: float
    angle: float
    approach: CourseApproach | None
    message: str


class LiveSession:
    """Runs a duel against the wall clock.

    The page never blocks it: requests go into a queue that the loop empties
    between two ticks, and snapshots are copied under a lock that is held for
    microseconds.

    Attributes:
        settings: Settings of the duel, which a reset uses again.
        duel: The duel.
        running: Whether simulated time passes.
        speed: Simulated time per wall-clock time; inf for no limit.
        slow_motion: Factor of that speed, 1 except near a closest approach.
        outcome: Outcome of the duel; None while it is played.
        error: Message of an error in the loop; None if there was none.
        trail: Recent history of the duel.
        lock: Held while the duel changes.
        commands: Recorded commands of teleoperation.
        driven: Whether the pursuer is teleoperated; theory does not apply
            then.
        real_time_factor: Measured simulated time per wall-clock time; 0
            before the first measurement.
    """

    def __init__(self, settings: DuelSettings) -> None:
        """Start the loop with a duel that is paused.

        Raises:
            StepAsideError: If the settings are invalid.
        """
        self.lock = threading.RLock()
        self.running = False
        self.speed = 1.0
        self.slow_motion = 1.0
        self.real_time_factor = 0.0
        self.error: str | None = None
        self._requests: deque[Callable[[], None]] = deque()
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._loop, daemon=True)
        self.generation = 0
        self._open: Duel | None = None
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

    def _begin(self, settings: DuelSettings) -> None:
        # A live duel has no end, so that its history is bounded.
        trail = PlotHistory()
        duel = Duel(
            settings,
            (trail, LiveRecording()),
            recorded=False,
            rendered=True,
        )
        self._close_duel()
        self._open = duel
        self.duel = duel
        self.outcome: Outcome | None = None
        self.trail = trail
        self.driven = False
        self.adopt_settings(settings)
        self.commands: list[dict[str, float | str | bool]] = []
        self.generation += 1

    def adopt_settings(self, settings: DuelSettings) -> None:
        """Take settings that changed during the duel, with their theory."""
        self.settings = settings
        self._predicted = predict(settings)
        self.settling = self._predicted.settling

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

    def reset(self, settings: DuelSettings | None = None) -> None:
        """Start a new duel.

        Args:
            settings: Its settings; None for those of the last duel.

        Raises:
            StepAsideError: If the settings are invalid; the current duel
                continues then.
        """
        new_settings = self.settings if settings is None else settings
        self._in_loop(lambda: self._begin(new_settings))
        self.error = None

    def step(self, duration: float) -> None:
        """Advance a paused duel.

        Args:
            duration: Simulated time, in [s].
        """
        ticks = max(1, round(duration / self.duel.world.physics.tick))
        self._requests.append(lambda: self._advance(ticks))

    def push(self, robot: int, impulse: float, direction: float) -> None:
        """Push a robot now.

        Args:
            robot: 0 for the pursuer, 1 for the evader.
            impulse: In [N s].
            direction: Relative to its heading, in [rad].

        Raises:
            ConfigurationError: If the push is invalid or the player is not a
                robot.
        """
        duel = self.duel
        push = Push(impulse, duel.world.time, direction)
        self._in_loop(lambda: duel.players[robot].push(push))

    def change(self, request: Callable[[Duel], None]) -> None:
        """Request a change of the duel between two ticks.

        Args:
            request: Called with the duel in the loop's thread.
        """
        duel = self.duel
        self._requests.append(lambda: request(duel))

    def save(self, saving: RunSaver) -> Path:
        """Write the duel so far, which pauses meanwhile.

        Args:
            saving: Writer of run folders.

        Returns:
            The run folder.

        Raises:
            StepAsideError: If it cannot be written.
        """
        with self.lock:
            return saving.save(self.duel, self.outcome, self.commands)

    def record_command(self, **command: float | str | bool) -> None:
        """Record a command of teleoperation with the simulated time.

        Args:
            command: Its values.
        """
        if len(self.commands) < MAX_COMMANDS:
            time = self.duel.world.time
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
            duel, history = self.duel, self.trail.history
            data = duel.world.data
            return LiveSnapshot(
                duel.world.time,
                data.xpos.copy(),
                data.xquat.copy(),
                tuple(player.snapshot() for player in duel.players),
                phases_of(duel),
                duel.distance or 0.0,
                duel.min_distance or 0.0,
                history[-1][2] if history else 0.0,
                self.trail.approach(self.settings.cycle),
                duel.message,
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
                tick = self.duel.world.physics.tick
                self._advance(1)
                simulated += tick
                now = perf_counter()
                if now - measured > 0.5:
                    self.real_time_factor = simulated / (now - measured)
                    measured, simulated = now, 0.0
                due += tick / (self.speed * self.slow_motion)
                if due < now - MAX_DELAY:
                    due = now
                elif due > now + 0.002:
                    sleep(due - now)
            except StepAsideError as error:
                self._fail(str(error))
            except Exception as error:
                LOG.exception("the duel stopped")
                self._fail(f"{type(error).__name__}: {error}")
        self._close_duel()

    def _close_duel(self) -> None:
        """Close the duel in the thread that owns its graphics."""
        if self._open is not None:
            self._open.close()
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
                self._tick()

    def _tick(self) -> None:
        self.outcome = self.duel.tick()
