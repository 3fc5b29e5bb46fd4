"""Duel whose robots other processes control over sockets."""

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any, NamedTuple

from ..core.errors import ConfigurationError
from .client_synchroniser import TICK, ClientSynchroniser, RobotServer
from .duel_settings import DuelSettings
from .game import Progress, play
from .physics_world import RemoteControl
from .recorded_game import RecordedGame
from .robot_player import ServedPlayer, VelocityWalker
from .run import Run
from .run_archive import results_of

if TYPE_CHECKING:
    from ..drivers.ros2_dds import DdsParticipant
    from ..drivers.ros2_server import WorldClock


class RobotEndpoint(NamedTuple):
    """Protocol and address at which a robot is served."""

    control: RemoteControl  # of the robot by its client
    serve: Callable[[Any, bool], RobotServer]  # a player, maybe in lock step


def lola_endpoint(path: str, *, ideal_sight: bool = True) -> RobotEndpoint:
    """Return the socket at which the joints of a robot are served over LoLA.

    The client has to balance the robot.
    """

    def serve(player: ServedPlayer, lock_step: bool) -> RobotServer:
        from ..drivers.lola_server import LolaServer

        return LolaServer(
            path,
            player,
            player.robot.joint_names,
            lock_step=lock_step,
            ideal_sight=ideal_sight,
        )

    return RobotEndpoint(RemoteControl(False, ideal_sight), serve)


def ros2_endpoint(
    dds: "DdsParticipant",
    clock: "WorldClock",
    namespace: str,
    *,
    ideal_sight: bool = True,
) -> RobotEndpoint:
    """Return the topics of a robot that walks at commanded velocities.

    The namespace has a leading slash, or is empty.
    """

    def serve(player: VelocityWalker, lock_step: bool) -> RobotServer:
        from ..drivers.ros2_server import Ros2Server
        from ..robots.urdf_writer import urdf_of

        return Ros2Server(
            dds,
            namespace,
            player,
            player.robot.joint_names,
            clock,
            tick=player.robot.tick,
            lock_step=lock_step,
            urdf=urdf_of(player.description),
        )

    return RobotEndpoint(RemoteControl(True, ideal_sight), serve)


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
    settings: DuelSettings,
    endpoints: Mapping[str, RobotEndpoint],
    *,
    lock_step: bool = False,
    patience: float = 60.0,
    report: Callable[[Progress], None] | None = None,
) -> ServedDuel:
    """Play a duel whose robots are controlled by other processes.

    Robots without an endpoint are controlled by this process.

    Args:
        settings: Settings of the duel; a robot that is served over LoLA
            needs its control period.
        endpoints: Protocol and address of each served robot, by player.
        lock_step: Whether the simulation waits for commands instead of for
            the clock.
        patience: Longest time to wait for clients, in [s].
        report: Called about five times a second with the progress.
    """
    remote = {name: each.control for name, each in endpoints.items()}
    for name, control in remote.items():
        if name not in settings.robots:
            raise ConfigurationError(
                f"a served player must be a robot, got {name}"
            )
        if settings.robot_of(name).legs.walks and not control.balances:
            raise ConfigurationError(
                "a player that is served over LoLA must be a robot that "
                f"walks by maneuvers, got {name}"
            )
    game = RecordedGame(settings, remote=remote)
    world, servers = game.in_physics, list[RobotServer]()
    tick = world.physics.tick
    if tick != TICK and not all(own.balances for own in remote.values()):
        raise ConfigurationError(
            f"a duel over LoLA needs a tick of {TICK:g} [s], got {tick:g}; "
            "choose --body delayed or hardware"
        )
    with ExitStack() as stack:
        for name, endpoint in endpoints.items():
            servers.append(endpoint.serve(world.player(name), lock_step))
            stack.callback(servers[-1].close)
        exchange = ClientSynchroniser(servers, tick, lock_step=lock_step)
        game.observers += (exchange,)
        exchange.gather(patience)
        for player in world.players:
            if isinstance(player, ServedPlayer):
                player.begin()
        play(game, report=report)
    return ServedDuel(game.run(), exchange.late, exchange.unanswered)
