"""``stepaside serve``: simulated robots for external controllers."""

import gc
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..games.duel_settings import PLAYERS, DuelSettings
from .connection_settings import join_domain, with_feedback
from .options import folder_option, json_option
from .run_output import finish_run, print_run, run_folder
from .settings import takes_settings
from .tables import print_table

if TYPE_CHECKING:
    from ..games.served_duel import RobotEndpoint

NAMED = ("seed", "duration", "robot", "start.distance")


@click.command("serve")
@takes_settings(NAMED, settings=DuelSettings)
@click.option(
    "--lola",
    multiple=True,
    metavar="PLAYER=PATH",
    help="Serve the joints of a player's robot over LoLA, at a socket.",
)
@click.option(
    "--ros2",
    multiple=True,
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
    type=click.FloatRange(1e-9, 1e9),
    default=60.0,
    show_default=True,
    help="Maximum time to wait until all clients are ready [s].",
)
@folder_option(help="Run folder; the run is not saved by default.")
@json_option
def serve(
    settings: DuelSettings,
    lola: tuple[str, ...],
    ros2: tuple[str, ...],
    domain: int | None,
    network: bool,
    sight: str,
    lockstep: bool,
    wait: float,
    output: Path | None,
    as_json: bool,
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
    from ..games.served_duel import lola_endpoint, ros2_endpoint, serve_duel

    if not ros2 and (network or domain is not None):
        raise click.UsageError("--domain and --network require --ros2")
    folder, sees = run_folder(output, as_json, None), sight == "ideal"
    endpoints: dict[str, RobotEndpoint] = {
        name: lola_endpoint(place, ideal_sight=sees)
        for name, place in _players("--lola", lola, "PATH", ())
    }
    served_over_ros2 = _players("--ros2", ros2, "/NAMESPACE", endpoints)
    if not endpoints and not served_over_ros2:
        raise click.UsageError(
            "at least one player must be served: --lola PLAYER=PATH or "
            "--ros2 PLAYER=/NAMESPACE"
        )
    with ExitStack() as stack:
        if served_over_ros2:
            from ..drivers.ros2_dds import parse_namespace
            from ..drivers.ros2_server import WorldClock

            dds = join_domain(domain, network=network)
            stack.callback(dds.close)
            clock = WorldClock(dds)
            for name, place in served_over_ros2:
                endpoints[name] = ros2_endpoint(
                    dds, clock, parse_namespace(place), ideal_sight=sees
                )
        gc.collect()
        gc.freeze()
        served = serve_duel(
            with_feedback(_with_cycle(settings)),
            endpoints,
            lock_step=lockstep,
            patience=wait,
        )

    def show() -> None:
        print_run(served.run)
        print_table([("late ticks", str(served.late_ticks))])

    finish_run(served.run, folder, as_json, show, served.to_json())


def _players(
    option: str, texts: Sequence[str], address: str, taken: Any
) -> list[tuple[str, str]]:
    """Parse players and addresses; each player may be served once."""
    found = dict[str, str]()
    for text in texts:
        name, _, place = text.partition("=")
        known = name in PLAYERS and name not in taken and name not in found
        if not known or not place:
            raise click.UsageError(
                f"{option} must be {' or '.join(PLAYERS)}={address}, each "
                f"player once, got {text!r}"
            )
        found[name] = place
    return list(found.items())


def _with_cycle(settings: DuelSettings) -> DuelSettings:
    """Return settings whose bodies have the control period of LoLA.

    Learned legs have a period of their own.
    """
    from ..sim.body_settings import BODIES

    if any(settings.robot_of(name).legs.walks for name in settings.robots):
        return settings
    if settings.body == BODIES["ideal"]:
        settings = replace(settings, body=BODIES["delayed"])
    if settings.body.cycle == 0.0:
        settings = replace(settings, body=replace(settings.body, cycle=0.012))
    return settings
