"""Jobs that measure the claims of the paper."""

from collections.abc import Callable
from dataclasses import asdict

from ..games.configuration_file import dump_configuration
from ..games.duel_settings import DuelSettings
from . import balance_claims as balance
from . import evasion_claims as evading
from . import physics_claims as physics
from . import physics_measurements as read
from . import planner_claims as planner
from . import unicycle_claims as unicycle
from .claims import Claim, ClaimJob, Readings
from .evasion_measurements import (
    TOURNAMENTS,
    measure_evading,
    measure_room,
    room_settings,
)


def _game(
    claims: tuple[Claim, ...], measure: Callable[[], Readings]
) -> ClaimJob:
    """Return a job on unicycles; its settings are constants of the code."""
    return ClaimJob(claims, lambda _: measure())


def _plan(
    claims: tuple[Claim, ...], measure: Callable[[], Readings]
) -> ClaimJob:
    """Return a job on the planner, with the gait of Sec. IV."""
    settings = repr(asdict(planner.GAIT))
    return ClaimJob(claims, lambda _: measure(), lambda _: settings)


def _duel(
    claims: tuple[Claim, ...],
    measure: Callable[[int], Readings],
    *settings: Callable[[int], DuelSettings],
) -> ClaimJob:
    """Return a job on two NAOs in physics, from random initial poses."""

    def settings_text(seed: int) -> str:
        return "; ".join(dump_configuration(each(seed)) for each in settings)

    return ClaimJob(claims, measure, settings_text, seeded=True)


JOBS: dict[str, ClaimJob] = {
    "circle": _game(unicycle.CIRCLE, unicycle.read_circle),
    "saturated": _game(unicycle.SATURATED, unicycle.read_saturated),
    "strategies": _game(unicycle.STRATEGIES, unicycle.read_strategies),
    "sampled": _game(unicycle.SAMPLED, unicycle.read_sampled),
    "path": _plan(planner.PATH, planner.read_path),
    "footsteps": _plan(planner.FOOTSTEPS, planner.read_footsteps),
    "com": _plan(balance.COM, balance.read_com),
    "timing": _plan(balance.TIMING, balance.read_timing),
    "humanoids": _duel(
        physics.HUMANOIDS, read.measure_humanoids, read.circle_settings
    ),
    "durations": _duel(
        physics.DURATIONS,
        read.measure_durations,
        lambda seed: read.walk_settings(seed, "as-printed"),
        read.walk_settings,
    ),
    "slip": _duel(
        physics.SLIP,
        read.measure_slip,
        lambda seed: read.slip_settings(seed, slippery=False),
        lambda seed: read.slip_settings(seed, slippery=True),
    ),
    "evading": ClaimJob(
        evading.EVADING,
        measure_evading,
        lambda _: repr(TOURNAMENTS),
        seeded=True,
    ),
    "rooms": ClaimJob(
        evading.ROOM,
        measure_room,
        lambda seed: dump_configuration(room_settings(seed)),
        seeded=True,
    ),
}
