"""Options that decide a duel."""

from collections.abc import Callable
from typing import Any

from .options.body_options import BODY, CONTROL, PHYSICS
from .options.declaration import OptionDeclaration, OptionGroup
from .options.gait_options import GAIT
from .options.game_options import (
    CAMERAS,
    PERSON,
    ROBOTS,
    RUN,
    SIGHT,
    START,
    STRATEGY,
)
from .options.passer_type import PASSERS
from .options.push_type import PUSHES
from .options.room_options import PLAYED_IN
from .options.settings_command import takes_settings

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
    OptionGroup("Who passes", (PASSERS,)),
    OptionGroup("Pushes", (PUSHES,)),
)


def duel_options(
    *without: OptionDeclaration,
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Give a command the ``settings`` of a duel, and the options for them.

    Args:
        without: Options that this command lacks.
    """
    groups = (group.without(*without) for group in GROUPS)
    return takes_settings(duel_kind, *groups)


def duel_kind() -> type[Any]:
    """Class of the settings of a duel, when it is needed."""
    from ..games.duel_settings import DuelSettings

    return DuelSettings
