"""Camera connections of ``stepaside play``."""

from typing import TYPE_CHECKING

import click

from .connection_settings import ConnectionSettings

if TYPE_CHECKING:
    from ..drivers.cameras.image_source import ImageSource
    from ..drivers.cameras.robot_camera import PosedCamera
    from ..drivers.joint.adapter_link import AdapterLink
    from ..drivers.joint.joint_robot import JointRobot
    from ..drivers.velocity.velocity_body import VelocityBody
    from ..drivers.velocity.velocity_robot import VelocityRobot
    from ..games.duel_settings import DuelSettings

V4L2, NAOQI, ROS2 = "v4l2:", "naoqi:", "ros2:"


def open_cameras(
    settings: "DuelSettings",
    connection: ConnectionSettings,
) -> "ImageSource":
    """Open the camera that supplies images of the opponent.

    Args:
        settings: Settings with optics and latency of the camera.
        connection: Connection to the robot.

    Raises:
        StepAsideError: If the camera does not exist.
    """
    camera = connection.images
    colour = settings.cameras.colour
    model = colour.model()
    latency = colour.latency + settings.cameras.added_latency
    if camera is None:
        raise click.UsageError("--sensing cameras requires --images")
    if camera.startswith(V4L2):
        from ..drivers.cameras.v4l2 import open_v4l2

        device = camera.removeprefix(V4L2)
        return open_v4l2(device, model, latency=latency)
    if camera.startswith(NAOQI):
        from ..drivers.naoqi.naoqi_url import parse_url
        from ..drivers.naoqi.video_client import open_video

        url = parse_url(camera)
        return open_video(url, model, rate=colour.rate, latency=latency)
    if camera.startswith(ROS2):
        from ..drivers.ros2.image_messages import TopicCamera
        from ..drivers.ros2.namespaces import parse_namespace

        topic = parse_namespace(camera)
        return TopicCamera(
            connection.join_domain(), topic, model, latency=latency
        )
    raise click.BadParameter(
        f"must begin with {V4L2}, {NAOQI} or {ROS2}, got {camera!r}",
        param_hint="--images",
    )


def open_camera_body(
    settings: "DuelSettings", url: str, connection: ConnectionSettings
) -> "VelocityBody":
    """Connect to a NAOqi robot and its camera.

    Args:
        settings: Settings with optics and latency of the camera.
        url: Address of the robot.
        connection: Connection to the robot.

    Raises:
        StepAsideError: If the robot cannot be reached or has no camera.
    """
    from ..drivers.naoqi.naoqi_body import NaoqiBody
    from ..drivers.scheme_factory import perception_factory
    from ..drivers.velocity.head_control import PERIOD, CameraBody
    from ..robots.description import load_robot
    from ..robots.head import load_head
    from ..robots.tree_cache import load_tree

    description = load_robot(connection.description)
    head = load_head(description)
    perception = perception_factory(connection.role)(description, PERIOD)
    dry_run = connection.dry_run
    body = NaoqiBody(
        url,
        dry_run=dry_run,
        joint_names=load_tree(description).motors,
        head=(head.yaw, head.pitch),
    )
    connection = connection.with_images(url)
    try:
        camera = open_cameras(settings, connection)
    except BaseException:
        body.close()
        raise
    return CameraBody(body, camera, perception, turns_head=not dry_run)


def open_seeing_robot(
    settings: "DuelSettings",
    make: "type[VelocityRobot]",
    connection: ConnectionSettings,
) -> "VelocityBody":
    """Connect to a robot in Python that finds its opponent by its camera.

    Args:
        settings: Settings with optics and latency of the camera.
        make: Class of the robot.
        connection: Connection to the robot.

    Raises:
        StepAsideError: If the robot cannot be reached or has no camera.
    """
    from ..drivers.cameras.robot_camera import MountedCamera, RobotCamera
    from ..drivers.scheme_factory import posed_perception_factory
    from ..drivers.velocity.adapter_body import PERIOD, AdapterBody
    from ..drivers.velocity.robot_camera_body import RobotCameraBody

    _check_camera(make, connection)
    perception = posed_perception_factory(connection.role)(make.head, PERIOD)
    robot = make()
    body = AdapterBody(robot, dry_run=connection.dry_run)
    camera: PosedCamera
    try:
        if connection.images is None:
            camera = RobotCamera(robot, needs_mount=True)
        else:
            assert make.camera is not None  # as checked
            source = open_cameras(settings, connection)
            camera = MountedCamera(source, make.camera)
    except BaseException:
        body.close()
        raise
    turns = make.head is not None and not connection.dry_run
    return RobotCameraBody(body, camera, perception, turns_head=turns)


def _check_camera(
    make: "type[VelocityRobot]", connection: ConnectionSettings
) -> None:
    """Check that a class has what its source of images needs."""
    from ..drivers.velocity.velocity_robot import VelocityRobot

    name = make.__name__
    if connection.images is None and make.image is VelocityRobot.image:
        raise click.UsageError(
            f"--sensing cameras requires the method image() of {name}, or "
            "--images"
        )
    if connection.images is not None and make.camera is None:
        raise click.UsageError(
            f"--images requires camera of {name}: CameraMount(forward, left, "
            "up, ...), the pose of the camera on the robot"
        )


def check_joint_camera(
    kind: "type[JointRobot]", connection: ConnectionSettings
) -> None:
    """Check that a joint-driven robot in Python has a source of images.

    Args:
        kind: Class of the robot.
        connection: Connection to the robot.

    Raises:
        UsageError: If it has none.
    """
    from ..drivers.joint.joint_robot import JointRobot

    if connection.images is not None or kind.image is not JointRobot.image:
        return
    if not connection.in_python:
        raise click.UsageError(
            f"--sensing cameras requires --images, got {connection.robot!r}, "
            "which tells its sightings and has no camera"
        )
    raise click.UsageError(
        f"--sensing cameras requires the method image() of {kind.__name__}, "
        "or --images"
    )


def open_joint_camera(
    settings: "DuelSettings",
    link: "AdapterLink",
    connection: ConnectionSettings,
) -> "ImageSource":
    """Open the camera in the head of a joint-driven robot in Python.

    Args:
        settings: Settings with optics and latency of the camera.
        link: Link to the robot.
        connection: Connection to the robot.

    Raises:
        StepAsideError: If the camera does not exist.
    """
    if connection.images is None:
        return link.open_camera()
    return open_cameras(settings, connection)
