"""Robot connections of ``stepaside play``."""

from typing import TYPE_CHECKING, Any

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
    from ..drivers.joint.joint_body import JointBody
    from ..drivers.joint.joint_loop import JointLoop
    from ..drivers.velocity.velocity_body import VelocityBody
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


def open_velocity(
    settings: "DuelSettings", connection: ConnectionSettings
) -> "VelocityLoop":
    """Connect to a robot with its own walking controller."""
    from math import inf

    from ..drivers.velocity.template_controller import TemplateController
    from ..drivers.velocity.velocity_limits import VelocityLimits
    from ..drivers.velocity.velocity_loop import VelocityLoop
    from ..drivers.velocity.watchdog import WatchSettings

    strategy = connection.strategy(settings)
    speed = connection.max_speed or inf
    limits = VelocityLimits(speed, speed, connection.max_turn or inf)
    watch = WatchSettings(paced=not connection.sim_time)
    return VelocityLoop(
        _guarded(settings, connection),
        lambda: TemplateController(strategy, settings.gait),
        limits,
        watch,
        dry_run=connection.dry_run,
    )


def _guarded(
    settings: "DuelSettings", connection: ConnectionSettings
) -> "VelocityBody":
    """Connect to a robot, with a guardian process if it can move."""
    from ..drivers.guardian_process import open_with_retries
    from ..drivers.velocity.velocity_guardian import (
        GuardedBody,
        fork_velocity_guardian,
    )

    open_once, join = _velocity_connection(settings, connection)

    def open_body() -> "VelocityBody":
        return open_with_retries(open_once, connection.wait)

    if connection.dry_run or connection.sim_time:
        return open_body()
    # Fork before connecting, which starts threads.
    guardian = fork_velocity_guardian(join)
    try:
        return GuardedBody(open_body(), guardian)
    except BaseException:
        guardian.dismiss()
        raise


def _velocity_connection(
    settings: "DuelSettings",
    connection: ConnectionSettings,
) -> "tuple[Callable[[], VelocityBody], Callable[[], Callable[[], None]]]":
    """Return functions that connect to a robot, and that make it rest."""
    robot, dry_run = connection.robot, connection.dry_run
    sees = settings.sensing == "cameras"
    if sees and not robot.startswith(NAOQI):
        raise click.UsageError(
            "--sensing cameras requires a robot on LoLA or NAOqi, whose head "
            f"follows the opponent, got {robot!r}; over ROS 2 the opponent's "
            "position is received on a topic"
        )
    if robot.startswith(ROS2):
        from ..drivers.ros2.namespaces import parse_namespace

        namespace = parse_namespace(robot)
        domain, beyond = connection.domain, connection.network

        def open_ros2() -> "VelocityBody":
            from ..drivers.ros2.ros2_body import Ros2Body

            dds = connection.join_domain()
            return Ros2Body(dds, namespace, dry_run=dry_run)

        def join_ros2() -> "Callable[[], None]":
            from ..drivers.ros2.dds_domain import DdsParticipant
            from ..drivers.ros2.ros2_body import register_stopper

            return register_stopper(
                DdsParticipant(domain, beyond=beyond), namespace
            )

        return open_ros2, join_ros2
    if robot.startswith(NAOQI):
        from ..drivers.naoqi.naoqi_url import parse_url

        url = parse_url(robot)

        def open_naoqi() -> "VelocityBody":
            if sees:
                from .camera_connections import open_camera_body

                return open_camera_body(settings, url, connection)
            from ..drivers.naoqi.naoqi_body import NaoqiBody

            return NaoqiBody(
                url,
                dry_run=dry_run,
                make_mover=connection.mover_factory(settings),
            )

        def join_naoqi() -> "Callable[[], None]":
            from ..drivers.naoqi.naoqi_body import connect_stopper

            return connect_stopper(url)

        return open_naoqi, join_naoqi
    raise click.BadParameter(
        f"must begin with {LOLA}, {NAOQI} or {ROS2}, got {robot!r}",
        param_hint="--robot",
    )
