"""Options for the room of a game and the map that robots have of it."""

from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from ..value_types import METERS
from .arena_options import BOXES, COUNT, DISCS, POLYGONS, SIZE
from .declaration import OptionDeclaration, OptionGroup

RECIPE = "recipe."  # prefix of paths of options that generate a room
PLAN = "room.plan"


class RoomType(click.ParamType[int | Path]):
    """Seed of a random room, or room file."""

    name = "FILE|SEED"

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> int | Path:
        """Return the seed if there are only digits, else the path."""
        if isinstance(value, int | Path):
            return value
        if str(value).isdecimal():
            return int(value)
        if not Path(value).is_file():
            self.fail(
                "must be an integer >= 0 or an existing file, got "
                f"{value!r:.60}",
                param,
                ctx,
            )
        return Path(value)


DOORS = OptionDeclaration(
    "--doors", "Number of doors in the walls.", kind=COUNT
)
SMALLEST = OptionDeclaration(
    "--smallest", "Minimum radius of an obstacle [m].", kind=METERS
)
LARGEST = OptionDeclaration(
    "--largest", "Maximum radius of an obstacle [m].", kind=METERS
)
DOOR_WIDTH = OptionDeclaration(
    "--door-width", "Width of a door [m].", kind=METERS
)


def _of_recipe(declaration: OptionDeclaration, name: str) -> OptionDeclaration:
    """Return an option that generates a room within other settings."""
    entry = name.removeprefix("--").replace("-", "_")
    path = RECIPE + entry.removeprefix("room_")
    return replace(declaration, name=name, path=path, shows_default=False)


ROOM = OptionDeclaration(
    "--room",
    "Seed of a random room, or room file; an open floor by default.",
    PLAN,
    kind=RoomType(),
    shows_default=False,
)


def _maps() -> Collection[str]:
    from ...control.clearance.map_settings import MAPS

    return MAPS


def _unknown_states() -> Collection[str]:
    from ...control.clearance.map_settings import UNSEEN

    return UNSEEN


MAP = OptionDeclaration(
    "--map",
    "Map of the room that each robot has: the true map with its true pose "
    "(given), a map built from its depth camera and odometry (seen; implies "
    "--sensing cameras), or none.",
    "map.source",
    registry=_maps,
)
MARGIN = OptionDeclaration(
    "--map-margin",
    "Clearance that robots keep from obstacles",
    "map.margin",
    "m",
)
UNKNOWN_CELLS = OptionDeclaration(
    "--unseen",
    "State of map cells that have not been observed.",
    "map.unseen",
    registry=_unknown_states,
)
ROOM_GROUP = OptionGroup(
    "Room",
    (
        ROOM,
        _of_recipe(SIZE, "--room-size"),
        *(
            _of_recipe(option, option.name)
            for option in (
                DISCS,
                BOXES,
                POLYGONS,
                DOORS,
                SMALLEST,
                LARGEST,
                DOOR_WIDTH,
            )
        ),
        MAP,
        MARGIN,
        UNKNOWN_CELLS,
    ),
)


def with_room(given: Mapping[str, Any]) -> dict[str, Any]:
    """Replace the options that describe a room by the room itself.

    Args:
        given: Values by path.

    Raises:
        UsageError: If options generate a room but no seed is given.
        ConfigurationError: If the room cannot be generated or loaded.
    """
    recipe = {
        path.removeprefix(RECIPE): value
        for path, value in given.items()
        if path.startswith(RECIPE)
    }
    values = {k: v for k, v in given.items() if not k.startswith(RECIPE)}
    source = values.get(PLAN)
    if recipe and not isinstance(source, int):
        name = next(iter(recipe)).replace("_", "-")
        option = "--room-size" if name == "size" else f"--{name}"
        room = "no --room" if source is None else f"the file {source}"
        raise click.UsageError(
            f"{option} requires a random room (--room SEED), got {room}"
        )
    if isinstance(source, int):
        from ...arena import RoomRecipe, generate_room

        size = recipe.pop("size", (3.0, 3.0)) or (None, None)
        made = RoomRecipe(width=size[0], depth=size[1], **recipe)
        values[PLAN] = generate_room(made, source)
    elif isinstance(source, Path):
        from ...arena import load_room

        values[PLAN] = load_room(source)
    return values
