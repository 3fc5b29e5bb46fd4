"""What a watched duel says about the claims of Sec. III-E and IV."""

from dataclasses import replace
from math import degrees, nan

import numpy as np

from ..games.duel_circle import (
    angle_between,
    converged_at,
    distance_between,
    theory_of,
)
from ..games.duel_settings import PLAYERS, DuelSettings, StartSettings
from ..games.outcome import Outcome
from ..planning import PRESETS
from ..theory.unicycle.circle_fit import fit_circle
from .claims import Readings, farthest
from .walk_measures import (
    both_feet,
    distance_walked,
    greatest_tilt,
    mean_slide,
    plan_share,
    reference_jumps,
    steps_of,
    walking_speed,
)
from .watched_duel import WatchedDuel, watch

SLIPPERY = 0.05  # sliding friction of a floor on which feet slip
SLOWEST = 0.5  # of the gait's speed: who is slower does not walk


def circle_settings(seed: int, duration: float = 120.0) -> DuelSettings:
    """Duel of Fig. 5 from a random start."""
    return DuelSettings(seed=seed, duration=duration)


def walk_settings(
    seed: int, preset: str = "nao", duration: float = 30.0
) -> DuelSettings:
    """Duel in which both walk from the first moment on."""
    return DuelSettings(
        seed=seed,
        duration=duration,
        gait=PRESETS[preset],
        start=StartSettings(distance=0.7),
    )


def slip_settings(
    seed: int, *, slippery: bool, duration: float = 80.0
) -> DuelSettings:
    """Duel of Fig. 6, on a floor with grip or on a slippery one."""
    settings = walk_settings(seed, duration=duration)
    if not slippery:
        return settings
    physics = replace(settings.physics, friction=SLIPPERY)
    return replace(settings, physics=physics)


def read_circle(duel: WatchedDuel) -> Readings:
    """The circle of Sec. IV and the replanning of Sec. III-E."""
    landings = [step for name in PLAYERS for step in steps_of(duel, name)]
    gait = duel.settings.gait
    shares = [plan_share(duel.plans[name], gait) for name in PLAYERS]
    jumps = [reference_jumps(duel, name) for name in PLAYERS]
    on_feet = [both_feet(duel, name) for name in PLAYERS]
    return last_circle(duel) | {
        "landings": farthest(landings, gait.step_duration),
        "both_feet": float(np.min([share for share, _ in on_feet])),
        "at_its_end": float(np.max([late for _, late in on_feet])),
        "straight_part": float(np.max(shares)),
        "place_jump": float(np.max([place for place, _ in jumps])),
        "velocity_jump": float(np.max([rate for _, rate in jumps])),
    }


def last_circle(duel: WatchedDuel) -> Readings:
    """Circle of the last third; NaN of a duel that ended before its time."""
    keys = (
        *("settled", "pursuer_radius", "evader_radius", "one_circle"),
        *("distance", "orientation", "same_speed"),
    )
    if duel.outcome is not Outcome.COMPLETED:
        return dict.fromkeys(keys, nan)
    times = duel.times
    pursuer, evader = (duel.tracks[name].unicycle for name in PLAYERS)
    theory = theory_of(duel.settings)
    since = converged_at(times, pursuer, evader, duel.settings, theory)
    tail = times >= times[-1] * 2.0 / 3.0
    circles = [fit_circle(duel.tracks[n].unicycle[tail, :2]) for n in PLAYERS]
    speed, other = (walking_speed(duel, name) for name in PLAYERS)
    apart = circles[0][0] - circles[1][0]
    values = (
        nan if since is None else since,
        circles[0][1],
        circles[1][1],
        float(np.hypot(*apart)),
        float(distance_between(pursuer, evader)[tail].mean()),
        degrees(float(angle_between(pursuer, evader)[tail].mean())),
        other / speed if speed > 0.0 else nan,
    )
    return dict(zip(keys, values, strict=True))


def read_durations(printed: WatchedDuel, walked: WatchedDuel) -> Readings:
    """The durations as printed, and exchanged."""
    gait = walked.settings.gait
    speeds = [walking_speed(walked, name) for name in PLAYERS]
    slid, leant = mean_slide(walked), greatest_tilt(walked)
    return {
        "printed_slide": mean_slide(printed) / slid if slid > 0.0 else nan,
        "printed_tilt": greatest_tilt(printed) / leant,
        "upright_for": walked.duration,
        "tilt": greatest_tilt(walked),
        "distance": min(distance_walked(walked, name) for name in PLAYERS),
        "speed": farthest(speeds, gait.stride / gait.step_duration),
    }


def read_slip(grip: WatchedDuel, slip: WatchedDuel) -> Readings:
    """A slippery floor beside one with grip; NaN unless both are walked."""
    keys = ("slide", "slower", "smaller")
    if not (_is_walked(grip) and _is_walked(slip)):
        return dict.fromkeys(keys, nan)
    pairs = [
        [mean_slide(duel), _mean_speed(duel), _mean_radius(duel)]
        for duel in (grip, slip)
    ]
    ratios = [b / a if a > 0.0 else nan for a, b in zip(*pairs, strict=True)]
    return dict(zip(keys, ratios, strict=True))


def _is_walked(duel: WatchedDuel) -> bool:
    """Whether a duel came to its end and both got on until then."""
    gait = duel.settings.gait
    least = SLOWEST * gait.stride / gait.step_duration
    ended = duel.outcome is Outcome.COMPLETED
    return ended and all(walking_speed(duel, name) > least for name in PLAYERS)


def _mean_speed(duel: WatchedDuel) -> float:
    return float(np.mean([walking_speed(duel, name) for name in PLAYERS]))


def _mean_radius(duel: WatchedDuel) -> float:
    found = last_circle(duel)
    return 0.5 * (found["pursuer_radius"] + found["evader_radius"])


def measure_humanoids(seed: int) -> Readings:
    """Play the duel of Fig. 5 from the random start of a seed."""
    return read_circle(watch(circle_settings(seed)))


def measure_durations(seed: int) -> Readings:
    """Walk with the durations as printed, and exchanged."""
    printed, exchanged = (
        watch(walk_settings(seed, preset)) for preset in ("as-printed", "nao")
    )
    return read_durations(printed, exchanged)


def measure_slip(seed: int) -> Readings:
    """Play on a floor with grip and on a slippery one."""
    grip, slip = (
        watch(slip_settings(seed, slippery=slippery))
        for slippery in (False, True)
    )
    return read_slip(grip, slip)
