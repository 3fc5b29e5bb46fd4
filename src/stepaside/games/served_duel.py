"""Duel whose robots other processes control over sockets."""

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from typing import Any, NamedTuple

from ..core.errors import ConfigurationError
from .client_synchroniser import TICK, ClientSynchroniser, RobotServer
from .duel_settings import DuelSettings
from .game import Progress, play
from .recorded_game import RecordedGame
from .robot_endpoints import RobotEndpoint
from .run import DuelRun
from .run_archive import results_of
from .served_player import ServedPlayer


class ServedDuel(NamedTuple):
    """Finished served duel.

    Attributes:
        run: The recorded duel.
        late_ticks: Ticks that began more than 6 ms late.
        lateness_ms: Number of ticks by delay, in [ms].
        unanswered: Frames that were not answered in their tick.
    """

    run: DuelRun
    late_ticks: int
    lateness_ms: dict[str, int]
    unanswered: int

    def to_json(self) -> dict[str, Any]:
        """Return the summary of the duel and the timing, as plain values."""
        return results_of(self.run) | {
            "late_ticks": self.late_ticks,
            "lateness_ms": self.lateness_ms,
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
    balances = {name: e.control.balances for name, e in endpoints.items()}
    for name in endpoints:
        if name not in settings.robots:
            raise ConfigurationError(
                f"a served player must be a robot, got {name}"
            )
        if settings.robot_of(name).legs.walks and not balances[name]:
            raise ConfigurationError(
                "a player that is served over LoLA must be a robot that "
                f"walks by maneuvers, got {name}"
            )
    remote = {name: each.control for name, each in endpoints.items()}
    game = RecordedGame(settings, remote=remote)
    world, servers = game.in_physics, list[RobotServer]()
    tick = world.physics.tick
    if tick != TICK and not all(balances.values()):
        raise ConfigurationError(
            f"a duel over LoLA needs a tick of {TICK:g} [s], got {tick:g}; "
            "choose --body delayed or hardware"
        )
    with ExitStack() as stack:
        for name, endpoint in endpoints.items():
            player = world.player(name)
            servers.append(endpoint.serve(player, lock_step=lock_step))
            stack.callback(servers[-1].close)
        exchange = ClientSynchroniser(servers, tick, lock_step=lock_step)
        game.observers += (exchange,)
        exchange.gather(patience)
        for player in world.players:
            if isinstance(player, ServedPlayer):
                player.begin()
        play(game, report=report)
    return ServedDuel(
        game.run(), exchange.late, exchange.histogram(), exchange.unanswered
    )
