"""Connections of ``stepaside play`` to robots with velocity commands."""

from typing import TYPE_CHECKING, NamedTuple

import click

from .connection_settings import (
    LOLA,
    NAOQI,
    RCSS,
    ROS2,
    ConnectionSettings,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..drivers.dead_man_switch import DeadManSwitch
    from ..drivers.robot_loader import RobotClass
    from ..drivers.velocity.velocity_body import VelocityBody
    from ..drivers.velocity.velocity_limits import VelocityLimits
    from ..drivers.velocity.velocity_loop import VelocityLoop
    from ..games.duel_settings import DuelSettings


class VelocityConnection(NamedTuple):
    """Ways to connect to a robot with its own walking controller.

    Attributes:
        open_body: Function that connects to the robot.
        join: Function that connects in the guardian process and returns a
            function that makes the robot rest.
        limits: Limits of the robot itself.
    """

    open_body: "Callable[[], VelocityBody]"
    join: "Callable[[], Callable[[], None]]"
    limits: "VelocityLimits"


def open_velocity(
    settings: "DuelSettings",
    connection: ConnectionSettings,
    make: "RobotClass | None",
) -> "VelocityLoop":
    """Connect to a robot with its own walking controller.

    Args:
        settings: Settings of the player.
        connection: Connection to the robot.
        make: Class of a robot in Python; None for another.
    """
    from math import inf

    from ..drivers.velocity.template_controller import TemplateController
    from ..drivers.velocity.velocity_loop import VelocityLoop
    from ..drivers.velocity.watchdog import WatchSettings

    strategy = connection.strategy(settings)
    ways = _velocity_connection(settings, connection, make)
    limits = ways.limits.within(
        connection.max_speed or inf, connection.max_turn or inf
    )
    return VelocityLoop(
        _held(_guarded(ways, connection), connection),
        lambda: TemplateController(strategy, settings.gait, limits.velocities),
        limits,
        WatchSettings(
            paced=not connection.sim_time,
            source="odometry" if make is None else "reports of listen()",
        ),
        dry_run=connection.dry_run,
    )


def _held(
    body: "VelocityBody", connection: ConnectionSettings
) -> "VelocityBody":
    """Add the dead-man switch to a robot, if one is chosen."""
    if connection.dead_man is None:
        return body
    from ..drivers.dead_man_switch import DeadManBody

    try:
        return DeadManBody(body, open_switch(connection.dead_man, connection))
    except BaseException:
        body.close()
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
    from ..drivers.ros2.namespaces import parse_namespace
    from ..drivers.ros2.switch_topic import TopicSwitch

    return TopicSwitch(connection.join_domain(), parse_namespace(name))


def _guarded(
    ways: VelocityConnection, connection: ConnectionSettings
) -> "VelocityBody":
    """Connect to a robot, with a guardian process if it can move."""
    from ..drivers.guardian_process import open_with_retries
    from ..drivers.velocity.velocity_guardian import (
        GuardedBody,
        fork_velocity_guardian,
    )

    def open_body() -> "VelocityBody":
        return open_with_retries(ways.open_body, connection.wait)

    if connection.dry_run or connection.sim_time:
        return open_body()
    # Fork before connecting, which starts threads.
    guardian = fork_velocity_guardian(ways.join)
    try:
        return GuardedBody(open_body(), guardian)
    except BaseException:
        guardian.dismiss()
        raise


def _velocity_connection(
    settings: "DuelSettings",
    connection: ConnectionSettings,
    make: "RobotClass | None",
) -> VelocityConnection:
    """Return the ways to connect to a robot."""
    from ..drivers.velocity.velocity_limits import VelocityLimits

    robot, limits = connection.robot, VelocityLimits()
    if make is not None:
        return _adapter_connection(settings, connection, make)
    if settings.sensing == "cameras" and not robot.startswith(NAOQI):
        raise click.UsageError(
            "--sensing cameras requires a robot on LoLA or NAOqi, whose head "
            f"follows the opponent, or a class in Python, got {robot!r}; "
            "over ROS 2 the opponent's position is received on a topic"
        )
    if robot.startswith(ROS2):
        aside = connection.max_lateral or 0.0
        if aside and not (connection.max_speed and connection.max_turn):
            raise click.UsageError(
                "--max-lateral requires --max-speed and --max-turn"
            )
        limits = VelocityLimits(lateral=aside)
        return VelocityConnection(*_ros2_connection(connection), limits)
    if robot.startswith(NAOQI):
        return VelocityConnection(
            *_naoqi_connection(settings, connection), limits
        )
    raise click.BadParameter(
        f"must begin with {LOLA}, {NAOQI}, {ROS2} or {RCSS}, or be "
        f"FILE.py:CLASS, got {robot!r}",
        param_hint="--robot",
    )


def _adapter_connection(
    settings: "DuelSettings",
    connection: ConnectionSettings,
    make: "RobotClass",
) -> VelocityConnection:
    """Return the ways to connect to a robot in a user's file."""
    from ..drivers.velocity.adapter_body import (
        AdapterBody,
        connect_adapter_stopper,
    )
    from ..drivers.velocity.velocity_robot import VelocityRobot

    assert issubclass(make, VelocityRobot)  # joints are opened elsewhere

    def open_adapter() -> "VelocityBody":
        if settings.sensing == "cameras":
            from .camera_connections import open_seeing_robot

            return open_seeing_robot(settings, make, connection)
        return AdapterBody(make(), dry_run=connection.dry_run)

    return VelocityConnection(
        open_adapter, lambda: connect_adapter_stopper(make), make.limits
    )


def _ros2_connection(
    connection: ConnectionSettings,
) -> "tuple[Callable[[], VelocityBody], Callable[[], Callable[[], None]]]":
    """Return functions that connect to a ROS 2 robot, and make it rest."""
    from ..drivers.ros2.namespaces import parse_namespace

    namespace = parse_namespace(connection.robot)

    def remapping() -> dict[str, str]:
        from ..drivers.ros2.topics import parse_remapping

        return parse_remapping(connection.remap)

    def open_ros2() -> "VelocityBody":
        from ..drivers.ros2.ros2_body import Ros2Body

        return Ros2Body(
            connection.join_domain(),
            namespace,
            dry_run=connection.dry_run,
            remapping=remapping(),
            opponent=connection.opponent,
        )

    def join_ros2() -> "Callable[[], None]":
        from ..drivers.ros2.dds_domain import DdsParticipant
        from ..drivers.ros2.ros2_body import register_stopper

        return register_stopper(
            DdsParticipant(connection.domain, beyond=connection.network),
            namespace,
            remapping(),
        )

    return open_ros2, join_ros2


def _naoqi_connection(
    settings: "DuelSettings", connection: ConnectionSettings
) -> "tuple[Callable[[], VelocityBody], Callable[[], Callable[[], None]]]":
    """Return functions that connect to a NAOqi robot, and make it rest."""
    from ..drivers.naoqi.naoqi_url import parse_url

    url = parse_url(connection.robot)

    def open_naoqi() -> "VelocityBody":
        if settings.sensing == "cameras":
            from .camera_connections import open_camera_body

            return open_camera_body(settings, url, connection)
        from ..drivers.naoqi.naoqi_body import NaoqiBody

        return NaoqiBody(url, dry_run=connection.dry_run)

    def join_naoqi() -> "Callable[[], None]":
        from ..drivers.naoqi.naoqi_body import connect_stopper

        return connect_stopper(url)

    return open_naoqi, join_naoqi
