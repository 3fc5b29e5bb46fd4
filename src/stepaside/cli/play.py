"""``stepaside play``: control of one real or simulated robot in a game."""

import gc
import logging
import sys
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..games.play_settings import ROS2, PlaySettings
from .settings import refuse_settings, takes_settings
from .terminal import echo, json_option, print_json

if TYPE_CHECKING:
    from ..drivers.joint_loop import JointLoop
    from ..drivers.robot_check import AdapterFinding
    from ..drivers.velocity_loop import VelocityLoop

UNUSED_BY_CHECK = (
    *("duration", "dead_man", "images", "max_speed", "max_turn"),
    *("sim_time", "role", "remap", "opponent", "people", "max_lateral"),
)
TIME_IS_UP = "played long enough"
INTERRUPTED = "interrupted"
CHECK_SILENCE = 3.0  # of the check before its guardian stops the robot, in [s]
WALKS = (
    "the robot will turn and walk for about 20 s, at most at half of its "
    "limits: let it hang, or give it room; Ctrl-C stops it"
)
MOVES = (
    "each joint of the robot will move by 0.1 rad and back, for about {} s: "
    "let it hang in the air; Ctrl-C releases it"
)
PER_JOINT = 1.2  # duration of the check of a joint, in [s]


NAMED = (
    *("role", "robot", "strategy", "senses", "duration"),
    *("domain", "dead_man", "dry_run"),
)


@click.command("play")
@click.argument("address", default="")
@takes_settings(NAMED, PlaySettings)
@click.option(
    "--record",
    type=click.Path(path_type=Path),
    help="Record all measurements, targets and state changes to a run folder "
    "for stepaside show.",
)
@click.option(
    "--check",
    is_flag=True,
    help="Check a robot in Python instead of playing: rates, latency, units, "
    "signs and stopping. The robot moves, and must hang in the air if it "
    "is driven by its joints; the exit status is 1 if a check fails.",
)
@json_option
def play(
    address: str,
    settings: PlaySettings,
    record: Path | None,
    check: bool,
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
    settings = replace(settings, address=address)
    logging.basicConfig(
        format="stepaside: %(message)s", level=logging.INFO, stream=sys.stderr
    )
    if check:
        needed = "a play without --check"
        refuse_settings(UNUSED_BY_CHECK, needed)
        if record is not None:
            raise click.UsageError(f"record requires {needed}")
        _check_adapter(settings, as_json=as_json)
        return
    if as_json:
        raise click.UsageError("--json requires --check")
    from ..drivers.method_thread import SessionLost
    from ..drivers.play_log import StatusLine
    from ..drivers.robot import JointRobot
    from .robot_connections import open_loop, robot_maker, with_feedback

    if address.startswith(ROS2):  # before it joins a domain
        _refuse_unused(settings, joints=False)
    make = robot_maker(settings)
    robot = make()
    joints = isinstance(robot, JointRobot)
    _refuse_unused(settings, joints=joints)
    if joints:
        control = with_feedback(settings.control)
        settings = replace(settings, control=control)
        if robot.paced:
            refuse_settings(
                ("sim_time",),
                "a robot with velocity commands, or a JointRobot with paced "
                "= False",
            )
    loop = None
    try:
        with ExitStack() as stack:
            line = StatusLine(sys.stderr)
            stack.callback(line.close)
            observers: list[Any] = [line]
            kept = None
            if record is not None:
                from .play_recording import PlayRecord

                kept = PlayRecord(record, settings)
                stack.push(kept.leave)
                observers.append(kept)
            loop = open_loop(settings, make)
            stack.callback(loop.close)
            ended = _run(loop, observers, settings.duration)
            if kept is not None:
                kept.ended = ended
    except KeyboardInterrupt:
        end = "the session with the robot is closed"
        if loop is None:
            end = f"interrupted while connecting to {address}"
        echo(f"stepaside: {end}", err=True)
        raise
    except SessionLost as error:
        raise click.ClickException(str(error)) from error


def _refuse_unused(settings: PlaySettings, *, joints: bool) -> None:
    """Refuse options that have no effect with this role and robot."""
    addresses = settings.address, settings.dead_man
    on_ros2 = any(ROS2 in str(each) for each in addresses)
    buttons = joints and settings.on_nao
    topics = settings.address.startswith(ROS2)
    sees = settings.senses == "cameras"
    rows = (  # whether they have an effect, the options, and what they need
        (not joints, "max_speed max_turn", "a robot with velocity commands"),
        (not buttons, "dead_man", "a robot without a chest button"),
        (joints, "delay_ticks legs. control.", "joint control"),
        (sees, "images", "senses cameras, got ideal"),
        (topics, "remap opponent people max_lateral", f"a robot at {ROS2}"),
        (on_ros2, "domain network", f"a robot or a switch at {ROS2}"),
    )
    for has_effect, names, needed in rows:
        if not has_effect:
            refuse_settings(tuple(names.split()), needed)


def _run(
    loop: "JointLoop | VelocityLoop",
    observers: list[Any],
    duration: float | None,
) -> str:
    """Run a control loop until the robot rests; return why it ended.

    It walks for a duration in [s], if that is given.

    Raises:
        SessionLost: If the session failed, or a robot without a button to
            start it again went limp.
    """
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


def _check_adapter(settings: PlaySettings, *, as_json: bool) -> None:
    """Check a robot; print a verdict per line; exit with 1 if one fails."""
    if not settings.in_python:
        raise click.UsageError(
            "--check requires the address FILE.py:CLASS, got "
            f"{settings.address!r}"
        )
    from ..drivers.guardian_process import fork_guardian
    from ..drivers.joint_motion import motors_of
    from ..drivers.robot import JointRobot
    from ..drivers.robot_check import RobotCheck
    from ..drivers.robot_loader import load_robot_class
    from ..robots.description import load_robot

    def note(finding: "AdapterFinding") -> None:
        if not as_json:
            text = finding.text
            echo(f"{finding.verdict:<8} {finding.name:<17} {text}")

    make = load_robot_class(settings.address)
    robot, dry_run, motors = make(), settings.dry_run, None
    if isinstance(robot, JointRobot):
        motors = motors_of(robot, load_robot(settings.robot))
        warning = MOVES.format(round(PER_JOINT * len(motors.names)))
    else:
        refuse_settings(("robot",), "a robot that is driven by its joints")
        warning = WALKS
    guardian = None
    if not dry_run:
        echo(f"stepaside: {warning}", err=True)
        if robot.paced:
            guardian = fork_guardian(make, robot, CHECK_SILENCE)
    check = RobotCheck(robot, motors, note, dry_run=dry_run, guardian=guardian)
    try:
        check.run()
    finally:
        if guardian is not None:
            guardian.dismiss()
    if as_json:
        found = [each._asdict() for each in check.findings]
        summary = {"robot": settings.address, "passes": check.passes}
        print_json(summary | {"findings": found})
    if not check.passes:
        raise SystemExit(1)
