"""Readings of games for the claims of Sec. III-E, IV and V."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from math import degrees, inf, nan

import numpy as np

from ..arena import RoomRecipe, generate_room
from ..core.errors import ConfigurationError
from ..games.duel_circle import (
    angle_between,
    circle_of_theory,
    convergence_time,
    distance_between,
    last_third,
)
from ..games.floor_games import StrategyTrack
from ..games.game_settings import GameSettings, StartSettings, duel
from ..games.outcome import Outcome
from ..games.player_settings import PLAYERS
from ..games.recorded_game import run_game
from ..games.run import Run
from ..games.settings_reader import read_game
from ..planning import PRESETS
from ..strategies.strategy_game import StepGame
from ..theory.unicycle.circle_fit import fit_circle
from .theory_claims import most_deviating
from .tournament import (
    ASIDE,
    PairingSettings,
    bound_of,
    clearance,
    outcome_of,
    play_track,
    players_touched,
)
from .walk_measures import (
    InstrumentedDuel,
    distance_walked,
    largest_tilt,
    mean_foot_slip,
    play_instrumented,
    reference_jumps,
    replanning_support,
    step_times,
    walked_arc_fraction,
    walking_speed,
)

SLIPPERY = 0.05  # sliding friction of a floor on which feet slip
MIN_SPEED = 0.5  # fraction of the gait's speed below which a robot is stuck
CIRCLE_TIME = 120.0  # of the duel of Fig. 5, in [s]
WALK_TIME, SLIP_TIME = 30.0, 80.0  # of the others, in [s]


def walk_settings(
    seed: int,
    preset: str = "nao",
    duration: float = WALK_TIME,
    friction: float | None = None,
) -> GameSettings:
    """Return the settings of a duel in which both walk from the begin."""
    settings = duel(
        seed=seed,
        duration=duration,
        gait=PRESETS[preset],
        start=StartSettings(distance=0.7),
    )
    if friction is None:
        return settings
    physics = replace(settings.physics, friction=friction)
    return replace(settings, physics=physics)


def measure_humanoids(seed: int) -> dict[str, float]:
    """Play the duel of Fig. 5 from the random initial poses of a seed."""
    settings = duel(seed=seed, duration=CIRCLE_TIME)
    return read_circle(play_instrumented(settings))


def read_circle(played: InstrumentedDuel) -> dict[str, float]:
    """Measure the circle of Sec. IV and the replanning of Sec. III-E."""
    landings = [step for name in PLAYERS for step in step_times(played, name)]
    gait = played.run.settings.gait
    shares = [
        walked_arc_fraction(played.plans[name], gait) for name in PLAYERS
    ]
    jumps = [reference_jumps(played, name) for name in PLAYERS]
    on_feet = [replanning_support(played, name) for name in PLAYERS]
    position, velocity = np.max(jumps, axis=0).tolist()
    pursuer, evader = (walking_speed(played, name) for name in PLAYERS)
    return last_circle(played.run) | {
        "same_speed": evader / pursuer if pursuer > 0.0 else nan,
        "landings": most_deviating(landings, gait.step_duration),
        "both_feet": float(np.min([share for share, _ in on_feet])),
        "at_its_end": float(np.max([late for _, late in on_feet])),
        "straight_part": float(np.max(shares)),
        "place_jump": position,
        "velocity_jump": velocity,
    }


def last_circle(run: Run) -> dict[str, float]:
    """Measure the circle of the last third; NaN if the duel ended early."""
    keys = (
        *("settled", "pursuer_radius", "evader_radius", "one_circle"),
        *("distance", "orientation"),
    )
    if run.outcome is not Outcome.COMPLETED:
        return dict.fromkeys(keys, nan)
    times, settings = run.times, run.settings
    pursuer, evader = (run.tracks[name].unicycle for name in PLAYERS)
    theory = circle_of_theory(settings)
    since = convergence_time(times, pursuer, evader, settings, theory)
    tail = last_third(times)
    (centre, radius), (other_centre, other_radius) = (
        fit_circle(poses[tail, :2]) for poses in (pursuer, evader)
    )
    values = (
        nan if since is None else since,
        radius,
        other_radius,
        float(np.hypot(*(centre - other_centre))),
        float(distance_between(pursuer, evader)[tail].mean()),
        degrees(float(angle_between(pursuer, evader)[tail].mean())),
    )
    return dict(zip(keys, values, strict=True))


def measure_durations(seed: int) -> dict[str, float]:
    """Play duels with the durations as printed, and exchanged."""
    printed, exchanged = (
        play_instrumented(walk_settings(seed, preset, WALK_TIME))
        for preset in ("as-printed", "nao")
    )
    return read_durations(printed, exchanged)


def read_durations(
    printed: InstrumentedDuel, walked: InstrumentedDuel
) -> dict[str, float]:
    """Compare the support durations as printed with the exchanged ones."""
    gait = walked.run.settings.gait
    speeds = [walking_speed(walked, name) for name in PLAYERS]
    slid, tilt = mean_foot_slip(walked), largest_tilt(walked)
    return {
        "printed_slide": mean_foot_slip(printed) / slid if slid > 0.0 else nan,
        "printed_tilt": largest_tilt(printed) / tilt,
        "upright_for": walked.run.duration,
        "tilt": tilt,
        "distance": min(distance_walked(walked, name) for name in PLAYERS),
        "speed": most_deviating(speeds, gait.stride / gait.step_duration),
    }


def measure_slip(seed: int) -> dict[str, float]:
    """Play duels on a floor with normal friction and on a slippery one."""
    grip, slip = (
        play_instrumented(walk_settings(seed, "nao", SLIP_TIME, friction))
        for friction in (None, SLIPPERY)
    )
    return read_slip(grip, slip)


def read_slip(
    grip: InstrumentedDuel, slip: InstrumentedDuel
) -> dict[str, float]:
    """Compare a slippery floor with one of normal friction.

    The ratios are NaN unless the robots walk in both duels.
    """
    (slid, speed, radius), slippery = _walk_of(grip), _walk_of(slip)
    return {
        "slide": slippery[0] / slid if slid > 0.0 else nan,
        "slower": slippery[1] / speed,
        "smaller": slippery[2] / radius,
    }


def _walk_of(played: InstrumentedDuel) -> tuple[float, float, float]:
    """Return slip, speed and radius; NaN unless both robots walk."""
    gait = played.run.settings.gait
    speeds = [walking_speed(played, name) for name in PLAYERS]
    least = MIN_SPEED * gait.stride / gait.step_duration
    circle = last_circle(played.run)
    if played.run.outcome is not Outcome.COMPLETED or not min(speeds) > least:
        return nan, nan, nan
    radius = 0.5 * (circle["pursuer_radius"] + circle["evader_radius"])
    return mean_foot_slip(played), float(np.mean(speeds)), radius


def legs_settings(robot: str, seed: int) -> GameSettings:
    """Return the settings of the duel of Fig. 5 on learned legs.

    The description in the folder of the robot names a policy.
    """
    settings = duel(seed=seed, duration=CIRCLE_TIME)
    settings = read_game({"robot": robot}, base=settings)
    if not settings.evader.legs.walks:
        raise ConfigurationError(
            f"the robot {robot!r} must have learned legs: its robot.toml "
            "names no network in [locomotion]"
        )
    return settings


def measure_legs(robot: str, seed: int) -> dict[str, float]:
    """Play the duel of Fig. 5 on the learned legs of a robot."""
    return last_circle(run_game(legs_settings(robot, seed)).uninterrupted())


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
    """Compare evaders, by floor and name, on the open floor and in rooms."""
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
    run = run_game(
        duel(
            seed=seed,
            duration=DURATION,
            evader={"strategy": AHEAD},
            room=generate_room(RoomRecipe(discs=3), seed),
        )
    )
    return read_room(run.uninterrupted())


def read_room(
    run: Run, clear: Callable[[Run, str], float | None] = clearance
) -> dict[str, float]:
    """Read contacts, clearance [m] and free time [s] of a duel in a room."""
    least = [clear(run, name) for name in PLAYERS]
    clean = run.outcome is Outcome.COMPLETED or players_touched(run)
    return {
        "touched": float(not clean),
        "clear": min(inf if k is None else k for k in least),
        "free": run.duration if outcome_of(run) is Outcome.COMPLETED else 0.0,
    }
