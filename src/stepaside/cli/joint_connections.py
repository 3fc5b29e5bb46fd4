"""Connections of ``stepaside play`` to robots that are driven by joints."""

from typing import TYPE_CHECKING, Any

import click

from .connection_settings import (
    RCSS,
    ConnectionSettings,
    with_feedback,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ..control.scheme import ControlScheme
    from ..core.poses import Array
    from ..drivers.joint.adapter_link import AdapterLink
    from ..drivers.joint.frames import MotorGains
    from ..drivers.joint.joint_body import JointBody
    from ..drivers.joint.joint_loop import JointLoop
    from ..drivers.joint.joint_map import MotorTable
    from ..drivers.joint.joint_robot import JointRobot
    from ..drivers.robot_loader import RobotClass
    from ..games.duel_settings import DuelSettings
    from ..robots.description import RobotDescription


def open_joints(
    settings: "DuelSettings",
    connection: ConnectionSettings,
    make: "RobotClass | None",
) -> "JointLoop":
    """Connect to a robot for joint control.

    Args:
        settings: Settings of the player.
        connection: Connection to the robot.
        make: Class of a robot in Python; None for another.
    """
    from ..robots.description import load_robot

    description = load_robot(connection.description)
    if make is not None:
        from ..drivers.joint.joint_robot import JointRobot

        assert issubclass(make, JointRobot)  # velocities are opened elsewhere
        return _open_robot(settings, connection, description, make)
    if connection.robot.startswith(RCSS):
        make_league = _league_robot(connection, description)
        return _open_robot(settings, connection, description, make_league)
    return _open_nao(settings, connection, description)


def _open_nao(
    settings: "DuelSettings",
    connection: ConnectionSettings,
    description: "RobotDescription",
) -> "JointLoop":
    """Connect to a NAO over LoLA or NAOqi."""
    from ..control import ControlScheme
    from ..drivers.joint.joint_loop import JointLoop
    from ..drivers.lola.nao_joints import NAO_MOTORS
    from ..drivers.scheme_factory import control_scheme_factory

    if settings.legs.walks:
        raise click.UsageError(
            "--legs requires a robot that takes gains and measures joint "
            f"velocities, got {connection.robot!r}"
        )
    settings = with_feedback(settings)
    sees = settings.sensing == "cameras"
    open_robot = _joints_of(settings, connection, sees=sees)

    def open_body(scheme: "ControlScheme") -> "JointBody":
        assert isinstance(scheme, ControlScheme)  # as the factory makes it
        kinematics = scheme.kinematics
        return open_robot(kinematics.joint_names, scheme.joint_targets)

    make = control_scheme_factory(
        description,
        settings.gait,
        settings.control,
        tick=NAO_MOTORS.tick,
        delay_ticks=connection.delay_ticks,
        sees_as=connection.role if sees else None,
    )
    strategy = connection.strategy(settings)
    return JointLoop(open_body, strategy, make, dry_run=connection.dry_run)


def _league_robot(
    connection: ConnectionSettings, description: "RobotDescription"
) -> "Callable[[], JointRobot]":
    """Return a function that makes a robot of the RoboCup simulator."""
    from functools import partial

    from ..drivers.rcss.rcss_robot import (
        LeagueRobot,
        league_model_of,
        parse_rcss_address,
    )

    address = parse_rcss_address(connection.robot)
    model = league_model_of(description.speed_limits)
    return partial(
        LeagueRobot, address, model, connection.role, description.standing
    )


def _open_robot(
    settings: "DuelSettings",
    connection: ConnectionSettings,
    description: "RobotDescription",
    make: "Callable[[], JointRobot]",
) -> "JointLoop":
    """Connect to a robot that takes joint targets with gains."""
    from ..drivers.joint.adapter_link import connect_releaser, own_gains
    from ..drivers.joint.joint_body import JointBody, JointInterface
    from ..drivers.joint.joint_loop import JointLoop
    from ..drivers.joint.joint_map import motors_of
    from ..drivers.joint.stiffness_guardian import guard_release
    from ..drivers.scheme_factory import policy_gains
    from ..locomotion.policy.legs_loader import load_policy
    from ..robots.tree_cache import load_tree
    from .camera_connections import check_joint_camera, open_joint_camera

    robot, legs = make(), settings.legs
    sees = settings.sensing == "cameras"
    if sees:
        check_joint_camera(type(robot), connection)
    motors = motors_of(description, tick=robot.tick, crouch={})
    servos = description.overlay.servos.items()
    own = own_gains(
        robot, motors, {name: (x.stiffness, x.damping) for name, x in servos}
    )
    gains = None
    if legs.walks:
        contract, _ = load_policy(legs, description)
        gains = policy_gains(contract, motors, own)
    else:
        settings = with_feedback(settings)
    make_scheme = _scheme_factory(
        settings, connection, description, tick=robot.tick
    )
    names = load_tree(description).motors

    def open_body(scheme: "ControlScheme") -> "JointBody":
        guardian = None
        if not connection.dry_run and robot.keeps_targets and robot.paced:
            guardian = guard_release(lambda: connect_releaser(make))
        try:
            link = _link_to(
                make, motors, own, connection, needs_forces=not legs.walks
            )
            eyes = None
            if sees:
                eyes = open_joint_camera(settings, link, connection)
            return JointBody(
                JointInterface(link, motors, link.codec, gains, stands=True),
                dict(zip(names, scheme.joint_targets.tolist(), strict=True)),
                sight=None if sees else link,
                eyes=eyes,
                guardian=guardian,
                dry_run=connection.dry_run,
            )
        except BaseException:
            if guardian is not None:
                guardian.dismiss()
            raise

    strategy = connection.strategy(settings)
    return JointLoop(
        open_body, strategy, make_scheme, dry_run=connection.dry_run
    )


def _link_to(
    make: "Callable[[], JointRobot]",
    motors: "MotorTable",
    own: "MotorGains",
    connection: ConnectionSettings,
    *,
    needs_forces: bool,
) -> "AdapterLink":
    """Connect to a robot, with its dead man's switch if there is one."""
    from ..drivers.guardian_process import open_with_retries
    from ..drivers.joint.adapter_link import AdapterLink
    from .robot_connections import open_switch

    switch = None
    if connection.dead_man is not None:
        switch = open_switch(connection.dead_man, connection)
    return open_with_retries(
        lambda: AdapterLink(
            make(), motors, own, needs_forces=needs_forces, switch=switch
        ),
        connection.wait,
    )


def _scheme_factory(
    settings: "DuelSettings",
    connection: ConnectionSettings,
    description: "RobotDescription",
    *,
    tick: float,
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
            description, settings.legs, gait, tick=tick, sees_as=sees_as
        )
    return control_scheme_factory(
        description,
        gait,
        settings.control,
        tick=tick,
        delay_ticks=connection.delay_ticks,
        sees_as=sees_as,
    )


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
    from ..drivers.lola.lola_address import parse_address
    from ..drivers.lola.lola_connection import open_lola

    address = parse_address(robot)
    camera = partial(open_cameras, settings, connection) if sees else None
    how = SessionOptions(**session, open_eyes=camera)
    return partial(open_lola, address, how=how)
