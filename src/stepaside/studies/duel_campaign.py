"""Campaign of duels from random initial poses: one record per seed."""

from collections.abc import Iterable, Sequence
from functools import partial
from typing import Any

from ..games.duel_settings import DuelSettings
from ..games.strategy_resolution import check_strategy_names
from .campaign import Study, code_stamp
from .duel_record import FIELDS, play_seed, play_seeds, settings_hash
from .records import Record

MODULES = ("studies/duel_record",)  # which plays and records a duel
LIBRARIES = ("mujoco", "numpy")
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
    check_strategy_names(settings)
    own = settings_hash(settings)
    legs = any(settings.robot_of(each).legs.walks for each in settings.robots)
    return Study(
        "duels",
        seeds,
        partial(play_seed, settings),
        lambda seed: f"{seed}/{own}",
        lambda seed: code_stamp(MODULES, LIBRARIES),
        FIELDS,
        ("wall_s",),
        partial(play_seeds, settings) if legs else None,
        TOGETHER if legs else 1,
    )


def versions_of(records: Iterable[Record]) -> Record:
    """Return the versions of code and libraries of some records.

    Returns:
        ``version`` and ``libraries`` of the records. Each is a list if there
        are several.
    """
    stamps: dict[str, list[Any]] = {}
    for record in records:
        for name in ("version", "libraries"):
            value = record.get(name)
            found = stamps.setdefault(name, [])
            if value is not None and value not in found:
                found.append(value)
    return {
        name: found[0] if len(found) == 1 else found
        for name, found in stamps.items()
        if found
    }
