"""Opening the cameras that ``stepaside play`` is told of."""

from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from ..drivers.cameras.source import PerceptSource
    from ..drivers.lola.address import Address
    from ..games.settings import DuelSettings

V4L2, NAOQI, ROS2 = "v4l2:", "naoqi:", "ros2:"


def open_cameras(
    settings: "DuelSettings", robot: "Address", options: dict[str, Any]
) -> "PerceptSource":
    """Open the cameras that a robot is played with.

    Args:
        settings: Which optics they have, and how late their images are.
        robot: Where the robot listens.
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
        from ..drivers.naoqi.address import parse_url
        from ..drivers.naoqi.video import open_video

        url = parse_url(camera)
        return open_video(url, model, rate=seen.rate, latency=latency)
    if camera.startswith(ROS2):
        from ..drivers.ros2.address import parse_namespace
        from ..drivers.ros2.domain import Dds
        from ..drivers.ros2.images import TopicCamera

        topic = parse_namespace(camera)
        dds = Dds(options["domain"], beyond=options["network"])
        return TopicCamera(dds, topic, model, latency=latency)
    raise click.BadParameter(
        f"must begin with {V4L2}, {NAOQI} or {ROS2}, got {camera!r}",
        param_hint="--images",
    )


def _beside(robot: "Address") -> "PerceptSource":
    """What a simulated robot shows beside its socket."""
    from ..drivers.lola.camera_channel import CameraChannel

    if robot.cameras is None:
        raise click.UsageError(
            "--images is needed: a robot behind a host and a port shows no "
            "images beside it"
        )
    return CameraChannel(robot.cameras)
