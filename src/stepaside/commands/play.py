"""``stepaside play``: one player, at a robot that may be real."""

import logging
import sys
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from .declared.body import CONTROL
from .declared.gait import GAIT
from .declared.game import STRATEGY
from .declared.kinds import NameType
from .declared.take import SettingsCommand, takes_settings
from .duel_options import duel_kind
from .options import SECONDS

if TYPE_CHECKING:
    from ..drivers.playing import Playing
    from ..games.settings import DuelSettings

ROLES = ("pursuer", "evader")


@click.command("play", cls=SettingsCommand)
@takes_settings(duel_kind, STRATEGY, GAIT, CONTROL)
@click.option(
    "--role",
    type=NameType(lambda: ROLES),
    required=True,
    help="Who this process is.",
)
@click.option(
    "--robot",
    required=True,
    help="lola:PATH or lola:HOST:PORT; lola: alone is the robot itself.",
)
@click.option(
    "--description",
    default="nao",
    show_default=True,
    help="Robot, or the folder of its description.",
)
@click.option(
    "--delay-ticks",
    type=click.IntRange(0, 20),
    default=3,
    show_default=True,
    help="Ticks of 12 ms from a request to the motion.",
)
@click.option(
    "--duration", type=SECONDS, help="Stop and rest after this walk [s]."
)
@click.option(
    "--record",
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder for every measurement, target and change of state.",
)
@click.option(
    "--dry-run/--no-dry-run",
    default=False,
    help="Connect, read and plan, but command nothing but lights.",
)
def play(
    settings: "DuelSettings", duration: float | None, **options: Any
) -> None:
    """Let control drive a robot: the player is this process.

    The robot takes its stance slowly, shows green, and walks from when its
    chest button is pressed until it is pressed again. Interrupt once to let
    it stop and rest, twice to let it go limp.
    """
    logging.basicConfig(
        format="stepaside: %(message)s", level=logging.INFO, stream=sys.stderr
    )
    from ..drivers.log import PlayLog
    from ..drivers.lola.link import SessionLost
    from ..drivers.playing import Onlooker
    from ..drivers.status_line import StatusLine

    folder = options.pop("record")
    with ExitStack() as stack:
        line = StatusLine(sys.stderr)
        stack.callback(line.close)
        onlookers: list[Onlooker] = [line]
        if folder is not None:
            about = options | _spelled(settings)
            kept = PlayLog(folder, about)
            stack.callback(kept.close)
            onlookers.append(kept)
        playing = _open(settings, **options)
        stack.callback(playing.body.close)
        try:
            _play(playing, onlookers, duration)
        except SessionLost as error:
            raise click.ClickException(str(error)) from error


def _spelled(settings: "DuelSettings") -> dict[str, Any]:
    """What the settings say of control, for the log."""
    from ..games.configuration import spelled_settings

    spelled = spelled_settings(settings)
    return {name: spelled[name] for name in ("strategy", "gait", "control")}


def _with_feedback(settings: "DuelSettings") -> "DuelSettings":
    """Settings with feedback, unless they say what control is to be."""
    from dataclasses import replace

    from ..control.balance.settings import OPEN_LOOP, STABILISED

    source = click.get_current_context().get_parameter_source
    asked = (source("control__feedback"), source("control__method"))
    said = any(one is not ParameterSource.DEFAULT for one in asked)
    if said or settings.control != OPEN_LOOP:
        return settings
    return replace(settings, control=STABILISED)


def _open(
    settings: "DuelSettings",
    role: str,
    robot: str,
    description: str,
    delay_ticks: int,
    dry_run: bool,
) -> "Playing":
    """Connect to the robot, with the mind that the settings ask for."""
    from ..control import ControlScheme
    from ..drivers.lola.address import parse_address
    from ..drivers.lola.body import LolaBody
    from ..drivers.lola.opening import open_lola
    from ..drivers.minds import mind_maker
    from ..drivers.playing import Playing
    from ..robots.description import load_robot
    from ..strategies import load_strategy

    address = parse_address(robot)
    settings = _with_feedback(settings)
    names = {
        "pursuer": settings.pursuer_strategy,
        "evader": settings.evader_strategy,
    }
    strategy = load_strategy(names[role], settings.strategy)

    def open_body(scheme: ControlScheme) -> LolaBody:
        return open_lola(
            address,
            scheme.kinematics.joint_names,
            scheme.joint_targets,
            dry_run=dry_run,
            guarded=True,
        )

    make = mind_maker(
        load_robot(description),
        settings.gait,
        settings.control,
        tick=LolaBody.tick,
        delay_ticks=delay_ticks,
    )
    return Playing(open_body, strategy, make, dry_run=dry_run)


def _play(
    playing: "Playing", onlookers: list[Any], duration: float | None
) -> None:
    """Play until the session ends, or the robot rests when asked to."""
    import gc

    from ..drivers.lola.safety import State

    gc.collect()
    gc.freeze()  # what is loaded stays: collections stay short
    body = playing.body
    leaving = False
    while True:
        try:
            tick = playing.tick()
            for onlooker in onlookers:
                onlooker.note(tick)
            if leaving and tick.state is State.LIMP:
                return
            walked = tick.measurement.time
            if duration is not None and tick.state is State.WALKING:
                if walked >= duration - 1e-9:
                    leaving = True
                    body.rest("played long enough")
        except KeyboardInterrupt:
            if leaving or tick.state is State.LIMP:
                raise
            leaving = True
            body.rest("interrupted")
