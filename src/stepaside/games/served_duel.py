"""Duel whose robots other processes command over ROS 2 topics."""

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any, NamedTuple

from ..core.errors import ConfigurationError
from .client_synchroniser import ClientSynchroniser
from .game import Progress, play
from .game_settings import GameSettings
from .recorded_game import RecordedGame
from .robot_player import VelocityWalker
from .run import Run
from .run_archive import results_of

if TYPE_CHECKING:
    from ..drivers.ros2_dds import DdsParticipant


class ServedDuel(NamedTuple):
    """Finished served duel."""

    run: Run
    late_ticks: int  # that began more than 6 ms late
    unanswered: int  # frames that were not answered in their tick

    def to_json(self) -> dict[str, Any]:
        """Return the summary of the duel and the timing, as plain values."""
        return results_of(self.run) | {
            "late_ticks": self.late_ticks,
            "unanswered_frames": self.unanswered,
        }


def serve_duel(
    settings: GameSettings,
    dds: "DdsParticipant",
    namespaces: Mapping[str, str],
    *,
    ideal_sight: bool = True,
    lock_step: bool = False,
    patience: float = 60.0,
    report: Callable[[Progress], None] | None = None,
) -> ServedDuel:
    """Play a duel whose robots other processes command by velocities.

    Robots without a namespace are controlled by this process.

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

    for name in namespaces:
        if name not in settings.robots:
            raise ConfigurationError(
                f"a served player must be a robot, got {name}"
            )
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
    return ServedDuel(game.run(), exchange.late, exchange.unanswered)
