"""The clock of a served world: frames out and answers in, every 12 ms."""

import select
from collections.abc import Callable, Sequence
from time import monotonic, sleep
from typing import Protocol

import numpy as np

from ..core.errors import ConfigurationError
from ..drivers.lola.nao_joints import TICK
from .match import Match
from .outcome import Outcome

LATE = 0.006  # from which a tick is late, in [s]
ANSWERING = 0.009  # time for answers in a tick, in [s]; the rest is physics
STALLED = 0.1  # lag that is not caught up with, in [s]
PATIENCE = 5.0  # for an answer in lock step, in [s]
STEADY = 10  # ticks for which clients must hold their robots stiff
PRESSED = 5  # ticks for which the chest buttons are pressed
POLL = 0.0005  # between looks at who has no descriptor to wait on, in [s]


class RobotServer(Protocol):
    """What speaks for one robot that is played elsewhere."""

    @property
    def connected(self) -> bool:
        """Whether somebody is there to play it."""

    @property
    def ready(self) -> bool:
        """Whether the game may begin for it."""

    def fileno(self) -> int:
        """Descriptor to wait on for answers; -1 without one."""

    def press(self, pressed: bool) -> None:
        """Press the chest button, or let it go."""

    def speak(self) -> None:
        """Say what the robot's sensors give."""

    def hear(self) -> bool:
        """Take answers that have come; whether nobody is waited for."""

    def act(self) -> object:
        """Let the robot do what was asked."""

    def drop(self, why: str) -> None:
        """Let go of who is there, and say why."""

    def close(self) -> None:
        """Stop speaking."""


class Lockstep:
    """Lets a match and its clients keep time with each other.

    Attributes:
        late: Ticks that began more than 6 ms late.
        lateness: How late each tick began, in [s].
        unanswered: Frames whose answer did not come in their tick.
    """

    def __init__(
        self,
        servers: Sequence[RobotServer],
        *,
        lock_step: bool = False,
        clock: Callable[[], float] = monotonic,
        pause: Callable[[float], None] = sleep,
    ) -> None:
        """Keep time for servers.

        Args:
            servers: What speaks for each robot that is played elsewhere.
            lock_step: Wait for every answer instead of for the clock.
            clock: Time of this computer, in [s].
            pause: Lets time pass, in [s].
        """
        self._servers, self._lock_step = servers, lock_step
        self._clock, self._pause = clock, pause
        self._due = clock()
        self.lateness: list[float] = []
        self.unanswered = 0

    @property
    def late(self) -> int:
        """Ticks that began more than 6 ms late."""
        return sum(late > LATE for late in self.lateness)

    def histogram(self) -> dict[str, int]:
        """Ticks by how late they began, in [ms]."""
        edges = np.array([0.0, 0.25, 0.5, 1.0, 2.0, 4.0, 6.0, 12.0, np.inf])
        counts, _ = np.histogram(1e3 * np.array(self.lateness), edges)
        names = [f"< {edge:g}" for edge in edges[1:-1]] + [">= 12"]
        return dict(zip(names, counts.tolist(), strict=True))

    def gather(self, longest: float) -> None:
        """Wait until every robot is ready, then press the buttons.

        The world stands still meanwhile. Walking begins with the frame
        that says that the button was let go: the first of the match.

        Args:
            longest: Time to wait, in [s].

        Raises:
            ConfigurationError: If a client does not come or get ready.
        """
        until = self._clock() + longest
        steady = 0
        while steady < STEADY:
            if self._clock() > until:
                idle = sum(not s.ready for s in self._servers)
                raise ConfigurationError(
                    f"{idle} of {len(self._servers)} robots had no client "
                    f"that was ready within {longest:g} s"
                )
            self._round()
            ready = all(server.ready for server in self._servers)
            steady = steady + 1 if ready else 0
        for server in self._servers:
            server.press(True)
        for _ in range(PRESSED):
            self._round()
        for server in self._servers:
            server.press(False)
        self.lateness.clear()
        self.unanswered = 0

    def before(self, match: Match) -> None:
        """Speak and listen before the players move."""
        self._speak_and_hear()

    def acted(self, match: Match) -> None:
        """Nothing to do."""

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Nothing to do."""

    def _round(self) -> None:
        """One tick of a world that stands still."""
        self._speak_and_hear()
        for server in self._servers:
            server.act()

    def _speak_and_hear(self) -> None:
        now = self._clock()
        if not self._lock_step:
            if now < self._due:
                self._pause(self._due - now)
                now = self._clock()
            late = max(0.0, now - self._due)
            self.lateness.append(late)
            # Frames after a stall must not outrun the clients' clocks.
            begun = now if late > STALLED else self._due
            self._due = begun + TICK
            deadline = begun + ANSWERING
        else:
            deadline = now + PATIENCE
        for server in self._servers:
            server.speak()
        self._hear(deadline)

    def _hear(self, deadline: float) -> None:
        """Take answers until all are there or time is up."""
        while True:
            missing = [s for s in self._servers if not s.hear()]
            left = deadline - self._clock()
            if not missing:
                if self._lock_step and not self._any_connected():
                    self._pause(TICK)  # nobody to wait for: do not spin
                return
            if left <= 0.0:
                break
            waited = [s for s in missing if s.fileno() >= 0]
            if len(waited) < len(missing):
                left = min(left, POLL)
            select.select(waited, [], [], left)
        self.unanswered += len(missing)
        if self._lock_step:
            for server in missing:
                server.drop(f"no answer for {PATIENCE:g} s in lock step")

    def _any_connected(self) -> bool:
        return any(server.connected for server in self._servers)
