"""``stepaside serve``: our world, for control that is elsewhere."""

from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .declared.common import FOLDER, json_option
from .declared.kinds import NameType
from .declared.take import SettingsCommand
from .declared.wires import DOMAIN, NETWORK
from .duel_options import duel_options
from .keeping import check_kept, keep
from .options import SECONDS, print_json, print_table

if TYPE_CHECKING:
    from ..games.settings import DuelSettings

SIGHTS = ("ideal", "none")


@click.command("serve", cls=SettingsCommand)
@duel_options()
@click.option(
    "--lola",
    "lola",
    multiple=True,
    metavar="PLAYER=ADDRESS",
    help="Where a player's robot speaks LoLA: a path, or HOST:PORT.",
)
@click.option(
    "--naoqi",
    "naoqi",
    multiple=True,
    metavar="PLAYER=URL",
    help="Where a player's robot walks by itself, on NAOqi's services: "
    "tcp://127.0.0.1:PORT.",
)
@click.option(
    "--naoqi-joints",
    "naoqi_joints",
    multiple=True,
    metavar="PLAYER=URL",
    help="Where a player's joints are moved over NAOqi: tcp://127.0.0.1:PORT.",
)
@click.option(
    "--ros2",
    "ros2",
    multiple=True,
    metavar="PLAYER=/NAMESPACE",
    help="Where a player's robot walks by itself, on ROS 2 topics.",
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
    """Let others play a duel in our world.

    A robot on LoLA, or at --naoqi-joints, is moved by its joints; one on
    NAOqi or on ROS 2 topics walks by itself, by our own control, as it is
    told: at velocities, or by footsteps over NAOqi.
    The world stands still until every robot that is offered has somebody to
    move it: a client that holds it stiff, or a commander. Then the chest
    buttons are pressed, and time passes. A robot that is not offered is
    played here. LoLA has a cycle of 12 ms: an ideal body is served as the
    delayed one.
    """
    import gc

    from ..games.serving import serve_duel
    from .feedback import with_feedback
    from .offering import offers_of

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
                ("pursuer radius", str(plain["pursuer"]["radius_m"])),
                ("evader radius", str(plain["evader"]["radius_m"])),
                ("distance", f"{plain['distance_m']:.3f} m"),
                ("late ticks", str(served.late_ticks)),
                ("lateness", late),
            ]
        )
        kept.tell(f"{run.game}.png")
    kept.check()
    kept.leave_if(run.outcome)


def _with_cycle(settings: "DuelSettings") -> "DuelSettings":
    """Settings of a duel whose bodies have LoLA's cycle."""
    from ..world.body_settings import BODIES

    if settings.body == BODIES["ideal"]:
        settings = replace(settings, body=BODIES["delayed"])
    if settings.body.cycle == 0.0:
        settings = replace(settings, body=replace(settings.body, cycle=0.012))
    return settings
