"""``stepaside robot init``: a description from a published model."""

from pathlib import Path
from typing import Any

import click

from ..core.atomic_output import check_file, check_folder, writing
from ..core.errors import StepAsideError
from .options.common_options import FOLDER, json_option
from .output_files import OVERWRITE
from .terminal import echo
from .value_types import print_json, print_table


@click.command("init")
@click.argument(
    "model", type=click.Path(exists=True, dir_okay=False, path_type=Path)
)
@FOLDER.option(
    help="Folder for the description; a new one beside the work by default, "
    "named after the model."
)
@click.option(
    "--meshes",
    multiple=True,
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="Folder in which mesh files are looked for, any number of times; "
    "beside the model by default.",
)
@OVERWRITE.option(default=False)
@json_option
def init(
    model: Path,
    output: Path | None,
    meshes: tuple[Path, ...],
    overwrite: bool,
    as_json: bool,
) -> None:
    """Describe the humanoid whose published MODEL (MJCF or URDF) is given.

    Derives legs, soles, servos, posture, gait and distances, and writes
    them with where each comes from. The model is only read, never changed
    or copied. What the model does not tell is asked for in the file: search
    it for ASK.
    """
    from ..fitting.derivation import derive
    from ..fitting.description_writer import write_description
    from ..fitting.model_report import facts_of
    from ..robots.description import FILE, load_robot

    folder = output or Path(model.stem)
    file = folder / FILE
    if folder.is_dir():
        check_file(file, "output", overwrite=overwrite)
    else:
        check_folder(folder, "output", new=True)
    derived = derive(model, folder, list(meshes))
    facts = facts_of(derived) | {"folder": str(folder), "file": str(file)}
    failed: Exception | None = None
    try:
        with writing(file) as draft:
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
        echo(f"\nwrote {file}; now: stepaside robot check {folder}")


def _print(facts: dict[str, Any]) -> None:
    asked = facts["asked_for"]
    low, high = facts["com_heights_m"]
    rows = [
        ("robot", f"{facts['name']}, {facts['mass_kg']:.1f} kg"),
        ("legs", f"{facts['leg_length_m']:.3f} m from hip to sole"),
        ("joints of a leg", ", ".join(facts["legs"][0])),
        ("CoM height", f"{facts['com_height_m']:.3f} m of {low} to {high} m"),
        ("foot spacing", f"{facts['foot_spacing_m']:.3f} m"),
        (
            "sole",
            ", ".join(f"{k} {v:g}" for k, v in facts["sole_m"].items()) + " m",
        ),
        ("stride", f"{facts['gait']['stride']:g} m"),
        (
            "supports",
            f"{facts['gait']['single_support']:g} s on one foot, "
            f"{facts['gait']['double_support']:g} s on both",
        ),
        ("safety radius", f"{facts['game']['safety_radius']:g} m"),
        ("head", _head(facts["head"])),
        ("meshes left out", str(facts["left_out_meshes"])),
        ("asked for", _asked(asked)),
    ]
    print_table(rows)


def _head(head: dict[str, Any]) -> str:
    joints = [name for name in (head["yaw"], head["pitch"]) if name]
    cameras = ", ".join(head["cameras"]) or "none"
    return f"turned by {', '.join(joints) or 'nothing'}, cameras {cameras}"


def _asked(asked: dict[str, Any]) -> str:
    words = ["the sole"] if asked["sole"] else []
    if asked["torques"]:
        words.append(f"torques of {len(asked['torques'])} joints")
    if asked["speed_limits"]:
        words.append(f"speed limits of {len(asked['speed_limits'])} joints")
    return ", ".join(words) or "nothing"
