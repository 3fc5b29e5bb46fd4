"""Options of all commands that simulate duels."""

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
from .options.room_options import ROOM_GROUP
from .options.settings_command import takes_settings

GROUPS = (
    RUN,
    ROBOTS,
    START,
    ROOM_GROUP,
    STRATEGY,
    GAIT,
    BODY,
    CONTROL,
    PHYSICS,
    SIGHT,
    CAMERAS,
    PERSON,
    OptionGroup("Passing pedestrians", (PASSERS,)),
    OptionGroup("Pushes", (PUSHES,)),
)


def duel_options(
    *without: OptionDeclaration,
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Add the options of a duel to a command; pass it ``settings``.

    Args:
        without: Options that the command does not have.
    """
    groups = (group.without(*without) for group in GROUPS)
    return takes_settings(duel_settings_class, *groups)


def duel_settings_class() -> type[Any]:
    """Import and return the class of the settings of a duel."""
    from ..games.duel_settings import DuelSettings

    return DuelSettings
