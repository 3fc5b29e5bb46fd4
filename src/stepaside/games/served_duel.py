"""A duel in which control comes over sockets."""

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from typing import Any, NamedTuple

from ..core.errors import ConfigurationError
from ..drivers.lola.nao_joints import TICK
from .duel import Duel
from .duel_end import ended_duel
from .duel_run import DuelRun
from .duel_settings import DuelSettings
from .lockstep import Lockstep, RobotServer
from .match import Match, Progress, play
from .player import Player
from .recorder import Recorder
from .robot_offers import Offer
from .served_player import ServedPlayer
from .walker import Walker


class ServedDuel(NamedTuple):
    """A served duel that is over.

    Attributes:
        run: What was played, as any other duel.
        late_ticks: Ticks that began more than 6 ms late.
        lateness_ms: Ticks by how late they began.
        unanswered: Frames whose answer did not come in their tick.
    """

    run: DuelRun
    late_ticks: int
    lateness_ms: dict[str, int]
    unanswered: int

    def to_json(self) -> dict[str, Any]:
        """Plain values, those of a duel and the clock's."""
        return self.run.summary.to_json() | {
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
    """Let other processes play a duel in our world.

    Who is not offered is played here, by its own control.

    Args:
        settings: What decides the duel; its clock must be LoLA's.
        offers: How robots are offered, by name of the player.
        lock_step: Whether the world waits for answers instead of for the
            clock.
        patience: How long to wait for clients, in [s].
        report: Called about five times a second with the progress.

    Raises:
        StepAsideError: If the settings ask for what cannot be, a robot
            cannot be offered, or a client does not come.
    """
    duel = Duel(settings, recorded=False)
    if duel.world.physics.tick != TICK:
        raise ConfigurationError(
            f"a served world needs a tick of {TICK:g} [s], "
            f"got {duel.world.physics.tick:g}; choose --body delayed or "
            "hardware"
        )
    with ExitStack() as stack:
        players: list[Player] = []
        servers: list[RobotServer] = []
        for player in duel.players:
            if player.name in offers and isinstance(player, Walker):
                offer = offers[player.name]
                player, server = offer.serve(player, lock_step=lock_step)
                stack.callback(server.close)
                servers.append(server)
            players.append(player)
        exchange = Lockstep(servers, lock_step=lock_step)
        recorder = Recorder(players, tick=TICK)
        exchange.gather(patience)
        for player in players:
            if isinstance(player, ServedPlayer):
                player.body.let_go()
        match = Match(duel.world, players, (exchange, recorder))
        outcome, wall = play(match, settings.duration, report)
    return ServedDuel(
        ended_duel(duel.settings, match, outcome, recorder, None, wall),
        exchange.late,
        exchange.histogram(),
        exchange.unanswered,
    )
