"""Clock of a served simulation: sensor frames and commands at each tick."""

from collections.abc import Sequence
from time import monotonic, sleep
from typing import Protocol

from ..core.errors import ConfigurationError
from .game import GameInPlay, GameObserver

LATE = 0.006  # delay from which a tick counts as late, in [s]
ANSWER_SHARE = 0.75  # of a tick, for commands; the rest is physics
STALL = 0.1  # delay that is not caught up with, in [s]
ANSWER_TIMEOUT = 5.0  # for a command in lock step, in [s]
POLL_PERIOD = 0.0005  # between two looks for commands, in [s]


class RobotServer(Protocol):
    """Server of one robot that is controlled by another process."""

    @property
    def connected(self) -> bool:
        """Whether a client is connected."""

    def begin(self) -> None:
        """Align the measurements with the first tick of the game."""

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
        tick: float,
        *,
        lock_step: bool = False,
    ) -> None:
        """Synchronise a match with servers.

        In lock step it waits for every answer instead of for the clock.
        """
        self._servers, self._tick = servers, tick
        self._lock_step = lock_step
        self._due = monotonic()
        self.late = 0
        self.unanswered = 0

    def gather(self, longest: float) -> None:
        """Wait up to a time in [s] until every robot has a client.

        The simulation does not advance meanwhile.

        Raises:
            ConfigurationError: If a client does not connect in time.
        """
        until = monotonic() + longest
        while idle := sum(not s.connected for s in self._servers):
            if monotonic() > until:
                raise ConfigurationError(
                    f"{idle} of {len(self._servers)} robots had no client "
                    f"within {longest:g} s"
                )
            self._exchange()
        for server in self._servers:
            server.begin()
        self.late = 0
        self.unanswered = 0

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
            sleep(min(left, POLL_PERIOD))
        self.unanswered += len(missing)
        if self._lock_step:
            for server in missing:
                server.drop(f"no answer for {ANSWER_TIMEOUT:g} s in lock step")

    def _any_connected(self) -> bool:
        return any(server.connected for server in self._servers)
