"""``stepaside serve``: our world, for control that is elsewhere."""

from dataclasses import replace
from typing import TYPE_CHECKING

import click

from .declared.common import json_option
from .declared.kinds import NameType
from .declared.take import SettingsCommand
from .duel_options import duel_options
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
    required=True,
    metavar="PLAYER=ADDRESS",
    help="Where a player's robot listens: a path, or HOST:PORT.",
)
@click.option(
    "--sight",
    type=NameType(lambda: SIGHTS),
    default=SIGHTS[0],
    show_default=True,
    help="Offer the true line of sight beside each path.",
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
@json_option
def serve(
    settings: "DuelSettings",
    lola: tuple[str, ...],
    sight: str,
    lockstep: bool,
    wait: float,
    as_json: bool,
) -> None:
    """Let others play a duel in our world: each robot speaks LoLA.

    The world stands still until every robot has a client that holds it
    stiff; then the chest buttons are pressed, and time passes. A robot
    without an address is played here. LoLA has a cycle of 12 ms: an ideal
    body is served as the delayed one.
    """
    import gc

    from ..drivers.lola.address import parse_address
    from ..games.outcome import Outcome
    from ..games.serving import serve_duel
    from ..games.settings import PLAYERS
    from ..world.body_settings import BODIES

    if settings.body == BODIES["ideal"]:
        settings = replace(settings, body=BODIES["delayed"])
    if settings.body.cycle == 0.0:
        settings = replace(settings, body=replace(settings.body, cycle=0.012))
    addresses = {}
    for entry in lola:
        name, _, place = entry.partition("=")
        if name not in PLAYERS or not place or name in addresses:
            raise click.BadParameter(
                f"must be {' or '.join(PLAYERS)}=ADDRESS, each once, "
                f"got {entry!r}",
                param_hint="--lola",
            )
        addresses[name] = parse_address(place)
    gc.collect()
    gc.freeze()
    served = serve_duel(
        settings,
        addresses,
        lock_step=lockstep,
        ideal_sight=sight == "ideal",
        patience=wait,
    )
    plain = served.to_json()
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
    if served.outcome is Outcome.INTERRUPTED:
        raise SystemExit(130)
