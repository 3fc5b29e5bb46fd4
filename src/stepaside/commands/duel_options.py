"""Options that decide a duel."""

from collections.abc import Callable
from typing import Any

from .declared.body import BODY, CONTROL, PHYSICS
from .declared.gait import GAIT
from .declared.game import (
    CAMERAS,
    PERSON,
    ROBOTS,
    RUN,
    SIGHT,
    START,
    STRATEGY,
)
from .declared.option import Declaration, Group
from .declared.passer import PASSERS
from .declared.push import PUSHES
from .declared.rooms import PLAYED_IN
from .declared.take import takes_settings

GROUPS = (
    RUN,
    ROBOTS,
    START,
    PLAYED_IN,
    STRATEGY,
    GAIT,
    BODY,
    CONTROL,
    PHYSICS,
    SIGHT,
    CAMERAS,
    PERSON,
    Group("Who passes", (PASSERS,)),
    Group("Pushes", (PUSHES,)),
)


def duel_options(
    *without: Declaration,
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Give a command the ``settings`` of a duel, and the options for them.

    Args:
        without: Options that this command lacks.
    """
    groups = (group.without(*without) for group in GROUPS)
    return takes_settings(duel_kind, *groups)


def duel_kind() -> type[Any]:
    """Class of the settings of a duel, when it is needed."""
    from ..games.settings import DuelSettings

    return DuelSettings
