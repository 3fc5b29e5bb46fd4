"""``stepaside play``: control of one real or simulated robot in a game."""

import logging
import sys
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import click

from ..games.duel_settings import EVADER, PURSUER, DuelSettings
from ..strategies.registry import OF_EVASION
from .connection_settings import ROS2, ConnectionSettings, with_feedback
from .options import json_option
from .settings import refuse_settings, takes_settings

if TYPE_CHECKING:
    from ..drivers.joint_loop import JointLoop
    from ..drivers.velocity_loop import VelocityLoop

CONNECTING = 6.0  # longest time that connecting takes, in [s]
PAUSE = 0.3  # between two attempts, in [s]
UNUSED_BY_CHECK = (
    *("record", "duration", "dead_man", "images", "max_speed", "max_turn"),
    *("sim_time", "role", "remap", "opponent", "people", "max_lateral"),
)
TIME_IS_UP = "played long enough"
INTERRUPTED = "interrupted"


NAMED = (
    *("role", "robot", "evader_strategy", "sensing", "duration"),
    *("record", "domain", "dead_man", "dry_run", "check"),
)
SECTIONS = (
    *("evader_strategy", "pursuer_strategy", "strategy", "shield", "gait"),
    *("legs", "control", "sensing", "cameras"),
)


@click.command("play")
@click.argument("address", default="")
@takes_settings(
    NAMED,
    sections=SECTIONS,
    settings=DuelSettings,
    connection=ConnectionSettings,
)
@json_option
def play(
    address: str,
    settings: DuelSettings,
    connection: ConnectionSettings,
    as_json: bool,
) -> None:
    """Control a robot in a game over LoLA, NAOqi, ROS 2 or its own SDK.

    \b
    ADDRESS  lola:PATH         joint targets for a NAO V6, every 12 ms
             naoqi:tcp://...   velocities for the robot's own controller
             ros2:/NAMESPACE   velocities for the robot's own controller
             rcss:HOST:PORT    joint targets in the RoboCup simulator
             FILE.py:CLASS     a class that calls the robot's SDK
                               (docs/connect-your-robot.md)

    With joint control, the robot slowly moves to its stance and turns its
    LEDs green; its chest button starts and stops the walk. With its own
    walking controller, it starts as soon as the opponent is located. Ctrl-C
    stops the robot and lets it rest; a second Ctrl-C makes it go limp (joint
    control) or stand at once.
    """  # noqa: D301 (\b is a character for click)
    if not address:
        raise click.UsageError("missing argument ADDRESS of the robot")
    connection = replace(connection, address=address)
    logging.basicConfig(
        format="stepaside: %(message)s", level=logging.INFO, stream=sys.stderr
    )
    if connection.check:
        from .play_check import check_adapter

        refuse_settings(UNUSED_BY_CHECK, "a play without --check")
        check_adapter(connection, as_json=as_json)
        return
    if as_json:
        raise click.UsageError("--json requires --check")
    from ..drivers.method_thread import SessionLost
    from ..drivers.robot import JointRobot
    from ..drivers.status_line import StatusLine
    from .robot_connections import open_loop

    if connection.address.startswith(ROS2):  # before it joins a domain
        _refuse_unused(settings, connection, joints=False)
    make = connection.robot_maker(settings)
    robot = make()
    joints = isinstance(robot, JointRobot)
    _refuse_unused(settings, connection, joints=joints)
    if joints and robot.paced:
        refuse_settings(
            ("sim_time",),
            "a robot with velocity commands, or a JointRobot with paced = "
            "False",
        )
    with ExitStack() as stack:
        line = StatusLine(sys.stderr)
        stack.callback(line.close)
        observers: list[Any] = [line]
        record = None
        if connection.record is not None:
            from .play_recording import PlayRecord

            used = with_feedback(settings) if joints else settings
            record = PlayRecord(connection.record, used, connection)
            stack.push(record.leave)
            observers.append(record)
        wait = connection.wait
        reconnect = connection.reconnect if joints else None

        def session() -> str:
            nonlocal wait
            now = replace(connection, wait=wait)
            wait = 0.0  # later sessions wait by "reconnect"
            loop = open_loop(settings, now, make)
            with ExitStack() as opened:
                opened.callback(loop.close)
                return _run(loop, observers, connection.duration)

        try:
            ended = _run_sessions(session, reconnect)
            if record is not None:
                record.end(ended)
        except SessionLost as error:
            raise click.ClickException(str(error)) from error


def _refuse_unused(
    settings: DuelSettings, connection: ConnectionSettings, *, joints: bool
) -> None:
    """Refuse options that have no effect with this role and robot."""
    evades = connection.role == EVADER
    other = "pursuer_strategy" if evades else "evader_strategy"
    refuse_settings(
        (other,),
        f"role {PURSUER if evades else EVADER}, got {connection.role}",
    )
    strategy = (
        settings.evader_strategy if evades else settings.pursuer_strategy
    )
    if strategy not in OF_EVASION:
        refuse_settings(
            ("strategy.",),
            f"the strategy {' or '.join(OF_EVASION)}, got {strategy}",
        )
    if joints:
        refuse_settings(
            (
                "max_speed",
                "max_turn",
            ),
            "a robot with velocity commands",
        )
        if connection.on_nao:
            refuse_settings(("dead_man",), "a robot without a chest button")
    else:
        refuse_settings(
            (
                "delay_ticks",
                "reconnect",
            ),
            "joint control",
        )
        refuse_settings(("legs.", "control."), "joint control")
    if settings.sensing != "cameras":
        refuse_settings(("images",), "sensing cameras, got ideal")
    if not connection.address.startswith(ROS2):
        refuse_settings(
            (
                "remap",
                "opponent",
                "people",
                "max_lateral",
            ),
            f"a robot at {ROS2}",
        )
    sources = connection.address, connection.images, connection.dead_man
    if not any(ROS2 in str(source) for source in sources):
        refuse_settings(
            (
                "domain",
                "network",
            ),
            f"a robot or images at {ROS2}",
        )


def _run_sessions(session: Callable[[], str], reconnect: float | None) -> str:
    """Run sessions until one ends normally or reconnecting fails.

    With joint control, each session begins limp; the robot stands up slowly
    if it is upright, and waits for its chest button.

    Args:
        session: Connects and plays; returns why the session ended.
        reconnect: How long to try for a new session, in [s]; None for a
            single session.

    Returns:
        Why the last session ended.

    Raises:
        SessionLost: If the last session was lost.
    """
    from time import monotonic, sleep

    from ..drivers.method_thread import SessionLost

    until: float | None = None
    while True:
        began = monotonic()
        try:
            return session()
        except SessionLost as error:
            lost = monotonic()
            if until is None or lost - began > CONNECTING:
                until = lost + (reconnect or 0.0)  # it had been connected
            if reconnect is None or lost >= until:
                raise
            logging.warning("%s; reconnecting", error)
            sleep(PAUSE)


def _run(
    loop: "JointLoop | VelocityLoop",
    observers: list[Any],
    duration: float | None,
) -> str:
    """Run a control loop until the robot rests; return why it ended.

    Args:
        loop: The loop.
        observers: Receivers of each tick.
        duration: Time to walk, in [s]; None for no limit.

    Raises:
        SessionLost: If the session failed, or a robot without a button to
            start it again went limp.
    """
    import gc

    from ..drivers.method_thread import SessionLost

    gc.collect()
    gc.freeze()  # exclude loaded modules, so that collections stay short
    reason = ""
    while True:
        try:
            tick = loop.tick()
            for observer in observers:
                observer.note(tick)
            if loop.ended:
                return reason or tick.reason
            if loop.given_up:
                raise SessionLost(loop.given_up)
            if duration is not None and tick.walked is not None:
                if tick.walked >= duration - 1e-9 and not reason:
                    reason = TIME_IS_UP
                    loop.leave(reason)
        except KeyboardInterrupt:
            if reason or loop.idle:
                raise
            reason = INTERRUPTED
            loop.leave(reason)
        except SessionLost:
            if not (reason and loop.idle):
                raise
            return reason  # it was about to rest, and is limp now
