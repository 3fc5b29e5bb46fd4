"""Clock of a served simulation: sensor frames and commands at each tick."""

import select
from collections.abc import Sequence
from time import monotonic, sleep
from typing import Protocol

from ..core.errors import ConfigurationError
from .game import GameInPlay, GameObserver

TICK = 0.012  # of LoLA, in [s]
LATE = 0.006  # delay from which a tick counts as late, in [s]
ANSWER_SHARE = 0.75  # of a tick, for commands; the rest is physics
STALL = 0.1  # delay that is not caught up with, in [s]
ANSWER_TIMEOUT = 5.0  # for a command in lock step, in [s]
READY_TICKS = 10  # for which clients must hold their robots stiff
PRESSED_TICKS = 5  # for which the chest buttons are pressed
POLL_PERIOD = 0.0005  # for servers without a descriptor, in [s]


class RobotServer(Protocol):
    """Server of one robot that is controlled by another process."""

    @property
    def connected(self) -> bool:
        """Whether a client is connected."""

    @property
    def ready(self) -> bool:
        """Whether the client is ready for the game to begin."""

    def fileno(self) -> int:
        """Return the descriptor to wait on for commands; -1 without one."""

    def press(self, pressed: bool) -> None:
        """Press or release the chest button."""

    def speak(self) -> None:
        """Send the measurement of this tick."""

    def hear(self) -> bool:
        """Receive pending commands; return whether none is awaited."""

    def act(self) -> None:
        """Apply the last command to the robot."""

    def drop(self, why: str) -> None:
        """Disconnect the client, with a reason."""

    def close(self) -> None:
        """Stop serving."""


class ClientSynchroniser(GameObserver):
    """Observer that synchronises a game with its clients.

    Attributes:
        late: Ticks that began more than 6 ms late.
        unanswered: Frames that were not answered in their tick.
    """

    def __init__(
        self,
        servers: Sequence[RobotServer],
        tick: float = TICK,
        *,
        lock_step: bool = False,
    ) -> None:
        """Wait for the clock at each tick, or in lock step for answers."""
        self._servers, self._tick = servers, tick
        self._lock_step = lock_step
        self._due = monotonic()
        self.late = self.unanswered = 0

    def gather(self, longest: float) -> None:
        """Wait until every client is ready, then press the chest buttons.

        The simulation does not advance meanwhile. Walking begins with the
        frame that reports the released button, which is the first of the
        game.

        Raises:
            ConfigurationError: If a client is not ready in time, in [s].
        """
        until = monotonic() + longest
        ready_ticks = 0
        while ready_ticks < READY_TICKS:
            if monotonic() > until:
                idle = sum(not s.ready for s in self._servers)
                raise ConfigurationError(
                    f"{idle} of {len(self._servers)} robots had no client "
                    f"that was ready within {longest:g} s"
                )
            self._exchange()
            ready = all(server.ready for server in self._servers)
            ready_ticks = ready_ticks + 1 if ready else 0
        for server in self._servers:
            server.press(True)
        for _ in range(PRESSED_TICKS):
            self._exchange()
        for server in self._servers:
            server.press(False)
        self.late = self.unanswered = 0

    def before(self, game: GameInPlay) -> None:
        """Exchange measurements and commands before the players act."""
        self._exchange()

    def _exchange(self) -> None:
        """Exchange measurements and commands of one tick."""
        now = monotonic()
        if not self._lock_step:
            if now < self._due:
                sleep(self._due - now)
                now = monotonic()
            late = max(0.0, now - self._due)
            self.late += late > LATE
            # Frames after a stall must not outrun the clients' clocks.
            begun = now if late > STALL else self._due
            self._due = begun + self._tick
            deadline = begun + ANSWER_SHARE * self._tick
        else:
            deadline = now + ANSWER_TIMEOUT
        for server in self._servers:
            server.speak()
        self._receive(deadline)
        for server in self._servers:
            server.act()

    def _receive(self, deadline: float) -> None:
        """Receive commands until all have arrived or time is up."""
        while True:
            missing = [s for s in self._servers if not s.hear()]
            left = deadline - monotonic()
            if not missing:
                if self._lock_step and not self._any_connected():
                    sleep(self._tick)  # no client: do not spin
                return
            if left <= 0.0:
                break
            selectable = [s for s in missing if s.fileno() >= 0]
            if len(selectable) < len(missing):
                left = min(left, POLL_PERIOD)
            select.select(selectable, [], [], left)
        self.unanswered += len(missing)
        if self._lock_step:
            for server in missing:
                server.drop(f"no answer for {ANSWER_TIMEOUT:g} s in lock step")

    def _any_connected(self) -> bool:
        return any(server.connected for server in self._servers)
