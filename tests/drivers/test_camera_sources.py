"""Test where images come from: V4L2 and ROS 2."""

import os
from collections.abc import Callable
from pathlib import Path
from time import monotonic, sleep
from typing import Any

import numpy as np
import pytest

cv2 = pytest.importorskip("cv2")

from stepaside.core.poses import Pose  # noqa: E402
from stepaside.drivers.guardian_process import SessionLost  # noqa: E402
from stepaside.drivers.image_source import (  # noqa: E402
    LiveCamera,
    open_v4l2,  # noqa: E402
    resize_model,
)
from stepaside.perception.camera_model import CameraModel  # noqa: E402
from stepaside.perception.images import ColourImage  # noqa: E402

from velocity_fakes import SimulatedUnicycle  # isort: skip  # noqa: E402

MODEL = CameraModel(320, 240, 272.0, 272.0)
TAG = f"stepaside-images-{os.getpid()}"
HALVES = np.zeros((120, 160, 3), np.uint8)  # left red, right blue
HALVES[:, :80, 0] = HALVES[:, 80:, 2] = 200


def until(done: Callable[[], Any]) -> Any:
    """Wait for a result of another thread or process."""
    end = monotonic() + 20.0
    while monotonic() < end:
        answer = done()
        if answer:
            return answer
        sleep(0.002)
    raise AssertionError("nothing came")


def check(image: Any, tolerance: float) -> None:
    """It shows the two halves, through the optics at its own size."""
    assert isinstance(image, ColourImage)
    assert image.camera == CameraModel(160, 120, 136.0, 136.0)
    off = np.abs(image.pixels.astype(float) - HALVES)
    assert off[10:-10, 10:70].max() <= tolerance
    assert off[10:-10, 90:150].max() <= tolerance


def test_a_film_stands_for_a_camera(tmp_path: Path) -> None:
    """Read as a device is, through the same library."""
    film = str(tmp_path / "film.avi")
    writer = cv2.VideoWriter(
        film, cv2.VideoWriter_fourcc(*"MJPG"), 15, (160, 120)
    )
    for _ in range(30):
        writer.write(cv2.cvtColor(HALVES, cv2.COLOR_RGB2BGR))
    writer.release()
    camera = open_v4l2(film, MODEL, latency=0.03)
    (image,) = until(lambda: camera.percepts(5.0))
    check(image, 25.0)
    assert 4.0 < image.time <= 5.0 - 0.03
    camera.close()


def test_a_camera_that_is_not_there_is_said(tmp_path: Path) -> None:
    with pytest.raises(SessionLost, match="no camera at"):
        open_v4l2(str(tmp_path / "video7"), MODEL, latency=0.0)
    (tmp_path / "text").write_text("no film")
    with pytest.raises(SessionLost, match="cannot be opened"):
        open_v4l2(str(tmp_path / "text"), MODEL, latency=0.0)


def test_only_the_newest_recent_image_is_returned() -> None:
    clock, images = [100.0], iter([HALVES, HALVES + 1, None])
    gone: list[bool] = []
    camera = LiveCamera(
        "made up",
        lambda: next(images),
        lambda: gone.append(True),
        MODEL,
        latency=0.05,
        clock=lambda: clock[0],
    )
    until(lambda: gone)
    clock[0] += 0.1
    (image,) = camera.percepts(2.0)
    assert isinstance(image, ColourImage)
    np.testing.assert_array_equal(image.pixels, HALVES + 1)
    assert image.time == pytest.approx(1.85)
    assert camera.percepts(2.0) == []
    camera.close()


def test_scaled_optics_see_as_far() -> None:
    half = resize_model(MODEL, 160, 120)
    np.testing.assert_allclose(half.ray(0.0, 0.0), MODEL.ray(0.0, 0.0))
    assert resize_model(MODEL, 320, 240) is MODEL


@pytest.mark.parametrize("squeezed", [False, True])
def test_a_ros2_robot_publishes_its_camera_images(squeezed: bool) -> None:
    pytest.importorskip("cyclonedds")
    from stepaside.drivers.ros2_dds import DdsParticipant
    from stepaside.drivers.ros2_images import TopicCamera
    from stepaside.drivers.ros2_server import Ros2Server, WorldClock

    dds, walker = DdsParticipant(0, tag=TAG), Seer()
    clock = WorldClock(dds)
    server = Ros2Server(dds, "/n", walker, ["a", "b"], clock, tick=0.012)
    name = "camera/image_raw" + ("/compressed" if squeezed else "")
    guess = CameraModel(320, 240, 99.0, 99.0)  # camera_info says better
    camera = TopicCamera(
        DdsParticipant(0, tag=TAG), f"/n/{name}", guess, latency=0.1
    )

    def look() -> Any:
        walker.time += 0.012
        walker.image = ColourImage(walker.time, MODEL, HALVES)
        server.speak()
        images = camera.percepts(2.0)
        return [i for i in images if i.camera.focal_x == 136.0]  # type: ignore[union-attr]

    try:
        (image,) = until(look)
        check(image, 25.0 if squeezed else 0.0)
        assert image.time == pytest.approx(1.9)
    finally:
        camera.close()
        server.close()
        dds.close()


def test_images_of_topics_are_checked() -> None:
    pytest.importorskip("cyclonedds")
    from stepaside.drivers.ros2_dds import header, make
    from stepaside.drivers.ros2_images import pixels_of, unpacked

    def image(*values: Any) -> Any:
        return make("sensor_msgs/Image", header(0.0, ""), *values)

    padded = image(1, 2, "bgr8", 0, 8, [1, 2, 3, 4, 5, 6, 0, 0])
    np.testing.assert_array_equal(pixels_of(padded), [[[3, 2, 1], [6, 5, 4]]])
    grey = image(1, 2, "mono8", 0, 2, [7, 9])
    np.testing.assert_array_equal(pixels_of(grey), [[[7] * 3, [9] * 3]])
    for message in (
        image(1, 2, "bayer", 0, 2, [7, 9]),
        image(1, 2, "rgb8", 0, 6, [7, 9]),
        image(9999, 2, "mono8", 0, 2, [7, 9]),
        image(1, 2, "rgb8", 0, 4, [7, 9, 1, 1]),
    ):
        assert pixels_of(message) is None
    for data in ([1, 2, 3], []):
        squeezed = make(
            "sensor_msgs/CompressedImage", header(0.0, ""), "jpeg", data
        )
        assert unpacked(squeezed) is None


class Seer(SimulatedUnicycle):
    """A made-up walker with a camera."""

    def __init__(self) -> None:
        super().__init__()
        self.image: ColourImage | None = None
        self.pose = Pose(0.0, 0.0, 0.0)

    def state(self) -> Any:
        """Own state and sighting."""
        return super().state()._replace(image=self.image)
