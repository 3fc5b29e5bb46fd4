"""Camera connections of ``stepaside play``."""

from typing import TYPE_CHECKING, Any

import click

from .connection_settings import ROS2, ConnectionSettings

if TYPE_CHECKING:
    from ..drivers.robot import CameraMount
    from ..drivers.robot_camera import PosedSight, RobotCamera
    from ..drivers.robot_session import RobotSession
    from ..games.duel_settings import DuelSettings

V4L2 = "v4l2:"


def check_camera(robot: Any, connection: ConnectionSettings) -> None:
    """Check that a robot has what its source of images needs.

    Args:
        robot: The robot.
        connection: Connection to the robot.

    Raises:
        UsageError: If it has no camera, or does not say where it is.
    """
    from ..drivers.robot import JointRobot, Robot

    joints = isinstance(robot, JointRobot)
    kind, has_images = type(robot), type(robot).image is not Robot.image
    if connection.images is None and not has_images:
        if connection.in_python:
            raise click.UsageError(
                "sensing by cameras requires the method image() of "
                f"{kind.__name__}, or images"
            )
        remedy = "images" if joints else "a robot with a camera"
        raise click.UsageError(
            f"sensing by cameras requires {remedy}, got "
            f"{connection.address!r}, which brings no images"
        )
    if connection.images is not None and not joints and robot.camera is None:
        raise click.UsageError(
            f"images requires camera of {kind.__name__}: "
            "CameraMount(forward, left, up, ...), the pose of the camera on "
            "the robot"
        )


def open_camera(
    settings: "DuelSettings",
    robot: Any,
    connection: ConnectionSettings,
    *,
    needs_mount: bool = False,
) -> "RobotCamera":
    """Open the camera of a robot, or that of ``images``.

    Args:
        settings: Settings with optics and latency of the camera.
        robot: The robot, connected.
        connection: Connection to the robot.
        needs_mount: Whether the images must bring the camera's pose.

    Raises:
        StepAsideError: If the camera does not exist.
    """
    from ..drivers.robot_camera import RobotCamera, VideoCamera

    name = connection.images
    if name is None:
        return RobotCamera(robot, needs_mount=needs_mount)
    mount: CameraMount | None = robot.camera if needs_mount else None
    colour = settings.cameras.colour
    model = colour.model()
    latency = colour.latency + settings.cameras.added_latency
    if name.startswith(V4L2):
        path = name.removeprefix(V4L2)
        video = VideoCamera(path, model, latency=latency)
        return RobotCamera(video, apart=True, mount=mount)
    if name.startswith(ROS2):
        from ..drivers.ros2_dds import parse_namespace
        from ..drivers.ros2_images import TopicCamera

        dds, topic = connection.join_domain(), parse_namespace(name)
        camera = TopicCamera(dds, topic, model, latency=latency)
        return RobotCamera(camera, apart=True, mount=mount)
    raise click.UsageError(
        f"images must begin with {V4L2} or {ROS2}, got {name!r}"
    )


def open_camera_sight(
    settings: "DuelSettings",
    session: "RobotSession",
    connection: ConnectionSettings,
) -> "PosedSight":
    """Open the camera of a robot that is driven by velocity commands.

    Args:
        settings: Settings with optics and latency of the camera.
        session: Session with the robot.
        connection: Connection to the robot.

    Raises:
        StepAsideError: If the camera does not exist.
    """
    from ..drivers.robot_camera import PosedSight
    from ..drivers.scheme_factory import posed_perception
    from ..drivers.velocity_loop import PERIOD

    robot = session.robot
    perception = posed_perception(connection.role, robot.head, PERIOD)
    camera = open_camera(settings, robot, connection, needs_mount=True)
    turns = robot.head is not None and not connection.dry_run
    return PosedSight(session, camera, perception, turns_head=turns)
