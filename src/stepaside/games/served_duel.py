"""Duel whose robots other processes command over ROS 2 topics."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from time import monotonic, sleep
from typing import TYPE_CHECKING

from ..core.errors import ConfigurationError
from .game import GameInPlay, GameObserver, Progress, play
from .game_settings import GameSettings
from .recorded_game import RecordedGame
from .run import Run
from .velocity_walker import VelocityWalker

if TYPE_CHECKING:
    from ..drivers.ros2_dds import DdsParticipant
    from ..drivers.ros2_server import Ros2Server

LATE = 0.006  # delay from which a tick counts as late, in [s]
ANSWER_SHARE = 0.75  # of a tick, for commands; the rest is physics
STALL = 0.1  # delay that is not caught up with, in [s]
ANSWER_TIMEOUT = 5.0  # for a command in lock step, in [s]
POLL_PERIOD = 0.0005  # between two looks for commands, in [s]


class ClientSynchroniser(GameObserver):
    """Observer that synchronises a game with its clients.

    Attributes:
        late: Ticks that began more than 6 ms late.
        unanswered: Frames that were not answered in their tick.
    """

    def __init__(
        self,
        servers: "Sequence[Ros2Server]",
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
        self.late = self.unanswered = 0

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
                connected = any(server.connected for server in self._servers)
                if self._lock_step and not connected:
                    sleep(self._tick)  # no client: do not spin
                return
            if left <= 0.0:
                break
            sleep(min(left, POLL_PERIOD))
        self.unanswered += len(missing)
        if self._lock_step:
            for server in missing:
                server.drop(f"no answer for {ANSWER_TIMEOUT:g} s in lock step")


def serve_duel(
    settings: GameSettings,
    dds: "DdsParticipant",
    namespaces: Mapping[str, str],
    *,
    ideal_sight: bool = True,
    lock_step: bool = False,
    patience: float = 60.0,
    report: Callable[[Progress], None] | None = None,
) -> tuple[Run, dict[str, int]]:
    """Play a duel whose robots other processes command by velocities.

    Robots without a namespace are controlled by this process. Returned with
    the run are the numbers of late ticks and of unanswered frames.

    Args:
        settings: Settings of the duel.
        dds: DDS participant; the caller closes it.
        namespaces: Namespace of each served robot, by player, with a leading
            slash, or empty.
        ideal_sight: Whether the true line of sight is published.
        lock_step: Whether the simulation waits for commands instead of for
            the clock.
        patience: Longest time to wait for clients, in [s].
        report: Called about five times a second with the progress.
    """
    from ..drivers.ros2_server import Ros2Server, WorldClock
    from ..robots.urdf_writer import urdf_of

    game = RecordedGame(
        settings, remote=dict.fromkeys(namespaces, ideal_sight)
    )
    world, clock, servers = game.in_physics, WorldClock(dds), []
    tick = world.physics.tick
    with ExitStack() as stack:
        for name, namespace in namespaces.items():
            player = world.player(name)
            assert isinstance(player, VelocityWalker)
            server = Ros2Server(
                dds,
                namespace,
                player,
                player.robot.joint_names,
                clock,
                tick=tick,
                lock_step=lock_step,
                urdf=urdf_of(player.description),
            )
            servers.append(server)
            stack.callback(server.close)
        exchange = ClientSynchroniser(servers, tick, lock_step=lock_step)
        game.observers += (exchange,)
        exchange.gather(patience)
        play(game, report=report)
    late, missing = exchange.late, exchange.unanswered
    return game.run(), {"late_ticks": late, "unanswered_frames": missing}
