"""Games of a tournament, and the record of each."""

from dataclasses import replace
from math import isfinite, pi

import numpy as np

from ..arena import Room
from ..core.convex import grown_hull_area
from ..core.poses import Array, rotate, wrap_angles
from ..games.floor_games import StrategyTrack, play_strategies
from ..games.floor_world import PARTS
from ..games.outcome import Outcome
from ..strategies import load_strategy
from ..strategies.strategy_game import StepGame
from ..strategies.table_cache import pursuit_bound
from .tabulation import Record
from .tournament_settings import HUMANOIDS, TournamentSettings
from .tournament_strategies import SIGHT

CELLS = 64  # of the value table of the bound

Pairing = tuple[str, str]
"""Names of an evader and of a pursuer."""


def play_track(
    settings: TournamentSettings, pairing: Pairing, seed: int
) -> tuple[Room, StrategyTrack]:
    """Play one game at level "steps" or "unicycle"; return its track."""
    evader, pursuer = map(load_strategy, pairing)
    room, starts = settings.arena(seed)
    game = replace(settings.game, decisions=PARTS[settings.level])
    return room, play_strategies(pursuer, evader, starts, room=room, game=game)


def play_record(
    settings: TournamentSettings, pairing: Pairing, seed: int
) -> Record:
    """Play one game of a tournament and return its record.

    Returns:
        Values in SI units.
    """
    play = _humanoid_values if settings.level == HUMANOIDS else _step_values
    return {
        "evader": pairing[0],
        "pursuer": pairing[1],
        "seed": seed,
        **play(settings, pairing, seed),
    }


def _step_values(
    settings: TournamentSettings, pairing: Pairing, seed: int
) -> Record:
    """Play a game at level "steps" or "unicycle" and return its values."""
    _, track = play_track(settings, pairing, seed)
    game = settings.game
    distances = track.distances
    turns = wrap_angles(np.diff(track.evader[:, 2]))
    moved = np.diff(track.evader[:, :2], axis=0)
    seconds = (len(distances) - 1) * game.period / PARTS[settings.level]
    clear = float(track.clearances.min())
    return {
        "outcome": track.outcome.value,
        "survived_s": seconds,
        "closest_m": float(distances.min()),
        "bound_m": bound_of(track.pursuer[0], track.evader[0], game),
        "clearance_m": clear if isfinite(clear) else None,
        "floor_m2": grown_hull_area(track.evader[:, :2], game.body_radius),
        "walked_m": float(np.hypot(*moved.T).sum()),
        "turning_rad_s": float(np.abs(turns).sum()) / max(seconds, 1e-9),
        "unseen": float((np.abs(track.bearings) > SIGHT).mean()),
        "decision_s": track.decision,
        "longest_decision_s": track.longest_decision,
    }


def _humanoid_values(
    settings: TournamentSettings, pairing: Pairing, seed: int
) -> Record:
    """Play a game in physics and return its values.

    Raises:
        KeyboardInterrupt: If it was interrupted; it is not recorded then.
    """
    from ..games.recorded_game import run_duel
    from .tournament_physics import duel_settings, record_values_of

    run = run_duel(
        duel_settings(
            pairing,
            *settings.arena(seed),
            seed=seed,
            duration=settings.game.duration,
            source=settings.map,
        )
    )
    if run.outcome is Outcome.INTERRUPTED:
        raise KeyboardInterrupt
    pursuer, evader = (
        track.unicycle[0] for track in (run.pursuer, run.evader)
    )
    found = record_values_of(run, settings.game.body_radius)
    return found | {"bound_m": bound_of(pursuer, evader, settings.game)}


def bound_of(pursuer: Array, evader: Array, game: StepGame) -> float:
    """Return the value of the game on an open floor from two poses.

    Returns:
        Closest approach under optimal play, in [m].
    """
    unit, heading = game.speed / game.gain, pursuer[2]
    x, y = (evader[:2] - pursuer[:2]) / unit
    x, y = rotate(x, y, -heading)
    # The evader walks backwards.
    value = pursuit_bound(CELLS).value((x, y, evader[2] + pi - heading))
    return unit * float(value)
