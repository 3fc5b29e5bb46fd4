"""Readings of instrumented duels for the claims of Sec. III-E and IV."""

from dataclasses import replace
from math import degrees, nan

import numpy as np

from ..games.duel_circle import (
    angle_between,
    circle_of_theory,
    convergence_time,
    distance_between,
)
from ..games.duel_settings import PLAYERS, DuelSettings, StartSettings
from ..games.outcome import Outcome
from ..planning import PRESETS
from ..theory.unicycle.circle_fit import fit_circle
from .claims import Readings, most_deviating
from .instrumented_duel import InstrumentedDuel, play_instrumented
from .walk_measures import (
    distance_walked,
    largest_tilt,
    mean_foot_slip,
    reference_jumps,
    replanning_support,
    step_times,
    walked_arc_fraction,
    walking_speed,
)

SLIPPERY = 0.05  # sliding friction of a floor on which feet slip
MIN_SPEED = 0.5  # fraction of the gait's speed below which a robot is stuck


def circle_settings(seed: int, duration: float = 120.0) -> DuelSettings:
    """Return the settings of the duel of Fig. 5, from random poses."""
    return DuelSettings(seed=seed, duration=duration)


def walk_settings(
    seed: int, preset: str = "nao", duration: float = 30.0
) -> DuelSettings:
    """Return the settings of a duel in which both walk from the begin."""
    return DuelSettings(
        seed=seed,
        duration=duration,
        gait=PRESETS[preset],
        start=StartSettings(distance=0.7),
    )


def slip_settings(
    seed: int, *, slippery: bool, duration: float = 80.0
) -> DuelSettings:
    """Return the settings of the duel of Fig. 6, slippery or not."""
    settings = walk_settings(seed, duration=duration)
    if not slippery:
        return settings
    physics = replace(settings.physics, friction=SLIPPERY)
    return replace(settings, physics=physics)


def read_circle(duel: InstrumentedDuel) -> Readings:
    """Measure the circle of Sec. IV and the replanning of Sec. III-E."""
    landings = [step for name in PLAYERS for step in step_times(duel, name)]
    gait = duel.settings.gait
    shares = [walked_arc_fraction(duel.plans[name], gait) for name in PLAYERS]
    jumps = [reference_jumps(duel, name) for name in PLAYERS]
    on_feet = [replanning_support(duel, name) for name in PLAYERS]
    return last_circle(duel) | {
        "landings": most_deviating(landings, gait.step_duration),
        "both_feet": float(np.min([share for share, _ in on_feet])),
        "at_its_end": float(np.max([late for _, late in on_feet])),
        "straight_part": float(np.max(shares)),
        "place_jump": float(np.max([place for place, _ in jumps])),
        "velocity_jump": float(np.max([rate for _, rate in jumps])),
    }


def last_circle(duel: InstrumentedDuel) -> Readings:
    """Measure the circle of the last third; NaN if the duel ended early."""
    keys = (
        *("settled", "pursuer_radius", "evader_radius", "one_circle"),
        *("distance", "orientation", "same_speed"),
    )
    if duel.outcome is not Outcome.COMPLETED:
        return dict.fromkeys(keys, nan)
    times = duel.times
    pursuer, evader = (duel.tracks[name].unicycle for name in PLAYERS)
    theory = circle_of_theory(duel.settings)
    since = convergence_time(times, pursuer, evader, duel.settings, theory)
    tail = times >= times[-1] * 2.0 / 3.0
    circles = [fit_circle(duel.tracks[n].unicycle[tail, :2]) for n in PLAYERS]
    pursuer_speed, evader_speed = (walking_speed(duel, n) for n in PLAYERS)
    centres = circles[0][0] - circles[1][0]
    values = (
        nan if since is None else since,
        circles[0][1],
        circles[1][1],
        float(np.hypot(*centres)),
        float(distance_between(pursuer, evader)[tail].mean()),
        degrees(float(angle_between(pursuer, evader)[tail].mean())),
        evader_speed / pursuer_speed if pursuer_speed > 0.0 else nan,
    )
    return dict(zip(keys, values, strict=True))


def read_durations(
    printed: InstrumentedDuel, walked: InstrumentedDuel
) -> Readings:
    """Compare the support durations as printed with the exchanged ones."""
    gait = walked.settings.gait
    speeds = [walking_speed(walked, name) for name in PLAYERS]
    slid, leant = mean_foot_slip(walked), largest_tilt(walked)
    return {
        "printed_slide": mean_foot_slip(printed) / slid if slid > 0.0 else nan,
        "printed_tilt": largest_tilt(printed) / leant,
        "upright_for": walked.duration,
        "tilt": largest_tilt(walked),
        "distance": min(distance_walked(walked, name) for name in PLAYERS),
        "speed": most_deviating(speeds, gait.stride / gait.step_duration),
    }


def read_slip(grip: InstrumentedDuel, slip: InstrumentedDuel) -> Readings:
    """Compare a slippery floor with one of normal friction.

    The ratios are NaN unless the robots walk in both duels.
    """
    keys = ("slide", "slower", "smaller")
    if not (_is_walked(grip) and _is_walked(slip)):
        return dict.fromkeys(keys, nan)
    pairs = [
        [mean_foot_slip(duel), _mean_speed(duel), _mean_radius(duel)]
        for duel in (grip, slip)
    ]
    ratios = [b / a if a > 0.0 else nan for a, b in zip(*pairs, strict=True)]
    return dict(zip(keys, ratios, strict=True))


def _is_walked(duel: InstrumentedDuel) -> bool:
    """Return whether a duel was completed and both robots walked."""
    gait = duel.settings.gait
    least = MIN_SPEED * gait.stride / gait.step_duration
    ended = duel.outcome is Outcome.COMPLETED
    return ended and all(walking_speed(duel, name) > least for name in PLAYERS)


def _mean_speed(duel: InstrumentedDuel) -> float:
    return float(np.mean([walking_speed(duel, name) for name in PLAYERS]))


def _mean_radius(duel: InstrumentedDuel) -> float:
    found = last_circle(duel)
    return 0.5 * (found["pursuer_radius"] + found["evader_radius"])


def measure_humanoids(seed: int) -> Readings:
    """Play the duel of Fig. 5 from the random initial poses of a seed."""
    return read_circle(play_instrumented(circle_settings(seed)))


def measure_durations(seed: int) -> Readings:
    """Play duels with the durations as printed, and exchanged."""
    printed, exchanged = (
        play_instrumented(walk_settings(seed, preset))
        for preset in ("as-printed", "nao")
    )
    return read_durations(printed, exchanged)


def measure_slip(seed: int) -> Readings:
    """Play duels on a floor with normal friction and on a slippery one."""
    grip, slip = (
        play_instrumented(slip_settings(seed, slippery=slippery))
        for slippery in (False, True)
    )
    return read_slip(grip, slip)
