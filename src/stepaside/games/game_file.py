"""Game files: the players of a game and its rules, as TOML."""

from dataclasses import replace
from typing import Any

from ..core.errors import AnyPath, ConfigurationError, as_path, shown
from ..robots.description import load_robot
from .configuration_file import load_settings, parse_settings
from .game_settings import GameSettings, PlayerSettings
from .player_names import MOST_PLAYERS
from .robot_settings import (
    game_settings_from_description,
    settings_of_robot,
    with_legs,
)
from .settings_reader import nested

ALWAYS = {"name", "role", "team", "body", "target", "start"}
OF_TEMPLATE = {
    *("robot", "gait", "strategy", "evasion", "shield", "goal", "draws_goal")
}
USED_BY = {  # entries of a player that its kind of body uses
    "robot": ALWAYS | OF_TEMPLATE | {"control", "legs", "senses", "sight"},
    "unicycle": ALWAYS | OF_TEMPLATE,
    "person": ALWAYS | {"goal", "draws_goal", "person", "crowd"},
    "run": ALWAYS | {"run", "run_player"},
}


def load_game(path: AnyPath, **changes: Any) -> GameSettings:
    """Read a game file.

    Gait, control and legs of each player are those of its robot, changed by
    the entries of the file.

    Raises:
        StepAsideError: If the file is not TOML, an entry is unknown or
            invalid, or a robot does not exist.
    """
    file = as_path(path, "path")
    entries = nested(changes, load_settings(file))
    return parse_game(entries, str(file))


def parse_game(entries: dict[str, Any], source: str) -> GameSettings:
    """Turn the nested entries of a game file into settings.

    Raises:
        StepAsideError: As :func:`load_game`.
    """
    listed = entries.get("players", [])
    if not isinstance(listed, list):
        raise ConfigurationError(
            f"{source}: players must be tables [[players]], got "
            f"{shown(listed)}"
        )
    players = [
        _player(each, f"{source}, player {number}")
        for number, entry in enumerate(listed, start=1)
        for each in _copies(entry, f"{source}, player {number}")
    ]
    return parse_settings(GameSettings, entries | {"players": players}, source)


def _copies(entry: Any, source: str) -> list[Any]:
    """Return an entry for each of ``count`` players alike, numbered."""
    if not isinstance(entry, dict) or "count" not in entry:
        return [entry]
    rest = {name: value for name, value in entry.items() if name != "count"}
    count = entry["count"]
    if type(count) is not int or not 1 <= count <= MOST_PLAYERS:
        raise ConfigurationError(
            f"{source}: count must be a whole number from 1 to "
            f"{MOST_PLAYERS}, got {shown(count)}"
        )
    if count > 1 and "start" in rest:
        raise ConfigurationError(
            f"{source}: start must be omitted with count {count}, or all "
            "would start at one place"
        )
    return [
        rest | {"name": f"{rest.get('name')}-{number}"}
        for number in range(1, count + 1)
    ]


def _player(entry: Any, source: str) -> PlayerSettings:
    """Return the settings of one player over those of its robot."""
    if not isinstance(entry, dict):
        raise ConfigurationError(f"{source} must be a table, got {entry!r}")
    name = entry.get("name")
    if not isinstance(name, str):
        raise ConfigurationError(f"{source} must have a name, got {name!r}")
    base = PlayerSettings(name)
    robot = entry.get("robot", base.robot)
    if isinstance(robot, str):
        own = settings_of_robot(robot)
        base = replace(
            base,
            robot=robot,
            gait=own.gait,
            control=own.control,
            legs=own.legs,
        )
        game = game_settings_from_description(load_robot(robot))
        if game is not None:
            evasion = replace(base.evasion, safety_radius=game.safety_radius)
            base = replace(base, evasion=evasion)
    legs = entry.get("legs")
    network = legs.get("network") if isinstance(legs, dict) else None
    if isinstance(network, str) and network:
        base = with_legs(base, network)
    source = f"{source}, {name}"
    player = parse_settings(PlayerSettings, entry, source, base=base)
    for key in entry.keys() - USED_BY[player.body]:
        if getattr(player, key) != getattr(base, key):
            raise ConfigurationError(
                f"{source}: {key} must be omitted with body {player.body!r}, "
                "as it has no effect"
            )
    return player
