"""Options of rooms: what a seed makes, and what robots know of it."""

from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from ..value_types import METERS
from .arena_options import BOXES, COUNT, DISCS, POLYGONS, SIZE
from .declaration import OptionDeclaration, OptionGroup

RECIPE = "recipe."  # where the options that make a room put their values
PLAN = "room.plan"


class RoomType(click.ParamType[int | Path]):
    """The seed of a room, or a file with one."""

    name = "FILE|SEED"

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> int | Path:
        """Take digits for a seed, and anything else for a file."""
        if isinstance(value, int | Path):
            return value
        if str(value).isdecimal():
            return int(value)
        if not Path(value).is_file():
            self.fail(
                f"must be a whole number >= 0 or a file, got {value!r:.60}",
                param,
                ctx,
            )
        return Path(value)


DOORS = OptionDeclaration("--doors", "Doors in its walls.", kind=COUNT)
SMALLEST = OptionDeclaration(
    "--smallest", "Least radius of an obstacle [m].", kind=METERS
)
LARGEST = OptionDeclaration(
    "--largest", "Largest radius of an obstacle [m].", kind=METERS
)
DOOR_WIDTH = OptionDeclaration(
    "--door-width", "Width of a door [m].", kind=METERS
)


def _of_recipe(declaration: OptionDeclaration, name: str) -> OptionDeclaration:
    """An option that makes a room, in a command whose settings hold it."""
    entry = name.removeprefix("--").replace("-", "_")
    path = RECIPE + entry.removeprefix("room_")
    return replace(declaration, name=name, path=path, tells_default=False)


ROOM = OptionDeclaration(
    "--room",
    "The room of a seed, or of a file; an open floor by default.",
    PLAN,
    kind=RoomType(),
    tells_default=False,
)


def _maps() -> Collection[str]:
    from ...control.clearance.map_settings import MAPS

    return MAPS


def _unseen() -> Collection[str]:
    from ...control.clearance.map_settings import UNSEEN

    return UNSEEN


MAP = OptionDeclaration(
    "--map",
    "What they know of it: all of it and their own true pose in it, with "
    "cameras as well (given); what their depth cameras have seen, by odometry "
    "(seen; with --sensing cameras, unless that is given); or nothing.",
    "map.source",
    registry=_maps,
)
MARGIN = OptionDeclaration(
    "--map-margin", "Distance that bodies keep from it", "map.margin", "m"
)
UNSEEN_FLOOR = OptionDeclaration(
    "--unseen",
    "Whether floor that nobody has seen counts as free.",
    "map.unseen",
    registry=_unseen,
)
PLAYED_IN = OptionGroup(
    "Room that they play in",
    (
        ROOM,
        _of_recipe(SIZE, "--room-size"),
        *(
            _of_recipe(option, option.name)
            for option in (
                *(DISCS, BOXES, POLYGONS, DOORS),
                *(SMALLEST, LARGEST, DOOR_WIDTH),
            )
        ),
        MAP,
        MARGIN,
        UNSEEN_FLOOR,
    ),
)


def with_room(given: Mapping[str, Any]) -> dict[str, Any]:
    """Values with the room that others describe.

    Args:
        given: Values by path.

    Raises:
        ConfigurationError: If there is no such room.
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
        beside = "none" if source is None else f"the file {source}"
        raise click.UsageError(
            f"{option} makes a room of a seed, so it must stand beside "
            f"--room SEED, got {beside}"
        )
    if isinstance(source, int):
        from ...arena import RoomRecipe, make_room

        size = recipe.pop("size", (3.0, 3.0)) or (None, None)
        made = RoomRecipe(width=size[0], depth=size[1], **recipe)
        values[PLAN] = make_room(made, source)
    elif isinstance(source, Path):
        from ...arena import load_room

        values[PLAN] = load_room(source)
    return values
