"""Game files: the players of a game and its rules, as TOML."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from ..core.errors import AnyPath, ConfigurationError, as_path, shown
from ..robots.description import load_robot
from .configuration_file import (
    load_entries,
    parse_settings,
    settings_entries,
)
from .game_settings import GameSettings, PlayerSettings
from .robot_settings import (
    game_settings_from_description,
    settings_of_robot,
    with_legs,
)


def load_game(path: AnyPath) -> GameSettings:
    """Read a game file.

    Gait, control and legs of each player are those of its robot, changed by
    the entries of the file.

    Args:
        path: TOML file.

    Returns:
        The settings.

    Raises:
        StepAsideError: If the file is not TOML, an entry is unknown or
            invalid, or a robot does not exist.
    """
    file = as_path(path, "path")
    return parse_game(load_entries(Path(file)), str(file))


def parse_game(entries: dict[str, Any], source: str) -> GameSettings:
    """Turn the nested entries of a game file into settings.

    Args:
        entries: Sections and values.
        source: Where they come from, for messages.

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
        settings_entries(_player(entry, f"{source}, player {number}"))
        for number, entry in enumerate(listed, start=1)
    ]
    return parse_settings(GameSettings, entries | {"players": players}, source)


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
    return parse_settings(PlayerSettings, entry, source, base=base)
