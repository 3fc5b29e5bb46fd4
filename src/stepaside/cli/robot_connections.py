"""Connections of ``stepaside play`` to its robot."""

from math import inf
from typing import TYPE_CHECKING, Any

import click

from .connection_settings import ConnectionSettings, with_feedback

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..drivers.dead_man_switch import DeadManSwitch
    from ..drivers.joint_loop import JointLoop
    from ..drivers.robot import JointRobot, VelocityRobot
    from ..drivers.robot_session import RobotSession
    from ..drivers.velocity_loop import VelocityLoop
    from ..games.duel_settings import DuelSettings


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
    from ..drivers.robot import JointRobot

    robot = make()
    if settings.sensing == "cameras":
        from .camera_connections import check_camera

        check_camera(robot, connection)
    if isinstance(robot, JointRobot):
        return _open_joints(settings, connection, make, robot)
    return _open_velocity(settings, connection, make, robot)


def _open_joints(
    settings: "DuelSettings",
    connection: ConnectionSettings,
    make: "Callable[[], JointRobot]",
    robot: "JointRobot",
) -> "JointLoop":
    """Connect to a robot that is driven by its joints."""
    from ..drivers.joint_loop import JointLoop
    from ..drivers.motors import motors_of
    from ..drivers.scheme_factory import policy_gains, scheme_factory
    from ..locomotion.policy.policy_legs import load_policy
    from ..robots.description import load_robot
    from .camera_connections import open_camera

    description = load_robot(connection.robot)
    legs, gains = settings.legs, None
    sees = settings.sensing == "cameras"
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
        settings = with_feedback(settings)
    return JointLoop(
        lambda: open_session(connection, make, robot),
        motors,
        connection.strategy(settings),
        scheme_factory(
            description,
            settings.gait,
            legs if legs.walks else settings.control,
            tick=robot.tick,
            delay_ticks=connection.delay_ticks,
            sees_as=connection.role if sees else None,
        ),
        gains=gains,
        open_eyes=(lambda opened: open_camera(settings, opened, connection))
        if sees
        else None,
        needs_forces=not legs.walks,
        dry_run=connection.dry_run,
    )


def _open_velocity(
    settings: "DuelSettings",
    connection: ConnectionSettings,
    make: "Callable[[], VelocityRobot]",
    robot: "VelocityRobot",
) -> "VelocityLoop":
    """Connect to a robot with its own walking controller."""
    from ..drivers.robot_session import PREPARE_TIMEOUT
    from ..drivers.velocity_loop import TemplateController, VelocityLoop
    from .camera_connections import open_camera_sight

    strategy = connection.strategy(settings)
    limits = robot.limits.within(
        connection.max_speed or inf, connection.max_turn or inf
    )
    paced = robot.paced and not connection.sim_time
    session = open_session(connection, make, robot, paced=paced)
    try:
        if not connection.dry_run:
            session.run("prepare", PREPARE_TIMEOUT)
        eyes = None
        if settings.sensing == "cameras":
            eyes = open_camera_sight(settings, session, connection)
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


def open_session(
    connection: ConnectionSettings,
    make: "Callable[[], Any]",
    robot: Any,
    *,
    paced: bool = True,
) -> "RobotSession":
    """Connect to a robot, with a guardian process if it can move.

    Args:
        connection: Connection to the robot.
        make: Function that makes the robot.
        robot: The robot, not connected; used if it has one client only.
        paced: Whether its clock runs in real time.
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
        switch = None
        if connection.dead_man is not None:
            switch = open_switch(connection.dead_man, connection)
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
