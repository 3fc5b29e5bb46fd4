"""Readings of games in rooms for the conclusion (Sec. V) and its sequel."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf

import numpy as np

from ..arena import RoomRecipe, generate_room
from ..games.duel import run_duel
from ..games.duel_settings import PLAYERS, DuelSettings
from ..games.floor_games import StrategyTrack
from ..games.outcome import Outcome
from ..games.run import DuelRun
from ..sim.camera_settings import SceneSettings
from ..strategies.strategy_game import StepGame
from .claims import Readings
from .evasion_claims import DURATION
from .tournament_physics import clearance, outcome_of, players_touched
from .tournament_record import bound_of, play_track
from .tournament_settings import TournamentSettings
from .tournament_strategies import ASIDE

GAMES_PER_SEED = 5  # of each evader in each setting
GAME = StepGame(duration=120.0)
TOURNAMENTS = {
    "open": TournamentSettings(room=RoomRecipe(None, None), game=GAME),
    "room": TournamentSettings(room=RoomRecipe(discs=3), game=GAME),
}
EVADERS = (ASIDE, "look-ahead")


@dataclass(frozen=True, slots=True)
class PlayedGames:
    """Games of one seed at the level of steps.

    Attributes:
        games: Games by tournament ("open", "room") and evader, all from the
            same initial poses.
    """

    games: dict[str, dict[str, tuple[StrategyTrack, ...]]]

    def survived(self, evader: str) -> float:
        """Return the fraction of games in rooms that an evader survives."""
        outcomes = [g.outcome for g in self.games["room"][evader]]
        return outcomes.count(Outcome.COMPLETED) / len(outcomes)

    def closest(self, evader: str) -> float:
        """Return the mean closest approach on the open floor, in [m]."""
        games = self.games["open"][evader]
        return float(np.mean([g.distances.min() for g in games]))

    @property
    def bound(self) -> float:
        """Mean upper bound of the closest approach, in [m]."""
        games = self.games["open"]["look-ahead"]
        return float(
            np.mean([bound_of(g.pursuer[0], g.evader[0], GAME) for g in games])
        )


def play(seed: int) -> PlayedGames:
    """Play the games of one seed."""
    seeds = range(GAMES_PER_SEED * seed, GAMES_PER_SEED * (seed + 1))
    return PlayedGames(
        {
            name: {
                evader: tuple(
                    play_track(tournament, (evader, "pursuit"), each)[1]
                    for each in seeds
                )
                for evader in EVADERS
            }
            for name, tournament in TOURNAMENTS.items()
        }
    )


def read_evading(played: PlayedGames) -> Readings:
    """Compare evaders on the open floor and among obstacles."""
    ahead = played.games["room"]["look-ahead"]
    clear = min(float(g.clearances.min()) for g in ahead)
    decisions = [g.decision for g in ahead]
    return {
        "farther": played.closest("look-ahead") / played.closest(ASIDE),
        "best": played.closest("look-ahead") / played.bound,
        "survives": played.survived("look-ahead"),
        "clear": clear - GAME.body_radius,
        "aside": played.survived("look-ahead") - played.survived(ASIDE),
        "decision": 1e3 * float(np.mean(decisions)),
    }


def room_settings(seed: int, duration: float = DURATION) -> DuelSettings:
    """Return the settings of a duel in a room with a given map."""
    return DuelSettings(
        seed=seed,
        duration=duration,
        evader_strategy="look-ahead",
        room=SceneSettings(plan=generate_room(RoomRecipe(discs=3), seed)),
    )


Clear = Callable[[DuelRun, str], float | None]


def read_room(run: DuelRun, clear: Clear = clearance) -> Readings:
    """Read contacts, clearance and free time of a duel in a room.

    Args:
        run: The duel.
        clear: Function from duel and player to the least clearance, in [m].
    """
    least: Sequence[float | None] = [clear(run, name) for name in PLAYERS]
    clean = run.outcome is Outcome.COMPLETED or players_touched(run)
    return {
        "touched": float(not clean),
        "clear": min(inf if k is None else k for k in least),
        "free": run.duration if outcome_of(run) is Outcome.COMPLETED else 0.0,
    }


def measure_evading(seed: int) -> Readings:
    """Play the games of a seed and return their readings."""
    return read_evading(play(seed))


def measure_room(seed: int) -> Readings:
    """Play a duel in the room of a seed and return its readings."""
    return read_room(run_duel(room_settings(seed)))
