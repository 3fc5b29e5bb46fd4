"""``stepaside play``: one player, at a robot that may be real."""

import logging
import sys
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .duel_options import duel_kind
from .options.body_options import CONTROL
from .options.connection_options import (
    BY,
    DOMAIN,
    MAX_SPEED,
    MAX_TURN,
    NETWORK,
    SIM_TIME,
)
from .options.gait_options import GAIT
from .options.game_options import SENSES, STRATEGY
from .options.settings_command import SettingsCommand, takes_settings
from .options.value_kinds import NameType
from .value_types import SECONDS, NumberType

if TYPE_CHECKING:
    from ..drivers.joint.joint_loop import JointLoop
    from ..drivers.velocity.velocity_loop import VelocityLoop
    from ..games.duel_settings import DuelSettings

ROLES = ("pursuer", "evader")
TRYING = 6.0  # longest time that connecting takes, in [s]
PAUSE = 0.3  # between two tries, in [s]
LONG_ENOUGH, INTERRUPTED = "played long enough", "interrupted"


@click.command("play", cls=SettingsCommand)
@takes_settings(duel_kind, STRATEGY, GAIT, CONTROL, SENSES)
@click.option(
    "--role",
    type=NameType(lambda: ROLES),
    required=True,
    help="Who this process is.",
)
@click.option(
    "--robot",
    required=True,
    help="lola:PATH or lola:HOST:PORT, lola: alone for the robot itself; "
    "naoqi:tcp://HOST:PORT or ros2:/NAMESPACE, where it walks by itself.",
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
    "--images",
    help="With --sensing cameras, where images come from: v4l2:DEVICE, "
    "naoqi:tcp://HOST:PORT or ros2:/TOPIC; what a simulated robot offers "
    "beside its socket by default.",
)
@BY.option()
@MAX_SPEED.option()
@MAX_TURN.option()
@DOMAIN.option()
@NETWORK.option(default=False)
@SIM_TIME.option(default=False)
@click.option(
    "--duration", type=SECONDS, help="Stop and rest after this walk [s]."
)
@click.option(
    "--wait",
    type=NumberType("s", allow_zero=True),
    default=10.0,
    show_default=True,
    help="For the robot to be there, at the beginning [s].",
)
@click.option(
    "--reconnect",
    type=SECONDS,
    help="By joints: try for so long to get a session that was lost [s].",
)
@click.option(
    "--record",
    type=click.Path(file_okay=False, path_type=Path),
    help="Run folder of its own, which replays: every measurement, target "
    "and change of state, and what became of it.",
)
@click.option(
    "--dry-run/--no-dry-run",
    default=False,
    help="Connect, read and plan, but command nothing but lights.",
)
def play(
    settings: "DuelSettings",
    duration: float | None,
    reconnect: float | None,
    **options: Any,
) -> None:
    r"""Drive a robot over LoLA, NAOqi or ROS 2: the player is this process.

    \b
    --robot lola:ADDRESS          joints, every 12 ms, of a NAO V6
    --robot naoqi:tcp://...       walks by itself, or joints --by joints
    --robot ros2:/NAMESPACE       walks by itself, at velocities on topics

    A robot whose joints are moved takes its stance slowly, shows green, and
    walks from when its chest button is pressed until it is pressed again.
    One that walks by itself goes at once when it knows where the other is.
    Interrupt once to let it stop and rest, twice to let it go limp, or
    stand.
    """
    logging.basicConfig(
        format="stepaside: %(message)s", level=logging.INFO, stream=sys.stderr
    )
    from ..drivers.guardian_process import SessionLost
    from ..drivers.status_line import StatusLine
    from .feedback_default import with_feedback
    from .naoqi_options import by_joints, check_way
    from .robot_connections import open_joints, open_velocity

    check_way(options)
    folder = options.pop("record")
    joints = by_joints(options)
    with ExitStack() as stack:
        line = StatusLine(sys.stderr)
        stack.callback(line.close)
        onlookers: list[Any] = [line]
        told = None
        if folder is not None:
            from .play_record import PlayRecord

            own = with_feedback(settings) if joints else settings
            told = PlayRecord(folder, own, options)
            stack.push(told.leave)
            onlookers.append(told)

        def session() -> str:
            asked = options | {}
            options["wait"] = 0.0  # a session that is lost is --reconnect's
            with ExitStack() as within:
                if joints:
                    playing = open_joints(settings, asked)
                    within.callback(playing.body.close)
                    return _play(playing, onlookers, duration)
                driving = open_velocity(settings, asked)
                within.callback(driving.body.close)
                return _drive(driving, onlookers, duration)

        try:
            ended = _again_and_again(session, reconnect if joints else None)
            if told is not None:
                told.ended = ended
        except SessionLost as error:
            raise click.ClickException(str(error)) from error


def _again_and_again(
    session: Callable[[], str], reconnect: float | None
) -> str:
    """Play until a session ends well, or none can be had for some time.

    A robot whose joints are moved begins each session limp, stands up
    slowly if it is upright, and waits for its chest button.

    Args:
        session: Connects and plays.
        reconnect: How long to try for a new session, in [s].

    Returns:
        Why the last one ended.

    Raises:
        SessionLost: If the last one was lost.
    """
    from time import monotonic, sleep

    from ..drivers.guardian_process import SessionLost

    until: float | None = None
    while True:
        began = monotonic()
        try:
            return session()
        except SessionLost as error:
            lost = monotonic()
            if until is None or lost - began > TRYING:
                until = lost + (reconnect or 0.0)  # it was a session
            if reconnect is None or lost >= until:
                raise
            logging.warning("%s; tries again", error)
            sleep(PAUSE)


def _play(
    playing: "JointLoop", onlookers: list[Any], duration: float | None
) -> str:
    """Play until the session ends, or the robot rests when asked to; why."""
    import gc

    from ..drivers.guardian_process import SessionLost
    from ..drivers.joint.safety import RobotState

    gc.collect()
    gc.freeze()  # what is loaded stays: collections stay short
    body = playing.body
    leaving = ""
    while True:
        try:
            tick = playing.tick()
            for onlooker in onlookers:
                onlooker.note(tick)
            if leaving and tick.state is RobotState.LIMP:
                return leaving
            walked = tick.measurement.time
            if duration is not None and tick.state is RobotState.WALKING:
                if walked >= duration - 1e-9:
                    leaving = LONG_ENOUGH
                    body.rest(leaving)
        except KeyboardInterrupt:
            if leaving or tick.state is RobotState.LIMP:
                raise
            leaving = INTERRUPTED
            body.rest(leaving)
        except SessionLost:
            if not leaving:
                raise
            return leaving  # it was to rest, and is limp


def _drive(
    driving: "VelocityLoop", onlookers: list[Any], duration: float | None
) -> str:
    """Drive until the session ends, or the robot rests when asked to; why."""
    from ..drivers.velocity.velocity_loop import DrivingState

    began: float | None = None
    leaving = False
    while True:
        try:
            tick = driving.tick()
            for onlooker in onlookers:
                onlooker.note(tick)
            if tick.state is DrivingState.RESTING:
                return tick.reason
            if began is None and tick.state is DrivingState.WALKING:
                began = tick.time
            if duration is not None and began is not None:
                if tick.time - began >= duration - 1e-9:
                    driving.leave(LONG_ENOUGH)
        except KeyboardInterrupt:
            if leaving:
                raise
            leaving = True
            driving.leave(INTERRUPTED)
