"""Options that describe a room, as settings."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from ...arena import RoomRecipe, generate_room, load_room

RECIPE = "recipe"  # section of the options that generate a room


def with_sensing(
    given: Mapping[str, Any], *, room_in_file: bool, sensing_in_file: bool
) -> dict[str, Any]:
    """Add camera sensing if a map is to be built from camera images.

    Args:
        given: Values by path.
        room_in_file: Whether the configuration file sets a room.
        sensing_in_file: Whether the configuration file sets the sensing.
    """
    values = dict(given)
    if values.get("map.source") == "seen" and not sensing_in_file:
        if room_in_file or values.get("room.plan") is not None:
            values.setdefault("sensing", "cameras")
    return values


def with_room(given: Mapping[str, Any]) -> dict[str, Any]:
    """Replace the options that describe a room by the room itself.

    Args:
        given: Values by path.

    Raises:
        UsageError: If options generate a room but no seed is given.
        ConfigurationError: If the room cannot be generated or loaded.
    """
    recipe = {
        path.removeprefix(f"{RECIPE}."): value
        for path, value in given.items()
        if path.startswith(f"{RECIPE}.")
    }
    values = {
        path: value
        for path, value in given.items()
        if not path.startswith(f"{RECIPE}.")
    }
    source = values.get("room.plan")
    if recipe and not isinstance(source, int):
        name = next(iter(recipe)).replace("_", "-")
        room = "no --room" if source is None else f"the file {source}"
        raise click.UsageError(
            f"{RECIPE}.{name} requires a random room (--room SEED), got {room}"
        )
    if isinstance(source, int):
        size = recipe.pop("size", (3.0, 3.0)) or (None, None)
        made = RoomRecipe(width=size[0], depth=size[1], **recipe)
        values["room.plan"] = generate_room(made, source)
    elif isinstance(source, Path):
        values["room.plan"] = load_room(source)
    return values
