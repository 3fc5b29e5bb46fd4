"""Readings of games in rooms for the conclusion (Sec. V) and its sequel."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from math import inf

import numpy as np

from ..arena import RoomRecipe, generate_room
from ..games.duel_settings import PLAYERS, DuelSettings
from ..games.floor_games import StrategyTrack
from ..games.outcome import Outcome
from ..games.recorded_game import run_duel
from ..games.run import Run
from ..sim.camera_settings import SceneSettings
from ..strategies.strategy_game import StepGame
from .tournament import (
    ASIDE,
    PairingSettings,
    bound_of,
    clearance,
    outcome_of,
    play_track,
    players_touched,
)

DURATION = 40.0  # of the duels in rooms, in [s]
GAMES_PER_SEED = 5  # of each evader in each setting
GAME = StepGame(duration=120.0)
PAIRINGS = {
    "open": PairingSettings(floor="open", game=GAME),
    "room": PairingSettings(room=RoomRecipe(discs=3), game=GAME),
}
AHEAD = "look-ahead"

Tracks = tuple[StrategyTrack, ...]
"""Games of one evader, from the initial poses of a seed each."""


def measure_evading(seed: int) -> dict[str, float]:
    """Play the games of a seed at the level of steps."""
    seeds = range(GAMES_PER_SEED * seed, GAMES_PER_SEED * (seed + 1))
    return read_evading(
        {
            (where, evader): tuple(
                play_track(replace(pairing, evader=evader, seed=each))
                for each in seeds
            )
            for where, pairing in PAIRINGS.items()
            for evader in (ASIDE, AHEAD)
        }
    )


def read_evading(games: Mapping[tuple[str, str], Tracks]) -> dict[str, float]:
    """Compare evaders on the open floor and among obstacles.

    Args:
        games: Games by "open" or "room", and by evader.
    """
    ahead = games["room", AHEAD]
    bounds = [
        bound_of(g.pursuer[0], g.evader[0], GAME) for g in games["open", AHEAD]
    ]
    closest = {
        evader: np.mean([g.distances.min() for g in games["open", evader]])
        for evader in (ASIDE, AHEAD)
    }
    survived = {
        evader: np.mean(
            [g.outcome is Outcome.COMPLETED for g in games["room", evader]]
        )
        for evader in (ASIDE, AHEAD)
    }
    return {
        "farther": float(closest[AHEAD] / closest[ASIDE]),
        "best": float(closest[AHEAD] / np.mean(bounds)),
        "survives": float(survived[AHEAD]),
        "clear": float(min(g.clearances.min() for g in ahead))
        - GAME.body_radius,
        "aside": float(survived[AHEAD] - survived[ASIDE]),
        "decision": 1e3 * float(np.mean([g.decision for g in ahead])),
    }


def measure_room(seed: int) -> dict[str, float]:
    """Play a duel in the room of a seed, with a given map."""
    run = run_duel(
        DuelSettings(
            seed=seed,
            duration=DURATION,
            evader_strategy=AHEAD,
            room=SceneSettings(plan=generate_room(RoomRecipe(discs=3), seed)),
        )
    )
    return read_room(run.uninterrupted())


def read_room(
    run: Run, clear: Callable[[Run, str], float | None] = clearance
) -> dict[str, float]:
    """Read contacts, clearance and free time of a duel in a room.

    Args:
        run: The duel.
        clear: Function from duel and player to the least clearance, in [m].
    """
    least = [clear(run, name) for name in PLAYERS]
    clean = run.outcome is Outcome.COMPLETED or players_touched(run)
    return {
        "touched": float(not clean),
        "clear": min(inf if k is None else k for k in least),
        "free": run.duration if outcome_of(run) is Outcome.COMPLETED else 0.0,
    }
