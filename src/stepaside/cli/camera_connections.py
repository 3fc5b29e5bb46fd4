"""Opening the cameras that ``stepaside play`` is told of."""

from typing import TYPE_CHECKING, Any

import click

from .naoqi_options import mover_of

if TYPE_CHECKING:
    from ..drivers.cameras.image_source import ImageSource
    from ..drivers.lola.lola_address import LolaAddress
    from ..drivers.velocity.velocity_body import VelocityBody
    from ..games.duel_settings import DuelSettings

V4L2, NAOQI, ROS2 = "v4l2:", "naoqi:", "ros2:"


def open_cameras(
    settings: "DuelSettings",
    robot: "LolaAddress | None",
    options: dict[str, Any],
) -> "ImageSource":
    """Open the cameras that a robot is played with.

    Args:
        settings: Which optics they have, and how late their images are.
        robot: Where the robot listens, if it speaks LoLA.
        options: Of the command.

    Raises:
        StepAsideError: If there is no camera.
    """
    camera = options["images"]
    seen = settings.cameras.colour
    model = seen.model()
    latency = seen.latency + settings.cameras.added_latency
    if camera is None:
        return _beside(robot)
    if camera.startswith(V4L2):
        from ..drivers.cameras.v4l2 import open_v4l2

        place = camera.removeprefix(V4L2)
        return open_v4l2(place, model, latency=latency)
    if camera.startswith(NAOQI):
        from ..drivers.naoqi.naoqi_url import parse_url
        from ..drivers.naoqi.video_client import open_video

        url = parse_url(camera)
        return open_video(url, model, rate=seen.rate, latency=latency)
    if camera.startswith(ROS2):
        from ..drivers.ros2.image_messages import TopicCamera
        from ..drivers.ros2.namespaces import parse_namespace
        from .ros2_hints import join_domain

        topic = parse_namespace(camera)
        return TopicCamera(join_domain(options), topic, model, latency=latency)
    raise click.BadParameter(
        f"must begin with {V4L2}, {NAOQI} or {ROS2}, got {camera!r}",
        param_hint="--images",
    )


def open_looking(
    settings: "DuelSettings", url: str, options: dict[str, Any]
) -> "VelocityBody":
    """Connect to a robot on NAOqi that sees by its own camera.

    Args:
        settings: Which optics it has, and how late its images are.
        url: Where it is.
        options: Of the command.

    Raises:
        StepAsideError: If there is no such robot, or it has no camera.
    """
    from ..drivers.naoqi.naoqi_body import NaoqiBody
    from ..drivers.scheme_factory import level_perception
    from ..drivers.velocity.head_control import PERIOD, CameraBody
    from ..robots.description import load_robot
    from ..robots.head import load_head

    description = load_robot(options["description"])
    head = load_head(description)
    perception = level_perception(options["role"], description, PERIOD)
    dry_run = options["dry_run"]
    body = NaoqiBody(
        url,
        dry_run=dry_run,
        joint_names=perception.forward.tree.motors,
        head=(head.yaw, head.pitch),
        make_mover=mover_of(settings, options),
    )
    own = options | {"images": options["images"] or f"{NAOQI}{url}"}
    try:
        eyes = open_cameras(settings, None, own)
    except BaseException:
        body.close()
        raise
    return CameraBody(body, eyes, perception, turns_head=not dry_run)


def _beside(robot: "LolaAddress | None") -> "ImageSource":
    """What a simulated robot shows beside its socket."""
    from ..drivers.lola.camera_channel import CameraChannel

    if robot is None or robot.cameras is None:
        raise click.UsageError(
            "--images is needed: a robot behind a host and a port shows no "
            "images beside it"
        )
    return CameraChannel(robot.cameras)
