"""Duel whose robots other processes control over sockets."""

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from typing import Any, NamedTuple

from ..core.errors import ConfigurationError
from ..drivers.lola.nao_joints import TICK
from .client_synchroniser import ClientSynchroniser, RobotServer
from .duel import Duel, make_duel_run
from .duel_settings import DuelSettings
from .match import Match, Progress, play
from .player import Player
from .recorder import Recorder
from .robot_endpoints import Offer
from .run import DuelRun
from .run_archive import results_of
from .served_player import ServedPlayer
from .walker import SimulatedPlayer


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
    offers: Mapping[str, Offer],
    *,
    lock_step: bool = False,
    patience: float = 60.0,
    report: Callable[[Progress], None] | None = None,
) -> ServedDuel:
    """Play a duel whose robots are controlled by other processes.

    Robots without an offer are controlled by this process.

    Args:
        settings: Settings of the duel; its control period must be that of
            LoLA.
        offers: Protocol and address of each served robot, by player.
        lock_step: Whether the simulation waits for commands instead of for
            the clock.
        patience: Longest time to wait for clients, in [s].
        report: Called about five times a second with the progress.

    Raises:
        StepAsideError: If the settings cannot be met, a robot cannot be
            served, or a client does not connect.
    """
    duel = Duel(settings, recorded=False)
    if duel.world.physics.tick != TICK:
        raise ConfigurationError(
            f"a served duel needs a tick of {TICK:g} [s], "
            f"got {duel.world.physics.tick:g}; choose --body delayed or "
            "hardware"
        )
    with ExitStack() as stack:
        players: list[Player] = []
        servers: list[RobotServer] = []
        for player in duel.players:
            if player.name in offers and isinstance(player, SimulatedPlayer):
                offer = offers[player.name]
                player, server = offer.serve(player, lock_step=lock_step)
                stack.callback(server.close)
                servers.append(server)
            players.append(player)
        exchange = ClientSynchroniser(servers, lock_step=lock_step)
        recorder = Recorder(players, tick=TICK)
        exchange.gather(patience)
        for player in players:
            if isinstance(player, ServedPlayer):
                player.body.let_go()
        match = Match(duel.world, players, (exchange, recorder))
        outcome, wall = play(match, settings.duration, report)
    return ServedDuel(
        make_duel_run(duel.settings, match, outcome, recorder, None, wall),
        exchange.late,
        exchange.histogram(),
        exchange.unanswered,
    )
