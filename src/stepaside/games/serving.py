"""A duel in which control comes over sockets."""

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from typing import Any, NamedTuple

from ..drivers.lola.address import Address
from ..drivers.lola.frame_clock import TICK
from ..drivers.lola.server import LolaServer
from ..errors import ConfigurationError
from .duel import Duel
from .exchange import Exchange
from .figures import DuelSummary
from .match import Match, Progress, play
from .outcome import Outcome
from .player import Player
from .record import Recorder
from .served import ServedBody, ServedPlayer
from .settings import DuelSettings
from .summary import summarise
from .walker import Walker


class Served(NamedTuple):
    """A served duel that is over.

    Attributes:
        summary: Its figures, those of a duel.
        outcome: How it ended.
        late_ticks: Ticks that began more than 6 ms late.
        lateness_ms: Ticks by how late they began.
        unanswered: Frames whose answer did not come in their tick.
    """

    summary: DuelSummary
    outcome: Outcome
    late_ticks: int
    lateness_ms: dict[str, int]
    unanswered: int

    def to_json(self) -> dict[str, Any]:
        """Plain values, those of a duel and the clock's."""
        return self.summary.to_json() | {
            "late_ticks": self.late_ticks,
            "lateness_ms": self.lateness_ms,
            "unanswered_frames": self.unanswered,
        }


def serve_duel(
    settings: DuelSettings,
    addresses: Mapping[str, Address],
    *,
    lock_step: bool = False,
    ideal_sight: bool = True,
    patience: float = 60.0,
    report: Callable[[Progress], None] | None = None,
) -> Served:
    """Let other processes play a duel in our world.

    Who has no address is played here, by its own control.

    Args:
        settings: What decides the duel; its clock must be LoLA's.
        addresses: Where each robot listens, by name of the player.
        lock_step: Whether the world waits for answers instead of for the
            clock.
        ideal_sight: Whether the true line of sight is offered beside.
        patience: How long to wait for clients, in [s].
        report: Called about five times a second with the progress.

    Raises:
        StepAsideError: If the settings ask for what cannot be, an address
            cannot be listened on, or a client does not come.
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
        served: list[ServedPlayer] = []
        for player in duel.players:
            if player.name in addresses and isinstance(player, Walker):
                body = ServedBody(player.robot)
                server = LolaServer(
                    addresses[player.name],
                    body,
                    player.scheme.kinematics.joint_names,
                    lock_step=lock_step,
                    ideal_sight=ideal_sight,
                )
                stack.callback(server.close)
                served.append(ServedPlayer(player.robot, body, server))
                players.append(served[-1])
            else:
                players.append(player)
        exchange = Exchange(
            [player.server for player in served], lock_step=lock_step
        )
        recorder = Recorder(players, tick=TICK)
        exchange.gather(patience)
        for player in served:
            player.body.let_go()
        match = Match(duel.world, players, (exchange, recorder))
        outcome, wall = play(match, settings.duration, report)
    summary = summarise(
        duel.settings,
        match,
        outcome,
        recorder.times,
        recorder.tracks(),
        recorder.planning(),
        {},
        wall,
    )
    return Served(
        summary,
        outcome,
        exchange.late,
        exchange.histogram(),
        exchange.unanswered,
    )
