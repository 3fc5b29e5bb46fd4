"""Camera connections of ``stepaside play``."""

from typing import TYPE_CHECKING, Any

import click

from .connection_settings import ROS2, ConnectionSettings

if TYPE_CHECKING:
    from ..drivers.camera_sight import PosedSight
    from ..drivers.image_source import ImageSource
    from ..drivers.robot_camera import PosedCamera
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
    from ..drivers.joint_robot import JointRobot
    from ..drivers.velocity_robot import VelocityRobot

    joints = isinstance(robot, JointRobot)
    base = JointRobot if joints else VelocityRobot
    kind, has_images = type(robot), type(robot).image is not base.image
    if connection.images is None and not has_images:
        if connection.in_python:
            raise click.UsageError(
                "--sensing cameras requires the method image() of "
                f"{kind.__name__}, or --images"
            )
        remedy = "--images" if joints else "a robot with a camera"
        raise click.UsageError(
            f"--sensing cameras requires {remedy}, got {connection.robot!r}, "
            "which brings no images"
        )
    if connection.images is not None and not joints and robot.camera is None:
        raise click.UsageError(
            f"--images requires camera of {kind.__name__}: "
            "CameraMount(forward, left, up, ...), the pose of the camera on "
            "the robot"
        )


def open_eyes(
    settings: "DuelSettings", robot: Any, connection: ConnectionSettings
) -> "ImageSource":
    """Open the camera in the head of a joint-driven robot.

    Args:
        settings: Settings with optics and latency of the camera.
        robot: The robot, connected.
        connection: Connection to the robot.

    Raises:
        StepAsideError: If the camera does not exist.
    """
    if connection.images is None:
        from ..drivers.robot_camera import RobotCamera

        return RobotCamera(robot, needs_mount=False)
    return _open_images(settings, connection)


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
    from ..drivers.camera_sight import PosedSight
    from ..drivers.robot_camera import MountedCamera, RobotCamera
    from ..drivers.scheme_factory import posed_perception_factory
    from ..drivers.velocity_loop import PERIOD

    robot = session.robot
    perception = posed_perception_factory(connection.role)(robot.head, PERIOD)
    camera: PosedCamera
    if connection.images is None:
        camera = RobotCamera(robot, needs_mount=True)
    else:
        source = _open_images(settings, connection)
        camera = MountedCamera(source, robot.camera)
    turns = robot.head is not None and not connection.dry_run
    return PosedSight(session, camera, perception, turns_head=turns)


def _open_images(
    settings: "DuelSettings", connection: ConnectionSettings
) -> "ImageSource":
    """Open the camera that ``--images`` names."""
    name = connection.images
    assert name is not None
    colour = settings.cameras.colour
    model = colour.model()
    latency = colour.latency + settings.cameras.added_latency
    if name.startswith(V4L2):
        from ..drivers.image_source import open_v4l2

        return open_v4l2(name.removeprefix(V4L2), model, latency=latency)
    if name.startswith(ROS2):
        from ..drivers.ros2_dds import parse_namespace
        from ..drivers.ros2_images import TopicCamera

        dds, topic = connection.join_domain(), parse_namespace(name)
        return TopicCamera(dds, topic, model, latency=latency)
    raise click.BadParameter(
        f"must begin with {V4L2} or {ROS2}, got {name!r}",
        param_hint="--images",
    )
