"""``stepaside serve``: the simulated world, for control elsewhere."""

from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .duel_options import duel_options
from .options.common_options import FOLDER, json_option
from .options.connection_options import DOMAIN, NETWORK
from .options.settings_command import SettingsCommand
from .options.value_kinds import NameType
from .run_output import check_kept, keep
from .value_labels import rows_of, text_of
from .value_types import SECONDS, print_json, print_table

if TYPE_CHECKING:
    from ..games.duel_settings import DuelSettings

SIGHTS = ("ideal", "none")


@click.command("serve", cls=SettingsCommand)
@duel_options()
@click.option(
    "--lola",
    "lola",
    multiple=True,
    metavar="PLAYER=ADDRESS",
    help="Joints of a player's robot over LoLA: a path, or HOST:PORT.",
)
@click.option(
    "--naoqi",
    "naoqi",
    multiple=True,
    metavar="PLAYER=URL",
    help="A player's robot that walks by itself, over NAOqi's services: "
    "tcp://127.0.0.1:PORT.",
)
@click.option(
    "--naoqi-joints",
    "naoqi_joints",
    multiple=True,
    metavar="PLAYER=URL",
    help="Joints of a player's robot over NAOqi: tcp://127.0.0.1:PORT.",
)
@click.option(
    "--ros2",
    "ros2",
    multiple=True,
    metavar="PLAYER=/NAMESPACE",
    help="A player's robot that walks by itself, over ROS 2 topics.",
)
@DOMAIN.option()
@NETWORK.option(default=False)
@click.option(
    "--sight",
    type=NameType(lambda: SIGHTS),
    default=SIGHTS[0],
    show_default=True,
    help="Offer the true line of sight beside each robot.",
)
@click.option(
    "--lockstep/--no-lockstep",
    default=False,
    help="Wait for every answer instead of for the clock.",
)
@click.option(
    "--wait",
    type=SECONDS,
    default=60.0,
    show_default=True,
    help="For clients to come and be ready [s].",
)
@FOLDER.option(help="Run folder; nothing is kept by default.")
@json_option
def serve(
    settings: "DuelSettings",
    sight: str,
    lockstep: bool,
    wait: float,
    output: Path | None,
    as_json: bool,
    **languages: Any,
) -> None:
    r"""Offer simulated robots over LoLA, NAOqi or ROS 2, and play a duel.

    \b
    --lola          joints, every 12 ms, as a NAO V6 has them
    --naoqi-joints  joints, over NAOqi's services
    --naoqi         a robot that walks by itself: velocities or footsteps
    --ros2          a robot that walks by itself: velocities, on topics

    A robot that is not offered is played here. Time begins to pass when
    every offered robot has a client that holds it stiff, or a commander.
    LoLA has a cycle of 12 ms: an ideal body is served as the delayed one.
    """
    import gc

    from ..games.served_duel import serve_duel
    from .feedback_default import with_feedback
    from .server_options import offers_of

    check_kept(output)
    with ExitStack() as stack:
        offers = offers_of(languages, stack, ideal_sight=sight == "ideal")
        gc.collect()
        gc.freeze()
        served = serve_duel(
            with_feedback(_with_cycle(settings)),
            offers,
            lock_step=lockstep,
            patience=wait,
        )
    run, kept = keep(output, served.run)
    plain = served._replace(run=run).to_json()
    if as_json:
        print_json(plain)
    else:
        late = ", ".join(f"{k} ms: {n}" for k, n in served.lateness_ms.items())
        print_table(
            [
                ("outcome", f"{plain['outcome']}: {plain['message']}"),
                ("pursuer radius", _radius(plain["pursuer"])),
                ("evader radius", _radius(plain["evader"])),
                *rows_of(plain, ("distance_m",), 3),
                ("late ticks", str(served.late_ticks)),
                ("lateness", late),
            ]
        )
        kept.tell(f"{run.game}.png")
    kept.check()
    kept.leave_if(run.outcome)


def _radius(player: dict[str, Any]) -> str:
    """Radius of the way of a player, with its unit."""
    return text_of("radius_m", player["radius_m"], 3)


def _with_cycle(settings: "DuelSettings") -> "DuelSettings":
    """Settings of a duel whose bodies have LoLA's cycle."""
    from ..sim.body_settings import BODIES

    if settings.body == BODIES["ideal"]:
        settings = replace(settings, body=BODIES["delayed"])
    if settings.body.cycle == 0.0:
        settings = replace(settings, body=replace(settings.body, cycle=0.012))
    return settings
