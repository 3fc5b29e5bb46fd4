"""Robot connections of ``stepaside play``."""

from typing import TYPE_CHECKING, Any, NamedTuple

import click

from .connection_settings import (
    LOLA,
    NAOQI,
    ROS2,
    ConnectionSettings,
    with_feedback,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ..control.scheme import LocomotionScheme
    from ..core.poses import Array
    from ..drivers.dead_man_switch import DeadManSwitch
    from ..drivers.joint.joint_body import JointBody
    from ..drivers.joint.joint_loop import JointLoop
    from ..drivers.velocity.velocity_body import VelocityBody
    from ..drivers.velocity.velocity_limits import VelocityLimits
    from ..drivers.velocity.velocity_loop import VelocityLoop
    from ..games.duel_settings import DuelSettings


def open_joints(
    settings: "DuelSettings", connection: ConnectionSettings
) -> "JointLoop":
    """Connect to a robot for joint control."""
    from ..control import ControlScheme
    from ..drivers.joint.joint_loop import JointLoop
    from ..drivers.lola.nao_joints import NAO_MOTORS
    from ..drivers.scheme_factory import control_scheme_factory
    from ..robots.description import load_robot

    settings = with_feedback(settings)
    strategy = connection.strategy(settings)
    sees = settings.sensing == "cameras"
    open_robot = _joints_of(settings, connection, sees=sees)

    def open_body(scheme: "LocomotionScheme") -> "JointBody":
        assert isinstance(scheme, ControlScheme)  # as the factory makes it
        kinematics = scheme.kinematics
        return open_robot(kinematics.joint_names, scheme.joint_targets)

    make = control_scheme_factory(
        load_robot(connection.description),
        settings.gait,
        settings.control,
        tick=NAO_MOTORS.tick,
        delay_ticks=connection.delay_ticks,
        sees_as=connection.role if sees else None,
    )
    return JointLoop(open_body, strategy, make, dry_run=connection.dry_run)


def _joints_of(
    settings: "DuelSettings", connection: ConnectionSettings, *, sees: bool
) -> "Callable[[Sequence[str], Array], JointBody]":
    """Return a function that connects, given joint names and stance."""
    from functools import partial

    from ..drivers.joint.session_options import SessionOptions
    from .camera_connections import open_cameras

    robot = connection.robot
    session: dict[str, Any] = {
        "dry_run": connection.dry_run,
        "guarded": True,
        "patience": connection.wait,
    }
    if robot.startswith(NAOQI):
        from ..drivers.naoqi.joint_connection import open_joints as open_naoqi
        from ..drivers.naoqi.naoqi_url import parse_url

        url = parse_url(robot)
        connection = connection.with_images(url)
        camera = (
            partial(open_cameras, settings, None, connection) if sees else None
        )
        how = SessionOptions(**session, open_eyes=camera)
        return partial(open_naoqi, url, how=how)
    from ..drivers.lola.lola_address import parse_address
    from ..drivers.lola.lola_connection import open_lola

    address = parse_address(robot)
    camera = (
        partial(open_cameras, settings, address, connection) if sees else None
    )
    how = SessionOptions(**session, open_eyes=camera)
    return partial(open_lola, address, how=how)


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
    settings: "DuelSettings", connection: ConnectionSettings
) -> "VelocityLoop":
    """Connect to a robot with its own walking controller."""
    from math import inf

    from ..drivers.velocity.template_controller import TemplateController
    from ..drivers.velocity.velocity_loop import VelocityLoop
    from ..drivers.velocity.watchdog import WatchSettings

    strategy = connection.strategy(settings)
    ways = _velocity_connection(settings, connection)
    limits = ways.limits.within(
        connection.max_speed or inf, connection.max_turn or inf
    )
    return VelocityLoop(
        _held(_guarded(ways, connection), connection),
        lambda: TemplateController(strategy, settings.gait, limits.velocities),
        limits,
        WatchSettings(paced=not connection.sim_time),
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
        return DeadManBody(body, _open_switch(connection.dead_man, connection))
    except BaseException:
        body.close()
        raise


def _open_switch(name: str, connection: ConnectionSettings) -> "DeadManSwitch":
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
) -> VelocityConnection:
    """Return the ways to connect to a robot."""
    from ..drivers.velocity.velocity_limits import VelocityLimits

    robot, limits = connection.robot, VelocityLimits()
    sees = settings.sensing == "cameras"
    if sees and not robot.startswith(NAOQI):
        raise click.UsageError(
            "--sensing cameras requires a robot on LoLA or NAOqi, whose head "
            f"follows the opponent, got {robot!r}; over ROS 2 the opponent's "
            "position is received on a topic"
        )
    if connection.in_python:
        return _adapter_connection(connection)
    if robot.startswith(ROS2):
        return VelocityConnection(*_ros2_connection(connection), limits)
    if robot.startswith(NAOQI):
        return VelocityConnection(
            *_naoqi_connection(settings, connection), limits
        )
    raise click.BadParameter(
        f"must begin with {LOLA}, {NAOQI} or {ROS2}, or be FILE.py:CLASS, "
        f"got {robot!r}",
        param_hint="--robot",
    )


def _adapter_connection(connection: ConnectionSettings) -> VelocityConnection:
    """Return the ways to connect to a robot in a user's file."""
    from ..drivers.velocity.adapter_body import (
        AdapterBody,
        connect_adapter_stopper,
    )
    from ..drivers.velocity.velocity_robot import load_velocity_robot

    make = load_velocity_robot(connection.robot)
    return VelocityConnection(
        lambda: AdapterBody(make(), dry_run=connection.dry_run),
        lambda: connect_adapter_stopper(make),
        make.limits,
    )


def _ros2_connection(
    connection: ConnectionSettings,
) -> "tuple[Callable[[], VelocityBody], Callable[[], Callable[[], None]]]":
    """Return functions that connect to a ROS 2 robot, and make it rest."""
    from ..drivers.ros2.namespaces import parse_namespace

    namespace = parse_namespace(connection.robot)

    def open_ros2() -> "VelocityBody":
        from ..drivers.ros2.ros2_body import Ros2Body

        dds = connection.join_domain()
        return Ros2Body(dds, namespace, dry_run=connection.dry_run)

    def join_ros2() -> "Callable[[], None]":
        from ..drivers.ros2.dds_domain import DdsParticipant
        from ..drivers.ros2.ros2_body import register_stopper

        return register_stopper(
            DdsParticipant(connection.domain, beyond=connection.network),
            namespace,
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

        return NaoqiBody(
            url,
            dry_run=connection.dry_run,
            make_mover=connection.mover_factory(settings),
        )

    def join_naoqi() -> "Callable[[], None]":
        from ..drivers.naoqi.naoqi_body import connect_stopper

        return connect_stopper(url)

    return open_naoqi, join_naoqi
