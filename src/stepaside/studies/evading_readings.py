"""What games in rooms say about the conclusion (Sec. V) and the sequel."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf

import numpy as np

from ..arena import RoomRecipe, make_room
from ..games.duel import run_duel
from ..games.duel_run import DuelRun
from ..games.duel_settings import PLAYERS, DuelSettings
from ..games.outcome import Outcome
from ..sim.camera_settings import SceneSettings
from ..strategies.step_game import StepGame, StepOutcome, StepTrack
from .claims import Readings
from .evading_claims import DURATION
from .physics_game import clearance, outcome_of, players_touched
from .tournament_campaign import bound_of, play_track
from .tournament_settings import TournamentSettings

EACH = 5  # games of each evader in each world, for one seed
GAME = StepGame(duration=120.0)
WORLDS = {
    "open": TournamentSettings(room=RoomRecipe(None, None), game=GAME),
    "room": TournamentSettings(room=RoomRecipe(discs=3), game=GAME),
}
EVADERS = ("aside", "deflected", "look-ahead")


@dataclass(frozen=True, slots=True)
class PlayedGames:
    """Games of one seed in steps, of each evader in each world.

    Attributes:
        games: By world and evader, all from the same starts.
    """

    games: dict[str, dict[str, tuple[StepTrack, ...]]]

    def survived(self, evader: str) -> float:
        """Share of the rooms that an evader survives."""
        outcomes = [g.outcome for g in self.games["room"][evader]]
        return outcomes.count(StepOutcome.SURVIVED) / len(outcomes)

    def closest(self, evader: str) -> float:
        """Mean closest approach to an evader on the open floor, in [m]."""
        games = self.games["open"][evader]
        return float(np.mean([g.distances.min() for g in games]))

    @property
    def bound(self) -> float:
        """Mean best least distance from the same starts, in [m]."""
        games = self.games["open"]["look-ahead"]
        return float(
            np.mean([bound_of(g.pursuer[0], g.evader[0], GAME) for g in games])
        )


def play(seed: int) -> PlayedGames:
    """Play what one seed stands for."""
    seeds = range(EACH * seed, EACH * (seed + 1))
    return PlayedGames(
        {
            name: {
                evader: tuple(
                    play_track(world, (evader, "pure"), each)[1]
                    for each in seeds
                )
                for evader in EVADERS
            }
            for name, world in WORLDS.items()
        }
    )


def read_evading(played: PlayedGames) -> Readings:
    """Better strategies, and what stands around, in steps."""
    ahead = played.games["room"]["look-ahead"]
    clear = min(float(g.clearances.min()) for g in ahead)
    decisions = [g.decision for g in ahead]
    return {
        "farther": played.closest("look-ahead") / played.closest("aside"),
        "best": played.closest("look-ahead") / played.bound,
        "survives": played.survived("look-ahead"),
        "clear": clear - GAME.body_radius,
        "aside": played.survived("look-ahead") - played.survived("aside"),
        "deflected": (
            played.survived("look-ahead") - played.survived("deflected")
        ),
        "decision": 1e3 * float(np.mean(decisions)),
    }


def room_settings(seed: int, duration: float = DURATION) -> DuelSettings:
    """Duel of two humanoids in a room that they know."""
    return DuelSettings(
        seed=seed,
        duration=duration,
        evader_strategy="look-ahead",
        room=SceneSettings(plan=make_room(RoomRecipe(discs=3), seed)),
    )


Clear = Callable[[DuelRun, str], float | None]


def read_room(run: DuelRun, clear: Clear = clearance) -> Readings:
    """What two humanoids touched in a room, and whether one was captured.

    Args:
        run: The duel.
        clear: How clear a player kept by the record, in [m].
    """
    kept: Sequence[float | None] = [clear(run, name) for name in PLAYERS]
    ended = outcome_of(run)
    clean = run.outcome is Outcome.COMPLETED or players_touched(run)
    return {
        "touched": float(not clean),
        "clear": min(inf if k is None else k for k in kept),
        "free": run.duration if ended == "survived" else 0.0,
    }


def measure_evading(seed: int) -> Readings:
    """Play and read."""
    return read_evading(play(seed))


def measure_room(seed: int) -> Readings:
    """Play and read."""
    return read_room(run_duel(room_settings(seed)))
