"""Options of the commands that simulate duels or walks."""

from ...games.duel_settings import DuelSettings
from .room_options import RECIPE
from .setting_options import Decorator
from .settings_command import OptionGroup, takes_settings

RUN = OptionGroup("Run", ("seed", "duration", "robot"))
START = OptionGroup(
    "Initial poses (drawn from the seed unless given)", ("start",)
)
STRATEGY = OptionGroup(
    "Strategy", ("evader_strategy", "pursuer_strategy", "strategy")
)
SHIELD = OptionGroup("Shield of the evader (docs/shield.md)", ("shield",))
GAIT = OptionGroup("Gait", ("gait",))
BODY = OptionGroup(
    "Body (each option modifies the preset of --body)", ("body",)
)
CONTROL = OptionGroup("Control", ("control",))
PHYSICS = OptionGroup("Floor and physics", ("physics",))
DUEL = (
    RUN,
    OptionGroup(
        "Robots (each with the gait and control of its description)",
        ("pursuer_robot", "evader_robot"),
    ),
    START,
    OptionGroup("Room", ("room.plan", RECIPE, "map")),
    STRATEGY,
    SHIELD,
    GAIT,
    OptionGroup("Learned legs (docs/legs.md)", ("legs",)),
    BODY,
    CONTROL,
    PHYSICS,
    OptionGroup("Sightings (--sensing ideal)", ("sensing", "sight")),
    OptionGroup(
        "Cameras (--sensing cameras)", ("cameras", "room.things", "room.walls")
    ),
    OptionGroup("Pursuing person", ("pursuer", "person")),
    OptionGroup("Pushes", ("pushes",)),
)
WALK = (
    RUN,
    OptionGroup("Walk", ("bearing", "backward", "pushes")),
    GAIT,
    BODY,
    CONTROL,
    PHYSICS,
)


def duel_options(*without: str) -> Decorator:
    """Add the options of a duel to a command; pass it ``settings``.

    Args:
        without: Entries whose options the command does not have.
    """
    return takes_settings(DuelSettings, *DUEL, without=without)
