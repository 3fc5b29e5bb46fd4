"""Robot connections of ``stepaside play``."""

from typing import TYPE_CHECKING, Any

import click

from .naoqi_options import mover_factory

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ..control import ControlScheme
    from ..core.poses import Array
    from ..drivers.joint.joint_body import JointBody
    from ..drivers.joint.joint_loop import JointLoop
    from ..drivers.velocity.velocity_body import VelocityBody
    from ..drivers.velocity.velocity_loop import VelocityLoop
    from ..games.duel_settings import DuelSettings
    from ..strategies import Strategy

LOLA, NAOQI, ROS2 = "lola:", "naoqi:", "ros2:"


def strategy_of(settings: "DuelSettings", role: str) -> "Strategy":
    """Load the strategy of a role."""
    from ..strategies import load_strategy

    names = {
        "pursuer": settings.pursuer_strategy,
        "evader": settings.evader_strategy,
    }
    return load_strategy(names[role], settings.strategy)


def open_joints(
    settings: "DuelSettings", options: dict[str, Any]
) -> "JointLoop":
    """Connect to a robot for joint control."""
    from ..drivers.joint.joint_loop import JointLoop
    from ..drivers.lola.nao_joints import NAO_MOTORS
    from ..drivers.scheme_factory import control_scheme_factory
    from ..robots.description import load_robot
    from .feedback_default import with_feedback

    settings = with_feedback(settings)
    role, dry_run = options["role"], options["dry_run"]
    strategy = strategy_of(settings, role)
    sees = settings.sensing == "cameras"
    open_robot = _joints_of(settings, options, sees=sees)

    def open_body(scheme: "ControlScheme") -> "JointBody":
        kinematics = scheme.kinematics
        return open_robot(kinematics.joint_names, scheme.joint_targets)

    make = control_scheme_factory(
        load_robot(options["description"]),
        settings.gait,
        settings.control,
        tick=NAO_MOTORS.tick,
        delay_ticks=options["delay_ticks"],
        sees_as=role if sees else None,
    )
    return JointLoop(open_body, strategy, make, dry_run=dry_run)


def _joints_of(
    settings: "DuelSettings", options: dict[str, Any], *, sees: bool
) -> "Callable[[Sequence[str], Array], JointBody]":
    """Return a function that connects, given joint names and stance."""
    from functools import partial

    from ..drivers.joint.session_options import SessionOptions
    from .camera_connections import open_cameras

    robot = options["robot"]
    session: dict[str, Any] = {
        "dry_run": options["dry_run"],
        "guarded": True,
        "patience": options["wait"],
    }
    if robot.startswith(NAOQI):
        from ..drivers.naoqi.joint_connection import open_joints as open_naoqi
        from ..drivers.naoqi.naoqi_url import parse_url

        url = parse_url(robot)
        options = options | {"images": options["images"] or f"{NAOQI}{url}"}
        camera = (
            partial(open_cameras, settings, None, options) if sees else None
        )
        how = SessionOptions(**session, open_eyes=camera)
        return partial(open_naoqi, url, how=how)
    from ..drivers.lola.lola_address import parse_address
    from ..drivers.lola.lola_connection import open_lola

    address = parse_address(robot)
    camera = (
        partial(open_cameras, settings, address, options) if sees else None
    )
    how = SessionOptions(**session, open_eyes=camera)
    return partial(open_lola, address, how=how)


def open_velocity(
    settings: "DuelSettings", options: dict[str, Any]
) -> "VelocityLoop":
    """Connect to a robot with its own walking controller."""
    from math import inf

    from ..drivers.velocity.template_controller import TemplateController
    from ..drivers.velocity.velocity_limits import VelocityLimits
    from ..drivers.velocity.velocity_loop import VelocityLoop
    from ..drivers.velocity.watchdog import WatchSettings

    strategy = strategy_of(settings, options["role"])
    speed = options["max_speed"] or inf
    limits = VelocityLimits(speed, speed, options["max_turn"] or inf)
    watch = WatchSettings(paced=not options["sim_time"])
    return VelocityLoop(
        _guarded(settings, options),
        lambda: TemplateController(strategy, settings.gait),
        limits,
        watch,
        dry_run=options["dry_run"],
    )


def _guarded(
    settings: "DuelSettings", options: dict[str, Any]
) -> "VelocityBody":
    """Connect to a robot, with a guardian process if it can move."""
    from ..drivers.guardian_process import open_with_retries
    from ..drivers.velocity.velocity_guardian import (
        GuardedBody,
        fork_velocity_guardian,
    )

    open_once, join = _velocity_connection(settings, options)

    def open_body() -> "VelocityBody":
        return open_with_retries(open_once, options["wait"])

    if options["dry_run"] or options["sim_time"]:
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
    options: dict[str, Any],
) -> "tuple[Callable[[], VelocityBody], Callable[[], Callable[[], None]]]":
    """Return functions that connect to a robot, and that make it rest."""
    robot, dry_run = options["robot"], options["dry_run"]
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
        domain, beyond = options["domain"], options["network"]

        def open_ros2() -> "VelocityBody":
            from ..drivers.ros2.ros2_body import Ros2Body
            from .ros2_hints import join_domain

            dds = join_domain(options)
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

                return open_camera_body(settings, url, options)
            from ..drivers.naoqi.naoqi_body import NaoqiBody

            return NaoqiBody(
                url,
                dry_run=dry_run,
                make_mover=mover_factory(settings, options),
            )

        def join_naoqi() -> "Callable[[], None]":
            from ..drivers.naoqi.naoqi_body import connect_stopper

            return connect_stopper(url)

        return open_naoqi, join_naoqi
    raise click.BadParameter(
        f"must begin with {LOLA}, {NAOQI} or {ROS2}, got {robot!r}",
        param_hint="--robot",
    )
