"""Test cameras of robots in Python: images, their faults, and sightings."""

import logging
import os
import re
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from math import atan2, degrees, hypot, inf, nan
from pathlib import Path
from threading import Event, Thread
from time import monotonic, sleep
from typing import Any

import numpy as np
import pytest
from simulated_walker import SimulatedWalker

from stepaside.core.poses import Pose, wrap_angle
from stepaside.drivers.method_thread import SessionLost
from stepaside.drivers.robot import CameraImage, CameraMount
from stepaside.drivers.robot_camera import (
    OLDEST,
    RobotCamera,
    VideoCamera,
    colour_image,
)
from stepaside.drivers.robot_session import RobotSession
from stepaside.drivers.velocity_loop import PERIOD
from stepaside.perception.camera_model import CameraModel
from stepaside.perception.images import ColourImage
from stepaside.perception.measurement import RobotState
from velocity_fakes import SimulatedUnicycle, until

MOUNT = CameraMount(0.1, 0.0, 1.2)
PIXELS = np.zeros((120, 160, 3), np.uint8)
LONGEST = 60.0  # for what takes milliseconds, in [s]


def image(time: float = 5.0, **changes: Any) -> CameraImage:
    """A valid image."""
    return CameraImage(time, PIXELS, 140.0, 140.0, MOUNT)._replace(**changes)


class Filming:
    """Robot whose image() does what a test wants."""

    def __init__(self, *images: Any) -> None:
        self.images = iter(images)

    def image(self) -> Any:
        """The next image; none at the end."""
        return next(self.images, None)

    def close(self) -> None:
        """Do nothing."""


def taken(
    camera: RobotCamera, done: Callable[[list[CameraImage]], bool]
) -> list[CameraImage]:
    """The images that arrive until something is so."""
    found: list[CameraImage] = []
    deadline = monotonic() + LONGEST
    while not done(found):
        assert monotonic() < deadline
        got = camera.take(5.0)
        if got is not None:
            found.append(got)
        sleep(0.002)
    return found


def never(found: list[CameraImage]) -> bool:
    """Wait for an error."""
    return False


def test_an_image_is_passed_on_once() -> None:
    robot = Filming(image(), image(), None, image(5.1))
    camera = RobotCamera(robot, needs_mount=True)
    found = taken(camera, lambda found: len(found) == 2)
    assert [each.time for each in found] == [5.0, 5.1]


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"pixels": PIXELS[:, :, 0]}, "uint8, of shape .height, width, 3"),
        ({"pixels": PIXELS / 255.0}, "got float64"),
        ({"pixels": PIXELS[:4]}, "8 to 4096 a side"),
        ({"focal_x": 1.2}, "focal_x must be in pixels of this image, 160"),
        ({"focal_y": nan}, "focal_y must be in pixels"),
        ({"time": nan}, "time must be finite"),
        ({"time": 5.0 - OLDEST - 0.1}, "0.60 s old by the clock of listen"),
        ({"time": 1.7e9}, "s old by the clock of listen"),
        ({"mount": None}, "mount is missing"),
        ({"mount": MOUNT._replace(up=1200.0)}, "in millimetres"),
        ({"mount": MOUNT._replace(pitch=degrees(0.4))}, "are they degrees"),
        ({"mount": MOUNT._replace(yaw=nan)}, "mount must be finite"),
    ],
)
def test_an_invalid_image_is_refused_with_the_method(
    changes: dict[str, Any], said: str, caplog: pytest.LogCaptureFixture
) -> None:
    robot = Filming(*[image(**changes)] * 2)
    camera = RobotCamera(robot, needs_mount=True)
    with caplog.at_level(logging.WARNING):
        said_why = taken(camera, lambda _: camera.hindrance[:8] == "image():")
    assert said_why == []
    (record,) = caplog.records
    assert record.getMessage().startswith("image() of Filming: ")
    assert re.search(said, record.getMessage())
    assert camera.hindrance.startswith("image(): ")


@pytest.mark.parametrize("got", [3.0, PIXELS, (1.0, PIXELS)])
def test_what_is_no_image_ends_the_session(got: Any) -> None:
    camera = RobotCamera(Filming(got), needs_mount=True)
    with pytest.raises(SessionLost, match=r"image\(\) .*CameraImage"):
        taken(camera, never)


def test_an_image_that_blocks_hinders_the_robot() -> None:
    stuck = Event()
    robot = Filming(image())
    robot.image = lambda: image() if stuck.wait() else None  # type: ignore[method-assign]
    camera = RobotCamera(robot, needs_mount=True)
    camera.take(5.0)
    until(lambda: "image() has not returned for" in camera.hindrance)
    stuck.set()
    assert taken(camera, bool)


def test_silence_hinders_the_robot() -> None:
    robot = Filming(image())
    camera = RobotCamera(robot, needs_mount=True)
    assert taken(camera, bool)
    until(lambda: camera.take(5.0) or camera.hindrance)
    assert "image() returned no new image for" in camera.hindrance


class Video(Filming):
    """Camera apart from a robot, which tells its own time."""

    closed = False

    def close(self) -> None:
        """Note it."""
        self.closed = True


def test_times_of_a_camera_apart_are_those_of_this_computer() -> None:
    began = monotonic()
    video = Video()
    video.image = lambda: image(  # type: ignore[method-assign]
        monotonic() - 0.2, mount=None, focal_y=141.0
    )
    camera = RobotCamera(video, apart=True)
    got = taken(camera, bool)[0]
    assert got.mount is None
    late = monotonic() - began
    assert 5.0 - 0.2 - late <= got.time <= 5.0 - 0.2
    seen = colour_image(got)
    assert seen.time == got.time
    assert seen.camera == CameraModel(160, 120, 140.0, 141.0)
    camera.close()
    until(lambda: video.closed)


def test_the_head_follows_the_opponent_and_sightings_are_true(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of the documented robot, which turns away from a person here."""
    pytest.importorskip("cv2")
    import walker_robot
    from seeing_robot import SeeingRobot

    from stepaside.drivers.robot_camera import PosedSight
    from stepaside.drivers.scheme_factory import posed_perception

    class Slow(SeeingRobot):
        def image(self) -> CameraImage | None:
            sleep(0.03)
            return super().image()

    walker = SimulatedWalker(0, inf)

    def run() -> None:
        with suppress(OSError):  # its socket is closed at the end
            walker.run()

    thread = Thread(target=run, daemon=True)
    thread.start()
    monkeypatch.setattr(walker_robot, "PORT", walker.socket.getsockname()[1])
    robot = Slow()
    perception = posed_perception("evader", robot.head, PERIOD)
    session = RobotSession(robot)
    camera = RobotCamera(robot, needs_mount=True)
    sight = PosedSight(session, camera, perception, turns_head=True)

    def heard() -> RobotState:
        new = session.listen(LONGEST)
        assert new is not None
        return new

    def bearing() -> float:
        dx, dy = np.subtract(walker.person, walker.pose[:2])
        return wrap_angle(atan2(dy, dx) - walker.pose[2])

    def followed(turn: float) -> bool:
        """Whether head and sighting are where the opponent is."""
        sleep(PERIOD)
        report = sight.see(heard())
        session.command(partial(robot.command, 0.0, 0.0, turn))
        seen, away = report.sighting, bearing()
        far = hypot(*np.subtract(walker.person, walker.pose[:2]))
        return (
            seen is not None
            and not report.hindrance
            and abs(walker.head[0] - away) < 0.1
            and abs(seen.bearing - away) < 0.1
            and abs(seen.distance - far) < 0.15
        )

    while bearing() > -0.7:
        followed(0.3)
    until(lambda: followed(0.0))
    assert bearing() < -0.6  # it has turned away, and looks back
    monkeypatch.setattr(RobotCamera, "hindrance", "no image")
    until(lambda: sight.see(heard()).hindrance == "no image")
    robot.look = lambda yaw, pitch: 1 / 0  # type: ignore[assignment]
    with pytest.raises(SessionLost, match=r"look\(\) of Slow failed: ZeroDiv"):
        until(lambda: sight.see(heard()) and False)
    camera.close()
    session.close()
    walker.socket.close()
    thread.join(LONGEST)


MODEL = CameraModel(320, 240, 272.0, 272.0)
HALF_MODEL = CameraModel(160, 120, 136.0, 136.0)
DOMAIN = 20 + os.getpid() % 200
HALVES = np.zeros((120, 160, 3), np.uint8)  # left red, right blue
HALVES[:, :80, 0] = HALVES[:, 80:, 2] = 200


def check(image: CameraImage, tolerance: float) -> None:
    """It shows the two halves, through the optics at its own size."""
    assert (image.focal_x, image.focal_y) == (136.0, 136.0)
    off = np.abs(image.pixels.astype(float) - HALVES)
    assert off[10:-10, 10:70].max() <= tolerance
    assert off[10:-10, 90:150].max() <= tolerance


def test_a_film_stands_for_a_camera(tmp_path: Path) -> None:
    """Read as a device is, through the same library."""
    cv2 = pytest.importorskip("cv2")
    film = str(tmp_path / "film.avi")
    writer = cv2.VideoWriter(
        film, cv2.VideoWriter_fourcc(*"MJPG"), 15, (160, 120)
    )
    for _ in range(30):
        writer.write(cv2.cvtColor(HALVES, cv2.COLOR_RGB2BGR))
    writer.release()
    wide = CameraModel(320, 120, 272.0, 136.0)  # twice as fine across
    camera = VideoCamera(film, wide, latency=0.03)
    for _ in range(30):
        began = monotonic()
        image = camera.image()
        assert image is not None
        assert began <= image.time + 0.03 <= monotonic()
        check(image, 25.0)
    assert camera.image() is None
    camera.close()


def test_a_served_robot_publishes_its_camera_images() -> None:
    cv2 = pytest.importorskip("cv2")
    pytest.importorskip("cyclonedds")
    from stepaside.drivers.ros2_dds import DdsParticipant, take_messages
    from stepaside.drivers.ros2_server import Ros2Server, WorldClock

    dds, other, walker = DdsParticipant(DOMAIN), DdsParticipant(DOMAIN), Seer()
    clock = WorldClock(dds)
    server = Ros2Server(dds, "/n", walker, ["a", "b"], clock, tick=0.012)
    kinds = {
        **{"image_raw": "Image", "image_raw/compressed": "CompressedImage"},
        "camera_info": "CameraInfo",
    }
    readers = {
        name: other.reader(f"/n/camera/{name}", f"sensor_msgs/msg/{kind}")
        for name, kind in kinds.items()
    }
    got: dict[str, Any] = {}

    def look() -> bool:
        walker.time += 0.012
        walker.image = ColourImage(walker.time, HALF_MODEL, HALVES)
        server.speak()
        for name, reader in readers.items():
            for message in take_messages(reader):
                got[name] = message
        return len(got) == len(kinds)

    try:
        until(look)
    finally:
        readers.clear()
        server.close()
        dds.close()
        other.close()
    raw, info = got["image_raw"], got["camera_info"]
    assert (raw.encoding, raw.step) == ("rgb8", 3 * raw.width)
    assert raw.header.frame_id == "n/camera_optical_frame"
    pixels = np.array(raw.data, np.uint8).reshape(raw.height, raw.width, 3)
    np.testing.assert_array_equal(pixels, HALVES)
    squeezed = np.array(got["image_raw/compressed"].data, np.uint8)
    image = cv2.cvtColor(cv2.imdecode(squeezed, 1), cv2.COLOR_BGR2RGB)
    assert np.abs(image[:, 10:70].astype(float) - HALVES[:, 10:70]).max() < 25
    assert (info.k[0], info.k[4], info.width) == (136.0, 136.0, 160)


class Seer(SimulatedUnicycle):
    """A made-up walker with a camera."""

    def __init__(self) -> None:
        super().__init__()
        self.image: ColourImage | None = None
        self.pose = Pose(0.0, 0.0, 0.0)

    def state(self) -> Any:
        """Own state and sighting."""
        images = () if self.image is None else (self.image,)
        return super().state()._replace(percepts=images)
