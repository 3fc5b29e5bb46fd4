"""A duel that runs in a thread of its own, whoever looks at it."""

import logging
import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter, sleep
from typing import TYPE_CHECKING

from ...control import Phase
from ...core.errors import StepAsideError
from ...core.poses import Array
from ...games.approach_forecast import CourseApproach
from ...games.duel import Duel
from ...games.duel_settings import DuelSettings
from ...games.outcome import Outcome
from ...games.player import Snapshot
from ...sim.push import Push
from .live_theory import expected_of
from .plot_history import PlotHistory
from .run_saving import LiveRecording, RunSaver
from .status_text import phases_of

if TYPE_CHECKING:
    from ...perception.frame_report import FrameReport

LOG = logging.getLogger(__name__)
MOST_ASKED = 10_000  # commands of a hand that are kept
BEHIND = 0.25  # delay after which lost time is given up, in [s]


@dataclass(frozen=True, slots=True)
class LiveFrame:
    """What the page shows of one moment.

    Attributes:
        time: Simulated time, in [s].
        positions: Of all bodies in the world, in [m]. Shape (bodies, 3).
        quaternions: (w, x, y, z). Shape (bodies, 4).
        players: State of each player.
        phases: What pursuer and evader do.
        distance: Between the two, in [m].
        closest: Least distance so far, in [m].
        angle: Between their headings when it was last noted, in [deg].
        approach: Of the pursuer to the evader; None before it is known.
        message: What the duel says of itself.
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
    between two ticks, and what the page shows it copies under a lock that is
    held for microseconds.

    Attributes:
        settings: Of the duel that runs, or is started next.
        duel: The duel.
        running: Whether time passes.
        speed: Simulated time per time that passes; inf for all it can.
        slow: Share of that speed that is kept for what is worth a look.
        outcome: How the duel ended, if it did.
        error: What went wrong in the loop, if anything did.
        trail: What the page draws of the time that has passed.
        lock: Held while the duel changes.
        asked: What a hand has asked of the robots.
        driven: Whether a hand drives the pursuer; no theory holds then.
        factor: Simulated time over time passed, lately; 0 while it is not
            known.
    """

    def __init__(self, settings: DuelSettings) -> None:
        """Prepare a duel and a loop in which no time passes yet.

        Raises:
            StepAsideError: If the settings ask for what cannot be.
        """
        self.lock = threading.RLock()
        self.running = False
        self.speed = 1.0
        self.slow = 1.0
        self.factor = 0.0
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
        """Let the loop do something, and wait: graphics know one thread."""
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
        # A live duel has no end: of what grows with it, a part is kept.
        trail = PlotHistory()
        duel = Duel(settings, (trail, LiveRecording()), recorded=False)
        self._let_go()
        self._open = duel
        self.settings = settings
        self.duel = duel
        self.outcome: Outcome | None = None
        self.trail = trail
        self.driven = False
        self.expect()
        self.asked: list[dict[str, float | str | bool]] = []
        self.generation += 1

    def expect(self) -> None:
        """Find the circle of theory for the settings of this moment."""
        self._expected = expected_of(self.settings)
        self.settling = self._expected.settling

    @property
    def theory(self) -> tuple[float, float] | None:
        """Distance [m] and angle [deg] of the circle, if there is one."""
        return None if self.driven else self._expected.theory

    @property
    def theory_radius(self) -> float | None:
        """Radius of the evader's circle, in [m], if there is one."""
        return None if self.driven else self._expected.radius

    def close(self) -> None:
        """Stop the loop and wait for it."""
        self._closing.set()
        if self._thread.is_alive():
            self._thread.join(timeout=5.0)

    def reset(self, settings: DuelSettings | None = None) -> None:
        """Begin again, with other settings if they are given.

        Raises:
            StepAsideError: If the settings ask for what cannot be; the duel
                that runs goes on then.
        """
        wanted = self.settings if settings is None else settings
        self._in_loop(lambda: self._begin(wanted))
        self.error = None

    def step(self, duration: float) -> None:
        """Let a paused duel go on for a while, in [s]."""
        ticks = max(1, round(duration / self.duel.world.physics.tick))
        self._requests.append(lambda: self._advance(ticks))

    def push(self, robot: int, impulse: float, direction: float) -> None:
        """Push a robot now.

        Args:
            robot: 0 for the pursuer, 1 for the evader.
            impulse: In [N s].
            direction: From its heading, in [rad].

        Raises:
            ConfigurationError: If the push makes no sense, or nobody is
                there who can be pushed.
        """
        duel = self.duel
        push = Push(impulse, duel.world.time, direction)
        self._in_loop(lambda: duel.players[robot].push(push))

    def change(self, request: Callable[[Duel], None]) -> None:
        """Change the duel between two ticks; acts at the next replan."""
        duel = self.duel
        self._requests.append(lambda: request(duel))

    def save(self, saving: RunSaver) -> Path:
        """Write what was played so far; time stands meanwhile.

        Args:
            saving: Writes it.

        Raises:
            StepAsideError: If it cannot be written.
        """
        with self.lock:
            return saving.save(self.duel, self.outcome, self.asked)

    def note(self, **asked: float | str | bool) -> None:
        """Note what a hand asks of a robot, with the time."""
        if len(self.asked) < MOST_ASKED:
            self.asked.append({"time_s": self.duel.world.time, **asked})

    def new_frames(self) -> "dict[str, FrameReport]":
        """Newest images of all cameras, once; see :class:`PlotHistory`."""
        with self.lock:
            frames = dict(self.trail.frames)
            self.trail.frames.clear()
        return frames

    def moment(self) -> LiveFrame:
        """Copy what the page shows."""
        with self.lock:  # the physics must not move what is worked out here
            duel, history = self.duel, self.trail.history
            data = duel.world.data
            return LiveFrame(
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
                self._serve()
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
                    self.factor = simulated / (now - measured)
                    measured, simulated = now, 0.0
                due += tick / (self.speed * self.slow)
                if due < now - BEHIND:
                    due = now
                elif due > now + 0.002:
                    sleep(due - now)
            except StepAsideError as error:
                self._fail(str(error))
            except Exception as error:
                LOG.exception("the duel stopped")
                self._fail(f"{type(error).__name__}: {error}")
        self._let_go()

    def _let_go(self) -> None:
        """Close the duel in the thread that drew for it."""
        if self._open is not None:
            self._open.close()
            self._open = None

    def _fail(self, message: str) -> None:
        LOG.error("%s", message)
        self.error, self.running = message, False

    def _serve(self) -> None:
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
