"""Search for the pursuer of a family that captures an evader soonest."""

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from functools import lru_cache, partial
from hashlib import sha256
from math import inf, log
from typing import NamedTuple

import numpy as np

from ..arena import Room
from ..core.atomic_output import atomic_draft
from ..core.compilation import cache_folder
from ..core.errors import StepAsideError
from ..core.poses import Array
from ..core.random_streams import named_generator
from ..strategies import ParametricPursuit
from ..strategies.registry import file_of
from ..strategies.strategy_game import StrategyOutcome, StrategyTrack
from .campaign import code_stamp
from .tournament_games import play_game
from .tournament_settings import TournamentSettings
from .tournament_strategies import evader_of

LEAST = np.array([log(0.5), -0.5, 0.0, log(1.0)])  # logarithm of the gain
MOST = np.array([log(12.5), 2.0, 1.0, log(40.0)])  # ratio, pull, sway [rad],
# logarithm of the period in [s]
ROOMS = 3  # that every candidate plays in
CANDIDATES = 24  # drawn at random
REFINED = 24  # variations of the best so far, with smaller and smaller changes
SPREAD = 0.3, 0.05  # of the first and the last variation, over the ranges
MODULES = ("studies/pursuer_search",)


class SearchedPursuer(NamedTuple):
    """Pursuer that a search found.

    Attributes:
        pursuer: The pursuer.
        survived_s: Mean survival of the evader in the rooms of the search,
            in [s].
    """

    pursuer: ParametricPursuit
    survived_s: float

    @property
    def text(self) -> str:
        """The parameters as text."""
        own = self.pursuer
        return (
            f"gain x{own.gain_ratio:.2f}, pull {own.pull:.2f}, sway "
            f"{own.sway:.2f} rad in {own.period:.1f} s"
        )


@lru_cache(maxsize=64)
def searched_pursuer(
    settings: TournamentSettings, evader: str, speed_ratio: float, seed: int
) -> SearchedPursuer:
    """Return the pursuer of a search; it is kept beside compiled code.

    Args:
        settings: Settings of the tournament.
        evader: Name of the evader.
        speed_ratio: Speed of the pursuer over that of the evader.
        seed: Seed of the search.
    """
    parts = [settings.fingerprint(), evader, speed_ratio, seed]
    parts += [*code_stamp(MODULES, ("numba", "numpy"))]
    if (own := file_of(evader)) is not None:
        parts.append(sha256(own.read_bytes()).hexdigest())
    digest = sha256(repr(parts).encode()).hexdigest()[:16]
    file = cache_folder() / f"pursuer-{digest}.json"
    try:
        values = json.loads(file.read_text(encoding="utf-8"))
        survived = float(values.pop("survived_s"))
        return SearchedPursuer(ParametricPursuit(**values), survived)
    except (OSError, ValueError, TypeError, KeyError, StepAsideError):
        pass
    found = search_pursuer(settings, evader, speed_ratio, seed)
    values = asdict(found.pursuer) | {"survived_s": found.survived_s}
    try:  # the file only saves time
        with atomic_draft(file) as draft:
            draft.write_text(json.dumps(values), encoding="utf-8")
    except (OSError, StepAsideError):
        pass
    return found


def search_pursuer(
    settings: TournamentSettings, evader: str, speed_ratio: float, seed: int
) -> SearchedPursuer:
    """Search the pursuer against which an evader survives least.

    Of pursuers drawn at random, and variations of the best so far, the one
    with the least total survival time in some rooms is taken, or if the
    evader always survives the one that comes closest. The rooms are drawn by
    the search; a game ends as soon as its pursuer cannot become the best.

    Args:
        settings: Settings of the tournament.
        evader: Name of the evader.
        speed_ratio: Speed of the pursuer over that of the evader.
        seed: Seed of the search.
    """
    generator = named_generator(seed, "pursuer search")
    rooms = [int(n) for n in generator.integers(1 << 40, 1 << 41, ROOMS)]
    best, least = np.zeros(len(LEAST)), (inf, inf)
    spreads = np.geomspace(*SPREAD, REFINED)
    for i in range(CANDIDATES + REFINED):
        drawn = generator.random(len(LEAST))
        if i >= CANDIDATES:
            change = generator.standard_normal(len(LEAST))
            drawn = np.clip(best + spreads[i - CANDIDATES] * change, 0.0, 1.0)
        game = partial(
            play_game,
            evader=evader_of(evader, settings.angle),
            pursuer=pursuer_at(drawn),
            speed_ratio=speed_ratio,
        )
        found = _outcome(settings, game, rooms, least[0])
        if found < least:
            best, least = drawn, found
    return SearchedPursuer(pursuer_at(best), least[0] / ROOMS)


def pursuer_at(shares: Array) -> ParametricPursuit:
    """Return the pursuer at shares of the ranges. Shape (4,)."""
    values = LEAST + shares * (MOST - LEAST)
    values[[0, 3]] = np.exp(values[[0, 3]])
    return ParametricPursuit(*np.round(values, 4).tolist())


def _outcome(
    settings: TournamentSettings,
    game: Callable[..., tuple[Room, StrategyTrack]],
    rooms: Sequence[int],
    most: float,
) -> tuple[float, float]:
    """Play in all rooms, unless the survival exceeds that of the best.

    Args:
        settings: Settings of the tournament.
        game: Plays a game, given settings and seed.
        rooms: Seeds of the rooms.
        most: Total survival of the best pursuer so far, in [s].

    Returns:
        Total survival [s] and sum of the closest approaches [m]; infinite if
        the pursuer is not as good as the best.
    """
    survived, closest = 0.0, 0.0
    for room in rooms:
        duration = min(settings.game.duration, most - survived)
        rules = replace(settings.game, duration=max(duration, 1e-9))
        _, track = game(replace(settings, game=rules), seed=room)
        survived += float(track.times[-1])
        closest += track.closest_distance
        is_cut = duration < settings.game.duration
        if is_cut and track.outcome is StrategyOutcome.SURVIVED:
            return inf, inf
    return survived, closest
