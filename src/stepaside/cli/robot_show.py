"""``stepaside robot show``: properties of a robot, or its MuJoCo model."""

from pathlib import Path

import click

from ..core.atomic_output import atomic_draft
from .options.common_options import json_option
from .options.parameter_types import OutputFile
from .output_files import writes_files
from .tables import print_table, table_rows
from .terminal import echo, print_json


@click.command("show")
@click.argument("name", default="nao")
@click.option(
    "--mjcf/--no-mjcf",
    default=False,
    help="Write the MuJoCo model (MJCF) only.",
)
@click.option(
    "--output",
    type=OutputFile(),
    help="File for the model; standard output by default.",
)
@click.option(
    "--compile/--no-compile",
    "stores",
    default=False,
    help="Store the kinematic tree next to the description, so that the robot "
    "can be controlled without MuJoCo.",
)
@json_option
@writes_files
def show(
    name: str, mjcf: bool, output: str | None, stores: bool, as_json: bool
) -> None:
    """Show the robot NAME, or write its MuJoCo model.

    NAME is a built-in robot (nao) or a folder with a robot.toml and a model.
    """
    from ..robots.description import load_robot

    description = load_robot(name)
    if mjcf or output is not None:
        text = description.mjcf()
        if output is None:
            echo(text)
        else:
            with atomic_draft(Path(output)) as draft:
                draft.write_text(text, encoding="utf-8")
            echo(f"wrote {output}", err=True)
        return
    if stores:
        from ..robots.tree_cache import store_tree

        echo(f"wrote {store_tree(description)}", err=True)
        return
    model = description.compile()
    facts = {
        "name": description.name,
        "mass_kg": round(float(model.body_subtreemass[0]), 6),
        "links": int(model.nbody - 1),
        "hinges": int(model.njnt - 1),
        "motors": int(model.nu),
        "coupled": description.coupled_joints(model),
        "folder": str(description.folder),
    }
    if as_json:
        print_json(facts)
    else:
        print_table(table_rows(facts, facts))
