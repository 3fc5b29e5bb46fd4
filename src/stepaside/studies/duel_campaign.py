"""Campaign of duels from random initial poses: one record per seed."""

from collections.abc import Sequence
from functools import cache, partial

from ..games.duel_settings import DuelSettings
from ..games.strategy_resolution import check_strategy_names
from .duel_record import play_seed, play_seeds, settings_hash
from .study import Study

# Duels on learned legs that are played side by side; each takes about 10 MB.
TOGETHER = 16


def duel_study(settings: DuelSettings, seeds: Sequence[int]) -> Study[int]:
    """Return the study of a duel from many initial poses; cases are seeds.

    Args:
        settings: Settings of every duel; the seed is ignored.
        seeds: Seeds of the duels.

    Raises:
        ConfigurationError: If there is no strategy with a given name.
    """
    names = settings.evader_strategy, settings.pursuer_strategy
    if all(isinstance(name, str) for name in names):
        check_strategy_names(settings)

    @cache
    def own() -> str:
        check_strategy_names(settings)  # objects cannot be stored
        return settings_hash(settings)

    legs = any(settings.robot_of(each).legs.walks for each in settings.robots)
    return Study(
        "duels",
        seeds,
        partial(play_seed, settings),
        lambda seed: f"{seed}/{own()}",
        partial(play_seeds, settings) if legs else None,
        TOGETHER if legs else 1,
    )
