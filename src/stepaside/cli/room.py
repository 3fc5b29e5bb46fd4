"""``stepaside room``: generation of random rooms, and metrics of a room."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from ..arena import RoomRecipe
from .options.common_options import (
    figure_option,
    json_option,
    seed_option,
)
from .options.parameter_types import OutputFile, SizeType
from .options.settings_options import refuse_options, takes
from .output_files import attempt, writes_files
from .tables import print_table, scalar_rows
from .terminal import print_json

OF_RECIPE = {
    f"--{name.replace('_', '-')}": name
    for name in (
        *("discs", "boxes", "polygons", "doors"),
        *("smallest", "largest", "door_width"),
    )
}


@click.command("room")
@click.argument(
    "file",
    required=False,
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
)
@seed_option(default=1, show_default=True)
@click.option(
    "--size",
    type=SizeType(),
    default="3x3",
    show_default=True,
    help="Width and depth of the room [m]; open for a floor without walls.",
)
@takes(RoomRecipe, "recipe", OF_RECIPE)
@click.option(
    "--output",
    type=OutputFile(".toml", ".json"),
    help="Write the room (.toml or .json).",
)
@figure_option()
@json_option
@writes_files
def room(
    file: Path | None,
    seed: int,
    size: tuple[float, float] | None,
    output: str | None,
    figure: str | None,
    as_json: bool,
    recipe: RoomRecipe,
) -> None:
    """Generate a random room with initial poses, or inspect a room FILE.

    Prints free floor, obstacles and clearances of the room.
    """
    from ..arena import check_initial_poses, generate_room, load_room
    from ..arena.free_space import measure_room

    if file is None:
        width, depth = size or (None, None)
        recipe = replace(recipe, width=width, depth=depth)
        made = generate_room(recipe, seed)
    else:
        _refuse_both()
        made = load_room(file)
        if made.starts is not None:
            check_initial_poses(made, made.starts)
    result = measure_room(made)
    if output is not None and attempt(lambda: _write(made, Path(output))):
        result["output"] = output
    if figure is not None:
        from ..report.plan_view import draw_room

        if attempt(lambda: draw_room(made, figure)):
            result["figure"] = figure
    if as_json:
        print_json(result)
        return
    print_table(scalar_rows(result, 4))


def _refuse_both() -> None:
    """Refuse options that generate a room if a file is given."""
    own = {"file", "output", "figure", "as_json", "overwrite"}
    params = click.get_current_context().command.params
    refuse_options(
        {param.name or "" for param in params} - own,
        "a random room, got a room file",
    )


def _write(made: Any, file: Path) -> None:
    """Write a room in the format of the file suffix."""
    import json

    from ..arena import room_to_entries, room_to_toml
    from ..core.atomic_output import atomic_draft

    text = room_to_toml(made)
    if file.suffix.lower() == ".json":
        text = json.dumps(room_to_entries(made), allow_nan=False) + "\n"
    with atomic_draft(file) as draft:
        draft.write_text(text, encoding="utf-8")
