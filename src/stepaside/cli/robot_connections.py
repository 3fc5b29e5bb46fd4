"""Connections of ``stepaside play`` to its robot."""

from math import inf
from typing import TYPE_CHECKING, Any

import click

from .connection_settings import ConnectionSettings, with_feedback

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..control.scheme import ControlScheme
    from ..drivers.dead_man_switch import DeadManSwitch
    from ..drivers.guardian_process import Guardian
    from ..drivers.joint_body import JointBody
    from ..drivers.joint_loop import JointLoop
    from ..drivers.joint_robot import JointRobot
    from ..drivers.robot_session import RobotSession
    from ..drivers.velocity_loop import VelocityLoop
    from ..drivers.velocity_robot import VelocityRobot
    from ..games.duel_settings import DuelSettings
    from ..robots.description import RobotDescription

# Methods that halt a robot, and times without control before its guardian
# acts, in [s].
RELEASE, STOP = "release", "stop"
JOINT_SILENCE, VELOCITY_SILENCE = 0.3, 0.5


def open_loop(
    settings: "DuelSettings",
    connection: ConnectionSettings,
    make: "Callable[[], Any]",
) -> "JointLoop | VelocityLoop":
    """Connect to a robot, and return its control loop.

    Args:
        settings: Settings of the player.
        connection: Connection to the robot.
        make: Function that makes the robot.
    """
    from ..drivers.joint_robot import JointRobot

    if isinstance(make(), JointRobot):
        return _open_joints(settings, connection, make)
    return _open_velocity(settings, connection, make)


def _open_joints(
    settings: "DuelSettings",
    connection: ConnectionSettings,
    make: "Callable[[], JointRobot]",
) -> "JointLoop":
    """Connect to a robot that is driven by its joints."""
    from ..drivers.joint_body import JointBody
    from ..drivers.joint_loop import JointLoop
    from ..drivers.joint_robot import motors_of
    from ..drivers.scheme_factory import policy_gains
    from ..locomotion.policy.legs_loader import load_policy
    from ..robots.description import load_robot
    from .camera_connections import check_camera, open_eyes

    description, robot = load_robot(connection.description), make()
    legs, gains = settings.legs, None
    sees = settings.sensing == "cameras"
    if sees:
        check_camera(robot, connection)
    motors = motors_of(robot, description)
    if legs.walks:
        if not robot.takes_gains:
            raise click.UsageError(
                "--legs requires a robot that takes gains, got "
                f"{connection.robot!r}"
            )
        contract, _ = load_policy(legs, description)
        gains = policy_gains(contract, motors)
    else:
        settings = with_feedback(settings)
    make_scheme = _scheme_factory(settings, connection, description, robot)

    def open_body(scheme: "ControlScheme") -> "JointBody":
        session = open_session(connection, make, robot, RELEASE)
        try:
            eyes = None
            if sees:
                eyes = open_eyes(settings, session.robot, connection)
            return JointBody(
                session,
                motors,
                scheme.joint_targets,
                gains=gains,
                eyes=eyes,
                needs_forces=not legs.walks,
                dry_run=connection.dry_run,
            )
        except BaseException:
            session.close(halts=False)
            raise

    strategy = connection.strategy(settings)
    return JointLoop(
        open_body, strategy, make_scheme, dry_run=connection.dry_run
    )


def _open_velocity(
    settings: "DuelSettings",
    connection: ConnectionSettings,
    make: "Callable[[], VelocityRobot]",
) -> "VelocityLoop":
    """Connect to a robot with its own walking controller."""
    from ..drivers.robot_session import PREPARE_TIMEOUT
    from ..drivers.velocity_loop import TemplateController, VelocityLoop
    from ..drivers.watchdog import WatchSettings
    from .camera_connections import check_camera, open_camera_sight

    robot, sees = make(), settings.sensing == "cameras"
    if sees:
        check_camera(robot, connection)
    strategy = connection.strategy(settings)
    limits = robot.limits.within(
        connection.max_speed or inf, connection.max_turn or inf
    )
    paced = robot.paced and not connection.sim_time
    session = open_session(connection, make, robot, STOP, paced=paced)
    try:
        if not connection.dry_run:
            session.run("prepare", PREPARE_TIMEOUT)
        eyes = None
        if sees:
            eyes = open_camera_sight(settings, session, connection)
        in_python = connection.in_python
        return VelocityLoop(
            session,
            lambda: TemplateController(
                strategy, settings.gait, limits.velocities
            ),
            limits,
            WatchSettings(
                paced=paced,
                source="reports of listen()" if in_python else "odometry",
            ),
            eyes=eyes,
        )
    except BaseException:
        session.close()
        raise


def open_session(
    connection: ConnectionSettings,
    make: "Callable[[], Any]",
    robot: Any,
    halting: str,
    *,
    paced: bool = True,
) -> "RobotSession":
    """Connect to a robot, with a guardian process if it can move.

    Args:
        connection: Connection to the robot.
        make: Function that makes the robot.
        robot: The robot, not connected; used if it has one client only.
        halting: Its method that stops or releases it.
        paced: Whether its clock runs in real time.
    """
    from ..drivers.guardian_process import open_with_retries
    from ..drivers.robot_session import RobotSession, opened_here

    shares = getattr(robot, "shares_connection", False)
    if shares:
        open_with_retries(lambda: opened_here(robot), connection.wait)
    guardian = None
    if not connection.dry_run and robot.paced and paced:
        guardian = _guardian_of(make, robot, halting)
    try:
        switch = None
        if connection.dead_man is not None:
            switch = open_switch(connection.dead_man, connection)
        return open_with_retries(
            lambda: RobotSession(
                robot if shares else make(),
                halting,
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


def _guardian_of(
    make: "Callable[[], Any]", robot: Any, halting: str
) -> "Guardian | None":
    """Fork the guardian of a robot, before connecting starts threads."""
    from ..drivers.guardian_process import Guardian
    from ..drivers.robot_session import fork_guardian, join_halter

    if halting == STOP:
        if robot.keeps_walking:
            return fork_guardian(
                lambda: join_halter(make, halting), VELOCITY_SILENCE
            )
        # It stops by itself when the guardian has ended a frozen control.
        return fork_guardian(lambda: lambda: None, VELOCITY_SILENCE)
    if not robot.keeps_targets:
        return None
    if robot.shares_connection:
        return Guardian(lambda _: robot.release(), JOINT_SILENCE)
    return fork_guardian(lambda: join_halter(make, halting), JOINT_SILENCE)


def open_switch(name: str, connection: ConnectionSettings) -> "DeadManSwitch":
    """Open a dead-man switch by its name."""
    import sys

    from ..drivers.dead_man_switch import GAMEPAD, GamepadButton, HeldKey

    kind, _, device = name.partition(":")
    if name == "key":
        return HeldKey(sys.stdin)
    if kind == "gamepad":
        return GamepadButton(device or GAMEPAD)
    from ..drivers.ros2 import TopicSwitch
    from ..drivers.ros2_dds import parse_namespace

    return TopicSwitch(connection.join_domain(), parse_namespace(name))


def _scheme_factory(
    settings: "DuelSettings",
    connection: ConnectionSettings,
    description: "RobotDescription",
    robot: "JointRobot",
) -> "Callable[..., ControlScheme]":
    """Return the factory of the controller, with or without learned legs."""
    from ..drivers.scheme_factory import (
        control_scheme_factory,
        policy_scheme_factory,
    )

    gait = settings.gait
    sees_as = connection.role if settings.sensing == "cameras" else None
    if settings.legs.walks:
        return policy_scheme_factory(
            description, settings.legs, gait, tick=robot.tick, sees_as=sees_as
        )
    return control_scheme_factory(
        description,
        gait,
        settings.control,
        tick=robot.tick,
        delay_ticks=connection.delay_ticks,
        sees_as=sees_as,
    )
