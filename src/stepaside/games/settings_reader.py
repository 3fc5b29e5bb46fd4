"""Settings from entries of files, studies and commands.

The robot, its legs, and the presets of gait and body that the entries name
are read first; all other entries change these.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, TypeVar

import tomli_w

from .. import arena
from ..arena import Room, RoomRecipe, load_room
from ..core.entries import load_entries, read_entries, to_entries
from ..core.errors import AnyPath, ConfigurationError, as_path, shown
from ..core.ranges import Range
from ..core.setting import NONE, Entry, entries_of
from ..planning import PRESETS
from ..robots.description import load_robot
from ..sim.body_settings import BODIES
from .game_settings import (
    NOT_PLAYERS,
    OF_ALL,
    GameSettings,
    duel,
    walk,
)
from .player_settings import (
    EVADER,
    MOST_PLAYERS,
    USED_BY,
    PlayerSettings,
    RobotSettings,
)
from .robot_settings import (
    LEGS_GAIT,
    body_of_robot,
    settings_from_description,
)

R = TypeVar("R", bound=RobotSettings)
PRESET = ""  # name of a preset among the entries that change it
STARTED_FROM = {"duel": duel, "walk": walk}  # what a file changes
ROBOTS = "robots"  # folder of descriptions and networks in a run folder
COUNT = Range(1, MOST_PLAYERS, "1", "players of a game", whole=True)
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
    base: Any = None,
) -> Any:
    """Return settings from nested entries.

    ``robot`` and ``legs.network`` bring gait and control of the robot, and
    ``gait`` may be the name of a preset.
    """
    left = dict(entries)
    base = kind() if base is None else base
    if isinstance(base, RobotSettings):
        if isinstance(left.get("robot"), str):
            base = _with_robot(base, left["robot"])
        legs = left.get("legs", {})
        if isinstance(legs, Mapping) and legs.get("network"):
            base = replace(base, gait=replace(base.gait, **LEGS_GAIT))
    if hasattr(base, "gait") and (preset := _preset(left, "gait", PRESETS)):
        robot = getattr(base, "robot", "nao")
        brought = settings_from_description(load_robot(robot)).gait
        if brought != PRESETS["nao"]:
            raise ConfigurationError(
                f"gait {preset} requires a robot with NAO's gait: its lengths "
                f"and times are NAO's, but {robot} has its own"
            )
        base = replace(base, gait=PRESETS[preset])
    return read_entries(kind, left, source, base=base)


def _with_robot(base: R, robot: str) -> R:
    """Return settings with gait, control, legs and radius of a robot."""
    own = settings_from_description(load_robot(robot))
    control, radius = own.control, own.evasion.safety_radius
    if not control.feedback:  # the robot needs none, but a body may
        control = replace(control, method=None, feedback=None)
    return replace(
        base,
        robot=robot,
        gait=own.gait,
        control=control,
        legs=own.legs,
        evasion=replace(base.evasion, safety_radius=radius),
    )


def _preset(
    entries: dict[str, Any], name: str, presets: Mapping[str, Any]
) -> str:
    """Return the preset that an entry names, which leaves its changes."""
    given = entries.get(name)
    changes = dict(given) if isinstance(given, Mapping) else {}
    preset = changes.pop(PRESET, given)
    if not isinstance(preset, str) or preset not in presets:
        return ""
    entries[name] = changes
    return preset


def load_game(path: AnyPath, **changes: Any) -> GameSettings:
    """Read a TOML file of a game, with changes of its entries.

    Raises:
        StepAsideError: If the file is not TOML, an entry is unknown or
            invalid, or a robot does not exist.
    """
    made = read_game(load_settings(path), str(path))
    return read_game(nested(changes), base=made) if changes else made


def read_game(
    entries: Mapping[str, Any],
    source: str = "",
    *,
    base: GameSettings | None = None,
) -> GameSettings:
    """Turn nested entries into the settings of a game.

    Entries of ``[[players]]`` change what the robot of the player brings.
    Entries that only players have, like ``gait``, hold for all that use them
    and do not have their own, and a table named like a player changes this
    player. ``body`` may be the name of a preset, and ``room`` a room file or
    the seed of a room by ``recipe``. The source is for messages, and the
    base is the game that the entries change.
    """
    left, before = dict(entries), source and f"{source}, "
    if base is None and entries.get("game") in STARTED_FROM:
        base = STARTED_FROM[entries["game"]]()
    own = {p.name: p for p in base.players} if base else {}
    tables = [(before + name, name, dict[str, Any]()) for name in own]
    if (listed := left.pop("players", None)) is not None:
        if not isinstance(listed, list):
            raise ConfigurationError(
                f"{before}players must be tables [[players]], got "
                f"{shown(listed)}"
            )
        tables = [
            (f"{before}player {number}, {each['name']}", each["name"], each)
            for number, entry in enumerate(listed, start=1)
            for each in _copies(entry, f"{before}player {number}")
        ]
    shared = {k: left.pop(k) for k in OF_ALL if k in left}
    changes = []
    for place, name, entry in tables:
        player = own.get(name) or PlayerSettings(name)
        mine = nested({} if name in NOT_PLAYERS else left.pop(name, {}), entry)
        used = USED_BY.get(mine.get("body", player.body), set(OF_ALL))
        common = {k: v for k, v in shared.items() if k in used}
        where = place if mine else source
        changes.append((where, player, nested(mine, common), mine))
    if base is not None:
        base = _with_distances(base, changes)
    made = tuple(_player(*each) for each in changes)
    if base is None:
        base = GameSettings(players=made)
    robots = [player.robot for player in made if player.body == "robot"]
    preset = _preset(left, "body", BODIES)
    if preset:
        body = body_of_robot((robots or ["nao"])[0], preset)
        base = replace(base, body=body)
    _make_room(left)
    if made != base.players:
        left["players"] = made
    return read_entries(GameSettings, left, source, base=base)


def _copies(entry: Any, source: str) -> list[dict[str, Any]]:
    """Return an entry for each of ``count`` players alike, numbered."""
    if not isinstance(entry, dict):
        raise ConfigurationError(f"{source} must be a table, got {entry!r}")
    rest = dict(entry)
    if not isinstance(rest.get("name"), str):
        raise ConfigurationError(
            f"{source} must have a name, got {rest.get('name')!r}"
        )
    if "count" not in rest:
        return [rest]
    count = rest.pop("count")
    COUNT.check(count, f"{source}: count")
    if count > 1 and "start" in rest:
        raise ConfigurationError(
            f"{source}: start must be omitted with count {count}, or all "
            "would start at one place"
        )
    return [
        rest | {"name": f"{rest['name']}-{number}"}
        for number in range(1, count + 1)
    ]


def _with_distances(base: GameSettings, changes: list[Any]) -> GameSettings:
    """Return a duel with the distances of the robots that entries name."""
    robots = {
        player.name: {"robot": entries["robot"]}
        for _, player, entries, _ in changes
        if isinstance(entries.get("robot"), str)
    }
    if base.game != "duel" or not robots:
        return base
    games = [
        load_robot(p.robot).game
        for p in base.changed(**robots).players
        if p.body == "robot"
    ]
    radius = max(game.safety_radius for game in games)
    for at, (where, player, entries, mine) in enumerate(changes):
        if player.name == EVADER:
            own = {"evasion": {"safety_radius": radius}}
            changes[at] = where, player, nested(entries, own), mine
    start = replace(
        base.start,
        least=max(game.start_least for game in games),
        near=max(game.start_near for game in games),
        far=max(game.start_far for game in games),
    )
    return replace(base, start=start)


def _player(
    source: str,
    base: PlayerSettings,
    entries: Mapping[str, Any],
    mine: Mapping[str, Any],
) -> PlayerSettings:
    """Return the settings of one player; those of its own must have effect."""
    player: PlayerSettings
    player = settings_of(PlayerSettings, entries, source, base=base)
    for key in mine.keys() - USED_BY[player.body]:
        if getattr(player, key) != getattr(base, key):
            raise ConfigurationError(
                f"{source}: {key} must be omitted with body {player.body!r}, "
                "as it has no effect"
            )
    return player


def entries_of_game(base: GameSettings) -> dict[str, Entry]:
    """Return every setting of a game and its players by its path."""
    game, own = entries_of(GameSettings), entries_of(PlayerSettings)
    common = {k: v for k, v in own.items() if k.partition(".")[0] in OF_ALL}
    found = {k: v for k, v in game.items() if k != "players"} | common
    for name in base.names:
        if name not in NOT_PLAYERS:
            found |= entries_of(PlayerSettings, name)
    return found | entries_of(RoomRecipe, RECIPE)


def _make_room(entries: dict[str, Any]) -> None:
    """Put a room in place of its file or its seed."""
    recipe, plan = entries.pop(RECIPE, None), entries.get("room")
    if recipe is not None and type(plan) is not int:
        got = "none" if plan is None else f"{plan}"
        raise ConfigurationError(
            f"{RECIPE} requires the seed of a random room as room, got {got}"
        )
    made: Room | None = None
    if type(plan) is int:
        made = arena.generate_room(
            read_entries(RoomRecipe, recipe or {}), plan
        )
    elif isinstance(plan, str) and plan != NONE:
        made = load_room(plan)
    if made is not None:
        entries["room"] = made


def load_settings(path: AnyPath) -> dict[str, Any]:
    """Read the entries of a file, with robots and networks beside it."""
    file = as_path(path, "path")
    entries = load_entries(file)

    def found(value: str) -> str:
        inside = value.startswith(f"{ROBOTS}/") and ".." not in value
        there = file.parent.resolve() / value
        return str(there) if inside and there.exists() else value

    replace_files(entries, found)
    return entries


def replace_files(entries: Any, change: Callable[[str], str]) -> None:
    """Replace the names of robots and networks in nested entries."""
    if isinstance(entries, list):
        for each in entries:
            replace_files(each, change)
    elif isinstance(entries, dict):
        for key, value in entries.items():
            if key in ("robot", "network") and isinstance(value, str):
                entries[key] = change(value)
            else:
                replace_files(value, change)


def dump_configuration(settings: Any) -> str:
    """Return the TOML text from which the same settings are read."""
    return tomli_w.dumps(settings_entries(settings))


def settings_entries(settings: Any) -> dict[str, Any]:
    """Return settings as the nested entries of a configuration file.

    What they leave open is resolved.
    """
    if hasattr(settings, "resolved"):
        settings = settings.resolved()
    entries: dict[str, Any] = to_entries(settings)
    return entries
