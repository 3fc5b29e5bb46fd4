"""``stepaside robot init``: description of a new robot from its model."""

from pathlib import Path

import click

from ..core.atomic_output import atomic_draft, check_file, check_folder
from ..core.errors import StepAsideError
from .options import folder_option, json_option
from .tables import print_table, result_rows
from .terminal import echo, print_json


@click.command("init")
@click.argument(
    "model", type=click.Path(exists=True, dir_okay=False, path_type=Path)
)
@folder_option(
    help="Folder for the description; a new folder with the name of the "
    "model by default."
)
@click.option(
    "--meshes",
    multiple=True,
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="Folder with mesh files; repeatable. The folder of the model by "
    "default.",
)
@click.option(
    "--overwrite", is_flag=True, help="Replace the description in the folder."
)
@json_option
def init(
    model: Path,
    output: Path | None,
    meshes: tuple[Path, ...],
    overwrite: bool,
    as_json: bool,
) -> None:
    """Derive a robot description from a published MODEL (MJCF or URDF).

    Derives legs, soles, servos, posture, gait and distances, and writes each
    value with its source. The model is neither changed nor copied. Values
    that the model does not contain are marked ASK in the description: search
    for it and fill them in.
    """
    from ..fitting.derivation import derive, report_of
    from ..fitting.description_writer import write_description
    from ..robots.description import FILE, load_robot

    folder = output or Path(model.stem)
    file = folder / FILE
    if folder.is_dir():
        check_file(file, "output", overwrite=overwrite)
    else:
        check_folder(folder, "output", new=True)
    derived = derive(model, folder, list(meshes))
    facts = report_of(derived) | {"folder": str(folder), "file": str(file)}
    failed: Exception | None = None
    try:
        with atomic_draft(file) as draft:
            draft.write_text(write_description(derived), encoding="utf-8")
        load_robot(folder)
    except (StepAsideError, OSError) as error:
        failed = error
    if as_json:
        print_json(facts)
    else:
        print_table(result_rows(facts))
    if failed is not None:
        raise failed
    if not as_json:
        echo(f"\nwrote {file}; next: stepaside robot check {folder}")
