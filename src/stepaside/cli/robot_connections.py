"""Connections of ``stepaside play`` to its robot and its camera."""

import sys
from dataclasses import replace
from math import inf
from typing import TYPE_CHECKING, Any

import click

from ..games.floor_games import strategy_of
from .connection_settings import ConnectionSettings, with_feedback

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..drivers.dead_man_switch import DeadManSwitch
    from ..drivers.joint_loop import JointLoop
    from ..drivers.robot import JointRobot
    from ..drivers.robot_camera import RobotCamera
    from ..drivers.robot_session import RobotSession
    from ..drivers.velocity_loop import VelocityLoop
    from ..games.play_settings import PlaySettings

V4L2 = "v4l2:"


def open_loop(
    settings: "PlaySettings",
    connection: ConnectionSettings,
    make: "Callable[[], Any]",
) -> "JointLoop | VelocityLoop":
    """Connect to the robot that a function makes; return its control loop."""
    from ..drivers.robot import JointRobot

    robot = make()
    if settings.senses == "cameras":
        _check_camera(robot, connection)
    if isinstance(robot, JointRobot):
        return _open_joints(settings, connection, make, robot)
    return _open_velocity(settings, connection, make, robot)


def _open_joints(
    settings: "PlaySettings",
    connection: ConnectionSettings,
    make: "Callable[[], JointRobot]",
    robot: "JointRobot",
) -> "JointLoop":
    from ..drivers.joint_loop import JointLoop
    from ..drivers.joint_motion import motors_of
    from ..drivers.scheme_factory import policy_gains, scheme_factory
    from ..locomotion.policy.policy_legs import load_policy
    from ..robots.description import load_robot

    description = load_robot(connection.robot)
    legs, gains = settings.legs, None
    sees = settings.senses == "cameras"
    motors = motors_of(robot, description)
    if legs.walks:
        if not robot.takes_gains:
            raise click.UsageError(
                "legs requires a robot that takes gains, got "
                f"{connection.address!r}"
            )
        contract, _ = load_policy(legs, description)
        gains = policy_gains(contract, motors)
    else:
        control = with_feedback(settings.control)
        settings = replace(settings, control=control)
    return JointLoop(
        lambda: _open_session(connection, make, robot),
        motors,
        strategy_of(settings.player(settings.role)),
        scheme_factory(
            description,
            settings.gait,
            legs if legs.walks else settings.control,
            tick=robot.tick,
            delay_ticks=connection.delay_ticks,
            sees_as=connection.role if sees else None,
        ),
        gains=gains,
        open_eyes=(lambda opened: _open_camera(settings, opened, connection))
        if sees
        else None,
        needs_forces=not legs.walks,
        dry_run=connection.dry_run,
    )


def _open_velocity(
    settings: "PlaySettings",
    connection: ConnectionSettings,
    make: "Callable[[], Any]",
    robot: Any,
) -> "VelocityLoop":
    from ..drivers.robot_camera import PosedSight
    from ..drivers.robot_session import PREPARE_TIMEOUT
    from ..drivers.scheme_factory import posed_perception
    from ..drivers.velocity_loop import (
        PERIOD,
        TemplateController,
        VelocityLoop,
    )

    strategy = strategy_of(settings.player(settings.role))
    dry_run = connection.dry_run
    limits = robot.limits.within(
        connection.max_speed or inf, connection.max_turn or inf
    )
    paced = robot.paced and not connection.sim_time
    session = _open_session(connection, make, robot, paced=paced)
    try:
        if not dry_run:
            session.run("prepare", PREPARE_TIMEOUT)
        eyes, robot = None, session.robot
        if settings.senses == "cameras":
            eyes = PosedSight(
                session,
                _open_camera(settings, robot, connection, needs_mount=True),
                posed_perception(connection.role, robot.head, PERIOD),
                turns_head=robot.head is not None and not dry_run,
            )
        in_python = connection.in_python
        return VelocityLoop(
            session,
            lambda: TemplateController(
                strategy, settings.gait, limits.velocities
            ),
            limits,
            paced=paced,
            source="reports of listen()" if in_python else "odometry",
            eyes=eyes,
        )
    except BaseException:
        session.close()
        raise


def _open_session(
    connection: ConnectionSettings,
    make: "Callable[[], Any]",
    robot: Any,
    *,
    paced: bool = True,
) -> "RobotSession":
    """Connect, with a guardian process if the robot can move in real time.

    The robot itself, not connected, is used if it has one client only.
    """
    from ..drivers.guardian_process import fork_guardian
    from ..drivers.method_thread import open_with_retries
    from ..drivers.robot_session import RobotSession, opened_here

    shares = robot.shares_connection
    if shares:
        open_with_retries(lambda: opened_here(robot), connection.wait)
    guardian = None
    if not connection.dry_run and robot.paced and paced:
        guardian = fork_guardian(make, robot)
    try:
        switch = _open_switch(connection)
        return open_with_retries(
            lambda: RobotSession(
                robot if shares else make(),
                opened=shares,
                guardian=guardian,
                switch=switch,
                dry_run=connection.dry_run,
            ),
            connection.wait,
        )
    except BaseException:
        if guardian is not None:
            guardian.dismiss()
        raise


def _open_switch(connection: ConnectionSettings) -> "DeadManSwitch | None":
    from ..drivers.dead_man_switch import GAMEPAD, GamepadButton, HeldKey

    name = connection.dead_man
    if name is None:
        return None
    kind, _, device = name.partition(":")
    if kind == "key":
        return HeldKey(sys.stdin)
    if kind == "gamepad":
        return GamepadButton(device or GAMEPAD)
    from ..drivers.ros2 import TopicSwitch
    from ..drivers.ros2_dds import parse_namespace

    return TopicSwitch(connection.join_domain(), parse_namespace(name))


def _check_camera(robot: Any, connection: ConnectionSettings) -> None:
    """Check that a robot has what its source of images needs."""
    from ..drivers.robot import JointRobot, Robot

    kind, joints = type(robot), isinstance(robot, JointRobot)
    if connection.images is not None and not joints:
        raise click.UsageError("images requires joint control")
    if connection.images is not None or kind.image is not Robot.image:
        return
    if connection.in_python:
        needed = f"the method image() of {kind.__name__}"
        needed += ", or images" if joints else ""
    else:
        needed = "images" if joints else "a robot with a camera"
        needed += f", got {connection.address!r}, which brings no images"
    raise click.UsageError(f"sensing by cameras requires {needed}")


def _open_camera(
    settings: "PlaySettings",
    robot: Any,
    connection: ConnectionSettings,
    *,
    needs_mount: bool = False,
) -> "RobotCamera":
    """Open the camera of a connected robot, or that of ``images``.

    Images of some robots must bring the camera's pose.
    """
    from ..drivers.robot_camera import RobotCamera, VideoCamera

    name = connection.images
    if name is None:
        return RobotCamera(robot, needs_mount=needs_mount)
    if not name.startswith(V4L2):
        raise click.UsageError(f"images must begin with {V4L2}, got {name!r}")
    colour = settings.cameras.colour
    latency = colour.latency + settings.cameras.added_latency
    path = name.removeprefix(V4L2)
    return RobotCamera(
        VideoCamera(path, colour.model(), latency=latency), apart=True
    )
