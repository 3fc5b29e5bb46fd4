"""``stepaside robot init``: description of a new robot from its model."""

from pathlib import Path
from typing import Any

import click

from ..core.atomic_output import atomic_draft, check_file, check_folder
from ..core.errors import StepAsideError
from .options import folder_option, json_option
from .tables import print_table
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
    from ..fitting.derivation import derive
    from ..fitting.description_writer import write_description
    from ..fitting.model_report import report_of
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
        _print(facts)
    if failed is not None:
        raise failed
    if not as_json:
        echo(f"\nwrote {file}; next: stepaside robot check {folder}")


def _print(facts: dict[str, Any]) -> None:
    low, high = facts["com_heights_m"]
    rows = [
        ("robot", f"{facts['name']}, {facts['mass_kg']:.1f} kg"),
        ("legs", f"{facts['leg_length_m']:.3f} m from hip to sole"),
        ("leg joints", ", ".join(facts["legs"][0])),
        (
            "CoM height",
            f"{facts['com_height_m']:.3f} m (range {low} to {high} m)",
        ),
        ("foot spacing", f"{facts['foot_spacing_m']:.3f} m"),
        (
            "sole",
            ", ".join(f"{k} {v:g}" for k, v in facts["sole_m"].items()) + " m",
        ),
        ("stride", f"{facts['gait']['stride']:g} m"),
        (
            "support durations",
            f"{facts['gait']['single_support']:g} s single, "
            f"{facts['gait']['double_support']:g} s double",
        ),
        ("safety radius", f"{facts['game']['safety_radius']:g} m"),
        ("head", _head_text(facts["head"])),
        ("omitted meshes", str(facts["omitted_meshes"])),
        ("missing values", _missing_text(facts["missing_values"])),
    ]
    print_table(rows)


def _head_text(head: dict[str, Any]) -> str:
    joints = [name for name in (head["yaw"], head["pitch"]) if name]
    cameras = ", ".join(head["cameras"]) or "none"
    return f"joints {', '.join(joints) or 'none'}, cameras {cameras}"


def _missing_text(missing: dict[str, Any]) -> str:
    names = ["sole"] if missing["sole"] else []
    if missing["torques"]:
        names.append(f"torques of {len(missing['torques'])} joints")
    if missing["speed_limits"]:
        names.append(f"speed limits of {len(missing['speed_limits'])} joints")
    return ", ".join(names) or "none"
