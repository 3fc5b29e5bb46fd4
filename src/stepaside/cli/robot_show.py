"""``stepaside robot show``: properties of a robot, or its MuJoCo model."""

import click

from .options import json_option
from .tables import print_table, table_rows
from .terminal import echo, print_json, write_result


@click.command("show")
@click.argument("name", default="nao")
@click.option("--mjcf", is_flag=True, help="Print the MuJoCo model only.")
@click.option(
    "--compile",
    "stores",
    is_flag=True,
    help="Store the kinematic tree next to the description, so that the robot "
    "can be controlled without MuJoCo.",
)
@json_option
def show(name: str, mjcf: bool, stores: bool, as_json: bool) -> None:
    """Show the robot NAME, or print its MuJoCo model.

    NAME is a built-in robot (nao) or a folder with a robot.toml and a model.
    """
    from ..robots.description import load_robot

    description = load_robot(name)
    if mjcf:
        write_result(description.mjcf() + "\n")
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
