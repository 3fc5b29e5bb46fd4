"""``stepaside serve``: simulated robots for external controllers."""

import gc
from collections.abc import Sequence
from contextlib import closing
from pathlib import Path

import click

from ..core.ranges import positive
from ..games.game_settings import GameSettings
from ..games.game_settings import duel as make_duel
from ..games.player_settings import PLAYERS
from .options import folder_option
from .robot_connections import join_domain, with_feedback
from .run_output import finish_run, run_folder
from .settings import takes_settings
from .terminal import json_option

NAMED = ("seed", "duration", "robot", "start.distance")


@click.command("serve")
@takes_settings(NAMED, make_duel())
@click.option(
    "--ros2",
    multiple=True,
    required=True,
    metavar="PLAYER=/NAMESPACE",
    help="Serve a player's robot with its own walking controller.",
)
@click.option(
    "--domain",
    type=click.IntRange(0, 232),
    help="ROS 2 domain; ROS_DOMAIN_ID by default, or 0 if that is not set.",
)
@click.option(
    "--network",
    is_flag=True,
    help="Make the ROS 2 topics visible to other machines.",
)
@click.option(
    "--sight",
    type=click.Choice(("ideal", "none")),
    default="ideal",
    show_default=True,
    help="Serve the true line of sight along with each robot, or nothing.",
)
@click.option(
    "--lockstep",
    is_flag=True,
    help="Wait for every command instead of running in real time.",
)
@click.option(
    "--wait",
    type=float,
    default=60.0,
    show_default=True,
    help="Maximum time to wait until all clients are ready [s].",
)
@folder_option(help="Run folder; the run is not saved by default.")
@json_option
def serve(
    settings: GameSettings,
    ros2: tuple[str, ...],
    domain: int | None,
    network: bool,
    sight: str,
    lockstep: bool,
    wait: float,
    output: Path | None,
    as_json: bool,
) -> None:
    """Serve simulated robots on ROS 2 topics, and play a duel.

    A player that is not served is controlled by this process. The simulation
    starts when every served robot has a client that commands it.
    """
    namespaces = _namespaces(ros2)
    positive("s").check(wait, "wait")
    if settings.level != "physics":
        raise click.UsageError(
            f"level must be physics, got {settings.level!r}"
        )
    for name in namespaces:
        if name not in settings.robots:
            raise click.UsageError(
                f"--ros2 must name robots, got {name}, a person"
            )
    folder = run_folder(output, as_json, None)
    from ..games.served_duel import serve_duel

    with closing(join_domain(domain, network=network)) as dds:
        gc.collect()
        gc.freeze()
        feedback = {
            name: {"control": with_feedback(settings.player(name).control)}
            for name in settings.robots
        }
        run, timing = serve_duel(
            settings.changed(**feedback),
            dds,
            namespaces,
            ideal_sight=sight == "ideal",
            lock_step=lockstep,
            patience=wait,
        )
    finish_run(run, folder, as_json, timing)


def _namespaces(texts: Sequence[str]) -> dict[str, str]:
    """Parse namespaces by player; each may be served once."""
    from ..drivers.ros2_dds import parse_namespace

    found = dict[str, str]()
    for text in texts:
        name, _, place = text.partition("=")
        if name not in PLAYERS or name in found or not place:
            raise click.UsageError(
                f"--ros2 must be {' or '.join(PLAYERS)}=/NAMESPACE, each "
                f"player once, got {text!r}"
            )
        found[name] = parse_namespace(place)
    return found
