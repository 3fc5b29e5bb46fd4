"""``stepaside serve``: simulated robots for external controllers."""

from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from ..games.duel_settings import DuelSettings
from .connection_settings import with_feedback
from .options.common_options import (
    domain_option,
    folder_option,
    json_option,
    network_option,
)
from .options.parameter_types import SECONDS, NameType
from .options.settings_options import DUEL, refuse_options, takes_settings
from .run_output import check_run_folder, save_run
from .tables import format_value, print_table, table_rows
from .terminal import print_json

SIGHTS = ("ideal", "none")


@click.command("serve")
@takes_settings(DuelSettings, DUEL)
@click.option(
    "--lola",
    "lola",
    multiple=True,
    metavar="PLAYER=PATH",
    help="Serve the joints of a player's robot over LoLA, at the path of a "
    "socket.",
)
@click.option(
    "--ros2",
    "ros2",
    multiple=True,
    metavar="PLAYER=/NAMESPACE",
    help="Serve a player's robot with its own walking controller over ROS 2 "
    "topics.",
)
@domain_option()
@network_option()
@click.option(
    "--sight",
    type=NameType(lambda: SIGHTS),
    default=SIGHTS[0],
    show_default=True,
    help="Serve the true line of sight along with each robot, or nothing.",
)
@click.option(
    "--lockstep/--no-lockstep",
    default=False,
    help="Wait for every command instead of running in real time.",
)
@click.option(
    "--wait",
    type=SECONDS,
    default=60.0,
    show_default=True,
    help="Maximum time to wait until all clients are ready [s].",
)
@folder_option(help="Run folder; the run is not saved by default.")
@json_option
def serve(
    settings: DuelSettings,
    sight: str,
    lockstep: bool,
    wait: float,
    output: Path | None,
    as_json: bool,
    **languages: Any,
) -> None:
    """Serve simulated robots over LoLA or ROS 2, and play a duel.

    \b
    --lola  joint targets every 12 ms, like a NAO V6
    --ros2  velocities for the robot's own walking controller

    A player that is not served is controlled by this process. The simulation
    starts when every served robot has a client that commands it with
    stiffness on. LoLA has a cycle of 12 ms; an ideal body is therefore
    replaced by the delayed one.
    """  # noqa: D301 (\b is a character for click)
    import gc

    from ..games.served_duel import serve_duel
    from .server_options import endpoints_of

    if not languages["ros2"]:
        refuse_options({"domain", "network"}, "--ros2")
    check_run_folder(output)
    with ExitStack() as stack:
        endpoints = endpoints_of(
            languages, stack, ideal_sight=sight == "ideal"
        )
        gc.collect()
        gc.freeze()
        served = serve_duel(
            with_feedback(_with_cycle(settings)),
            endpoints,
            lock_step=lockstep,
            patience=wait,
        )
    run, plain = served.run, served.to_json()
    saved = save_run(output, run)
    if as_json:
        print_json(plain | saved.entries)
    else:
        late = ", ".join(f"{k} ms: {n}" for k, n in served.lateness_ms.items())
        print_table(
            [
                ("outcome", f"{plain['outcome']}: {plain['message']}"),
                ("pursuer radius", _radius(plain["pursuer"])),
                ("evader radius", _radius(plain["evader"])),
                *table_rows(plain, ("distance_m",), 3),
                ("late ticks", str(served.late_ticks)),
                ("lateness", late),
            ]
        )
        saved.print_paths(f"{run.game}.png")
    saved.raise_failure()
    saved.exit_if_interrupted(run.outcome)


def _radius(player: dict[str, Any]) -> str:
    """Return the radius of a player's path, with unit."""
    return format_value("radius_m", player["radius_m"], 3)


def _with_cycle(settings: DuelSettings) -> DuelSettings:
    """Return settings whose bodies have the control period of LoLA."""
    from ..sim.body_settings import BODIES

    if settings.body == BODIES["ideal"]:
        settings = replace(settings, body=BODIES["delayed"])
    if settings.body.cycle == 0.0:
        settings = replace(settings, body=replace(settings.body, cycle=0.012))
    return settings
