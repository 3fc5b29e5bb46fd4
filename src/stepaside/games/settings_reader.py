"""Settings from entries of files, studies and commands.

The robot, its legs, and the presets of gait and body that the entries name
are read first; all other entries change these.
"""

from collections.abc import Collection, Mapping
from dataclasses import fields, replace
from typing import Any

from ..arena import Room, RoomRecipe, generate_room, load_room
from ..core.entries import read_entries
from ..core.errors import ConfigurationError
from ..core.setting import NONE
from ..planning import PRESETS
from ..sim.body_settings import BODIES
from .configuration_file import parse_settings
from .robot_settings import (
    body_of_robot,
    with_legs,
    with_players,
    with_robot,
)

PRESET = ""  # name of a preset among the entries that change it
RECIPE = "recipe"  # entries of a random room


def nested(
    changes: Mapping[str, Any], below: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    """Return nested entries with changes by name with dots.

    A preset, like ``body = "hardware"``, below changes of its entries
    becomes the entry with an empty name among them.
    """
    found = dict(below or {})
    for name, value in changes.items():
        head, dot, rest = name.partition(".")
        if dot or isinstance(value, dict):
            own = found.get(head, {})
            own = own if isinstance(own, dict) else {PRESET: own}
            found[head] = nested({rest: value} if dot else value, own)
        else:
            found[head] = value
    return found


def settings_of(
    kind: type[Any],
    entries: Mapping[str, Any],
    source: str = "",
    *,
    aside: Collection[str] = (),
) -> Any:
    """Return settings of a game from nested entries.

    ``robot`` and ``legs.network`` bring the gait, control and distances of
    the robot; ``gait`` and ``body`` may be names of presets, and
    ``room.plan`` a room file or the seed of a room by ``recipe``.

    Raises:
        StepAsideError: If an entry is unknown or out of its range, or if
            there is no such robot.
    """
    left, names = dict(entries), {each.name for each in fields(kind)}
    base = kind()
    if "robot" in names:
        base = _of_robots(base, left)
    for name, presets in (("gait", PRESETS), ("body", BODIES)):
        if name in names:
            base = _of_preset(base, left, name, presets)
    if "room" in names:
        _make_room(left)
    return parse_settings(kind, left, source, base=base, aside=aside)


def _of_robots(base: Any, entries: dict[str, Any]) -> Any:
    """Return settings of the robots and legs that entries name."""
    base = with_robot(base, str(entries.pop("robot", base.robot)))
    robots = {}
    for player in ("pursuer", "evader"):
        own = entries.get(f"{player}_robot")
        if isinstance(own, str) and own != NONE:
            robots[player] = str(entries.pop(f"{player}_robot"))
        elif isinstance(own, Mapping):
            robots[player] = str(own.get("robot", base.robot))
    base = with_players(base, robots) if robots else base
    legs = entries.get("legs", {})
    network = legs.get("network") if isinstance(legs, Mapping) else None
    return with_legs(base, network) if network else base


def _of_preset(
    base: Any,
    entries: dict[str, Any],
    name: str,
    presets: Mapping[str, Any],
) -> Any:
    """Return settings with the gait or body of a preset."""
    given = entries.get(name)
    changes = dict(given) if isinstance(given, Mapping) else {}
    preset = changes.pop(PRESET, given)
    if not isinstance(preset, str) or preset not in presets:
        return base
    if changes:
        entries[name] = changes
    else:
        del entries[name]
    value = presets[preset]
    if name == "body" and hasattr(base, "robot"):
        value = body_of_robot(base.robot, preset)
    elif name == "gait" and base.gait != PRESETS["nao"]:
        raise ConfigurationError(
            f"gait {preset} requires a robot with NAO's gait: its lengths and "
            f"times are NAO's, but {getattr(base, 'robot', 'it')} has its own"
        )
    return replace(base, **{name: value})


def _make_room(entries: dict[str, Any]) -> None:
    """Put a room in place of its file or its seed."""
    recipe, room = entries.pop(RECIPE, None), entries.get("room", {})
    plan = room.get("plan") if isinstance(room, Mapping) else None
    if recipe is not None and type(plan) is not int:
        got = "none" if plan is None else f"{plan}"
        raise ConfigurationError(
            f"{RECIPE} requires the seed of a random room as room.plan, got "
            f"{got}"
        )
    made: Room | None = None
    if type(plan) is int:
        made = generate_room(read_entries(RoomRecipe, recipe or {}), plan)
    elif isinstance(plan, str) and plan != NONE:
        made = load_room(plan)
    if made is not None:
        entries["room"] = {**room, "plan": made}
