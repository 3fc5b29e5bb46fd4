"""Connections of ``stepaside play`` to its robot and its camera."""

import sys
from math import inf
from typing import TYPE_CHECKING, Any

import click

from ..core.errors import ConfigurationError
from ..games.play_settings import LOLA, NAOQI, RCSS, ROS2, PlaySettings
from ..locomotion.control_settings import (
    OPEN_LOOP,
    STABILISED,
    ControlSettings,
)
from ..perception.camera_model import CameraModel
from ..sim.camera_settings import ColourSettings
from ..strategies import Strategy, load_strategy
from .settings import CONTROL, GIVEN
from .terminal import echo

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..drivers.dead_man_switch import DeadManSwitch
    from ..drivers.joint_loop import JointLoop
    from ..drivers.robot import JointRobot
    from ..drivers.robot_camera import RobotCamera
    from ..drivers.robot_session import RobotSession
    from ..drivers.ros2_dds import DdsParticipant
    from ..drivers.velocity_loop import VelocityLoop

V4L2 = "v4l2:"


def join_domain(domain: int | None, *, network: bool) -> "DdsParticipant":
    """Join a ROS 2 domain; print what other programs need to discover it."""
    from ..drivers.ros2_dds import LOCAL, DdsParticipant

    dds = DdsParticipant(domain, beyond=network)
    if not network:
        echo(f"stepaside: {LOCAL}", err=True)
    return dds


def _model_of(own: ColourSettings) -> CameraModel:
    return CameraModel.of_field_of_view(own.width, own.height, *own.view)


def with_feedback(control: ControlSettings) -> ControlSettings:
    """Return control with feedback unless options or settings choose it."""
    given = click.get_current_context().meta[GIVEN]
    chosen = any(path.endswith(CONTROL) for path in given)
    return control if chosen or control != OPEN_LOOP else STABILISED


def robot_maker(settings: PlaySettings) -> "Callable[[], Any]":
    """Return a function that makes the robot, without connecting."""
    if settings.in_python:
        from ..drivers.robot_loader import load_robot_class

        return load_robot_class(settings.address)
    from ..drivers.robot_loader import RobotRequest, find_robot

    name, _, address = settings.address.partition(":")
    colour = settings.cameras.colour
    make = find_robot(
        name,
        RobotRequest(
            address,
            settings.role,
            settings.robot,
            dry_run=settings.dry_run,
            camera=_model_of(colour),
            latency=colour.latency + settings.cameras.added_latency,
            lateral=settings.max_lateral or 0.0,
            domain=settings.domain,
            network=settings.network,
            remap=settings.remap,
            opponent=settings.opponent,
            people=settings.people,
        ),
    )
    if make is None:
        raise ConfigurationError(
            f"the address must begin with {LOLA}, {NAOQI}, {ROS2} or "
            f"{RCSS}, or be FILE.py:CLASS, got {settings.address!r}"
        )
    if settings.address.startswith(ROS2) and not settings.network:
        from ..drivers.ros2_dds import LOCAL

        echo(f"stepaside: {LOCAL}", err=True)
    return make


def open_loop(
    settings: PlaySettings,
    make: "Callable[[], Any]",
) -> "JointLoop | VelocityLoop":
    """Connect to the robot that a function makes; return its control loop."""
    from ..drivers.robot import JointRobot

    robot = make()
    if settings.senses == "cameras":
        _check_camera(robot, settings)
    if isinstance(robot, JointRobot):
        return _open_joints(settings, make, robot)
    return _open_velocity(settings, make, robot)


def _strategy_of(settings: PlaySettings) -> Strategy:
    strategy = load_strategy(settings.strategy, settings.evasion)
    from ..games.shields import shielded

    return shielded(strategy, settings)


def _open_joints(
    settings: PlaySettings,
    make: "Callable[[], JointRobot]",
    robot: "JointRobot",
) -> "JointLoop":
    from ..drivers.joint_loop import JointLoop
    from ..drivers.joint_motion import motors_of
    from ..drivers.scheme_factory import policy_gains, scheme_factory
    from ..locomotion.policy.policy_legs import load_policy
    from ..robots.description import load_robot

    description = load_robot(settings.robot)
    legs, gains = settings.legs, None
    sees = settings.senses == "cameras"
    motors = motors_of(robot, description)
    if legs.network:
        if not robot.takes_gains:
            raise click.UsageError(
                "legs requires a robot that takes gains, got "
                f"{settings.address!r}"
            )
        contract, _ = load_policy(legs, description)
        gains = policy_gains(contract, motors)
    return JointLoop(
        lambda: _open_session(settings, make, robot),
        motors,
        _strategy_of(settings),
        scheme_factory(
            description,
            settings.gait,
            legs if legs.network else settings.control,
            tick=robot.tick,
            delay_ticks=settings.delay_ticks,
            sees_as=settings.role if sees else None,
        ),
        gains=gains,
        open_eyes=(lambda opened: _open_camera(settings, opened))
        if sees
        else None,
        needs_forces=not legs.network,
        dry_run=settings.dry_run,
    )


def _open_velocity(
    settings: PlaySettings,
    make: "Callable[[], Any]",
    robot: Any,
) -> "VelocityLoop":
    from ..drivers.robot_camera import PosedSight
    from ..drivers.robot_session import PREPARE_TIMEOUT
    from ..drivers.scheme_factory import posed_perception
    from ..drivers.velocity_loop import (
        FORSAKEN,
        PERIOD,
        TemplateController,
        VelocityLoop,
    )
    from ..drivers.watchdog import Watchdog

    strategy, gait = _strategy_of(settings), settings.gait
    own = f"gait.speed {gait.speed:g} m/s, gait.gain {gait.gain:g} 1/s"
    if settings.evasion.trigger == "distance":
        own += f", evasion.safety_radius {settings.evasion.safety_radius:g} m"
    echo(
        f"stepaside: plays with {own}; defaults are those of "
        f"{settings.robot} (--robot FOLDER takes others)",
        err=True,
    )
    dry_run = settings.dry_run
    limits = robot.limits.within(
        settings.max_speed or inf, settings.max_turn or inf
    )
    paced = robot.paced and not settings.sim_time
    session = _open_session(settings, make, robot, paced=paced)
    try:
        if not dry_run:
            session.run("prepare", PREPARE_TIMEOUT)
        eyes, robot = None, session.robot
        if settings.senses == "cameras":
            eyes = PosedSight(
                session,
                _open_camera(settings, robot, needs_mount=True),
                posed_perception(settings.role, robot.head, PERIOD),
                turns_head=robot.head is not None and not dry_run,
            )
        in_python = settings.in_python
        on_topics = settings.address.startswith(ROS2)
        return VelocityLoop(
            session,
            lambda: TemplateController(strategy, gait, limits.velocities),
            limits,
            watchdog=Watchdog(
                paced=paced,
                source="reports of listen()" if in_python else "odometry",
                start_support=gait.start_support,
            ),
            # On topics the first message is the first connection.
            wait=settings.wait if on_topics else FORSAKEN,
            eyes=eyes,
        )
    except BaseException:
        session.close()
        raise


def _open_session(
    settings: PlaySettings,
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
        open_with_retries(lambda: opened_here(robot), settings.wait)
    guardian = None
    if not settings.dry_run and robot.paced and paced:
        guardian = fork_guardian(make, robot)
    try:
        switch = _open_switch(settings)
        return open_with_retries(
            lambda: RobotSession(
                robot if shares else make(),
                opened=shares,
                guardian=guardian,
                switch=switch,
                dry_run=settings.dry_run,
            ),
            settings.wait,
        )
    except BaseException:
        if guardian is not None:
            guardian.dismiss()
        raise


def _open_switch(settings: PlaySettings) -> "DeadManSwitch | None":
    from ..drivers.dead_man_switch import GAMEPAD, GamepadButton, HeldKey

    name = settings.dead_man
    if name is None:
        return None
    kind, _, device = name.partition(":")
    if kind == "key":
        return HeldKey(sys.stdin)
    if kind == "gamepad":
        return GamepadButton(device or GAMEPAD)
    from ..drivers.ros2 import TopicSwitch
    from ..drivers.ros2_dds import parse_namespace

    return TopicSwitch(
        join_domain(settings.domain, network=settings.network),
        parse_namespace(name),
    )


def _check_camera(robot: Any, settings: PlaySettings) -> None:
    """Check that a robot has what its source of images needs."""
    from ..drivers.robot import JointRobot, Robot

    kind, joints = type(robot), isinstance(robot, JointRobot)
    if settings.images is not None and not joints:
        raise click.UsageError("images requires joint control")
    if settings.images is not None or kind.image is not Robot.image:
        return
    if settings.in_python:
        needed = f"the method image() of {kind.__name__}"
        needed += ", or images" if joints else ""
    else:
        needed = "images" if joints else "a robot with a camera"
        needed += f", got {settings.address!r}, which brings no images"
    raise click.UsageError(f"sensing by cameras requires {needed}")


def _open_camera(
    settings: PlaySettings,
    robot: Any,
    *,
    needs_mount: bool = False,
) -> "RobotCamera":
    """Open the camera of a connected robot, or that of ``images``.

    Images of some robots must bring the camera's pose.
    """
    from ..drivers.robot_camera import RobotCamera, VideoCamera

    name = settings.images
    if name is None:
        return RobotCamera(robot, needs_mount=needs_mount)
    if not name.startswith(V4L2):
        raise click.UsageError(f"images must begin with {V4L2}, got {name!r}")
    colour = settings.cameras.colour
    latency = colour.latency + settings.cameras.added_latency
    path = name.removeprefix(V4L2)
    return RobotCamera(
        VideoCamera(path, _model_of(colour), latency=latency), apart=True
    )
