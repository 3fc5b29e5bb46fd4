"""``stepaside run room``: a random room, or the room of a file."""

import json
from pathlib import Path

import click

from ..arena import Room, RoomRecipe
from .options import (
    figure_option,
    file_argument,
    json_option,
    output_file,
    seed_option,
)
from .settings import refuse_settings, takes_settings
from .tables import print_table, result_rows
from .terminal import print_json

NAMED = ("width", "depth", "discs", "boxes", "polygons", "doors")


@click.command("room")
@file_argument("file", required=False)
@seed_option()
@takes_settings(NAMED, settings=RoomRecipe)
@click.option(
    "--output",
    type=output_file("--output", ".toml", ".json"),
    help="Write the room (.toml or .json).",
)
@figure_option()
@json_option
def room(
    file: Path | None,
    seed: int,
    settings: RoomRecipe,
    output: Path | None,
    figure: Path | None,
    as_json: bool,
) -> None:
    """Generate a random room with initial poses, or inspect a room FILE.

    Prints the numbers of obstacles and doors, and the narrowest gap.
    """
    from ..arena import check_initial_poses, generate_room, load_room
    from ..arena.room_generation import measure_room

    if file is None:
        made = generate_room(settings, seed)
    else:
        refuse_settings(("",), "a random room, got a room file")
        made = load_room(file)
        if made.starts is not None:
            check_initial_poses(made, made.starts)
    result = measure_room(made)
    print_json(result) if as_json else print_table(result_rows(result))
    if output is not None:
        _write(made, output)
    if figure is not None:
        from ..report.plan_view import draw_room

        draw_room(made, str(figure))


def _write(made: Room, file: Path) -> None:
    """Write a room in the format of the file suffix."""
    from ..arena import room_to_entries, room_to_toml
    from ..core.atomic_output import atomic_draft

    text = room_to_toml(made)
    if file.suffix.lower() == ".json":
        text = json.dumps(room_to_entries(made), allow_nan=False) + "\n"
    with atomic_draft(file) as draft:
        draft.write_text(text, encoding="utf-8")
