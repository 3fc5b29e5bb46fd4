"""Games whose settings can be swept, and the record of each."""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, NamedTuple

from ..arena import RoomRecipe
from ..core.errors import ConfigurationError
from ..games.duel_settings import DuelSettings
from ..games.outcome import Outcome
from ..games.walk_game import run_walk
from ..games.walk_settings import WalkSettings
from ..strategies.strategy_game import StepGame
from ..theory.unicycle.adaptive_simulation import simulate
from ..theory.unicycle.relative_coordinates import RelativeStart
from ..theory.unicycle.unicycle_game import MOVE_ASIDE, make_game
from .duel_record import play_record as play_duel
from .tabulation import Record, flat
from .tournament_record import play_record as play_pairing
from .tournament_settings import TournamentSettings


@dataclass(frozen=True)
class PairingSettings:
    """Settings of one game of a tournament.

    Attributes:
        evader: Name of the evader.
        pursuer: Name of the pursuer.
        seed: Seed of the room and of the initial poses.
        level: Level of simulation; see :class:`TournamentSettings`.
        room: Recipe of the random room.
        game: Rules of the game.
        map: Map of the humanoids.
    """

    evader: str = "look-ahead"
    pursuer: str = "pursuit"
    seed: int = 0
    level: str = "steps"
    room: RoomRecipe = field(default_factory=RoomRecipe)
    game: StepGame = field(default_factory=StepGame)
    map: str = "given"


@dataclass(frozen=True)
class UnicycleSettings:
    """Settings of one game of two unicycles.

    Attributes:
        pursuer_speed: Speed of the pursuer, in [m/s].
        evader_speed: Speed of the evader, in [m/s].
        pursuer_gain: Gain of the pursuer, in [1/s].
        evader_gain: Gain of the evader, in [1/s].
        angle: Evasion angle, in [rad].
        law: Turning law of the evader.
        side_rule: Rule by which the evader chooses its side.
        distance: Initial distance, in [m].
        aim: Initial bearing of the evader in the pursuer's frame, in [rad].
        bearing: Initial bearing of the pursuer in the evader's frame, in
            [rad].
        duration: Duration of the game, in [s].
    """

    pursuer_speed: float = 0.1
    evader_speed: float = 0.1
    pursuer_gain: float = 0.2
    evader_gain: float = 0.2
    angle: float = MOVE_ASIDE
    law: str = "proportional"
    side_rule: str = "behind"
    distance: float = 1.0
    aim: float = 0.0
    bearing: float = 0.0
    duration: float = 60.0


class SweepGame(NamedTuple):
    """Game whose settings can be swept.

    Attributes:
        settings: Class of its settings.
        play: Plays a game; returns its record.
        value: Value of a record that is tabulated by default.
    """

    settings: type[Any]
    play: Callable[[Any], Record]
    value: str


def _play_walk(settings: WalkSettings) -> Record:
    run = run_walk(settings)
    if run.outcome is Outcome.INTERRUPTED:
        raise KeyboardInterrupt
    return {
        "outcome": run.outcome.value,
        "message": run.message,
        "duration_s": run.duration,
        **flat(asdict(run.summary)),
    }


def _play_pairing(settings: PairingSettings) -> Record:
    tournament = TournamentSettings(
        settings.level,
        settings.room,
        settings.game,
        settings.map,
    )
    pairing = settings.evader, settings.pursuer
    return play_pairing(tournament, pairing, settings.seed)


def _play_unicycles(settings: UnicycleSettings) -> Record:
    try:
        game = make_game(
            settings.pursuer_speed,
            settings.evader_speed,
            settings.pursuer_gain,
            settings.evader_gain,
            settings.angle,
            settings.law,
            side_rule=settings.side_rule,
        )
    except ValueError as error:
        raise ConfigurationError(f"a game of unicycles: {error}") from error
    start = RelativeStart(settings.distance, settings.aim, settings.bearing)
    played = simulate(game, start, settings.duration)
    (end,) = played.states([played.end_time])
    return {
        "outcome": "captured" if played.captured else "completed",
        "duration_s": played.end_time,
        "closest_m": played.closest_distance,
        "closest_at_s": played.closest_time,
        "distance_m": float(end[0]),
    }


GAMES: Mapping[str, SweepGame] = {
    "duel": SweepGame(DuelSettings, play_duel, "min_distance_m"),
    "walk": SweepGame(WalkSettings, _play_walk, "speed_ratio"),
    "tournament": SweepGame(PairingSettings, _play_pairing, "closest_m"),
    "unicycles": SweepGame(UnicycleSettings, _play_unicycles, "closest_m"),
}
"""Games by the entry ``game`` of a study file."""
