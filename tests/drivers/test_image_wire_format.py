"""Test the wire format and channel of images."""

import struct
from pathlib import Path

import numpy as np
import pytest

from lola_fakes import JOINTS, MadeUpRobot
from stepaside.drivers.cameras.image_wire_format import (
    HEADER,
    ImageError,
    ImageMessage,
    ImageReader,
    pack_image,
)
from stepaside.drivers.guardian_process import SessionLost
from stepaside.drivers.lola.camera_socket import CameraClient, CameraServer
from stepaside.drivers.lola.listener import ClientListener
from stepaside.drivers.lola.lola_address import LolaAddress
from stepaside.drivers.lola.lola_server import LolaServer
from stepaside.perception.camera_model import CameraModel
from stepaside.perception.images import ColourImage, DepthImage
from stepaside.perception.measurement import Measurement

MODEL = CameraModel(12, 8, 10.0, 11.0)
PIXELS = np.arange(288, dtype=np.uint8).reshape(8, 12, 3)
DEPTHS = np.linspace(0.0, 3.0, 96, dtype=np.float32).reshape(8, 12)
COLOUR = ColourImage(0.0, MODEL, PIXELS)
DEPTH = DepthImage(0.0, MODEL, DEPTHS, 0.8, 3.5)
BYTES = pack_image(ImageMessage(7, 0.048, COLOUR))


def test_a_message_has_the_bytes_that_are_written_down() -> None:
    head = struct.pack(
        "<4sIdHHdddd", b"RGB8", 7, 0.048, 12, 8, 10.0, 11.0, 0.0, 0.0
    )
    assert BYTES == head + PIXELS.tobytes() and HEADER.size == 52


@pytest.mark.parametrize("step", [1, 50, 1000])
def test_images_come_back_however_the_stream_is_cut(step: int) -> None:
    data = BYTES + pack_image(ImageMessage(9, 0.5, DEPTH))
    reader, found = ImageReader(), []
    for at in range(0, len(data), step):
        found += reader.feed(data[at : at + step])
    (one, other) = found
    assert (one.frame, one.age, other.frame, other.age) == (7, 0.048, 9, 0.5)
    assert isinstance(one.image, ColourImage)
    assert isinstance(other.image, DepthImage)
    np.testing.assert_array_equal(one.image.pixels, PIXELS)
    np.testing.assert_array_equal(other.image.depths, DEPTHS)
    assert one.image.camera == other.image.camera == MODEL
    assert (other.image.near, other.image.far) == (0.8, 3.5)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        (0, b"JPEG"),
        (2, -0.1),
        (2, float("nan")),
        (3, 4),
        (4, 60000),
        (5, 0.0),
        (6, float("inf")),
        (8, -1.0),
    ],
)
def test_an_invalid_image_is_refused(field: int, value: object) -> None:
    head = list(HEADER.unpack_from(BYTES))
    head[field] = value
    with pytest.raises(ImageError):
        ImageReader().feed(HEADER.pack(*head) + BYTES[HEADER.size :])


def test_images_come_with_the_frame_that_they_belong_to(
    tmp_path: Path,
) -> None:
    offer = CameraServer(LolaAddress(str(tmp_path / "c")))
    channel = CameraClient(LolaAddress(str(tmp_path / "c")))
    seen = measured(1.0, ColourImage(0.952, MODEL, PIXELS))
    offer.send(seen, 40)
    offer.send(seen, 41)  # the same tick again: nothing new
    assert channel.percepts(39, 0.5, 0.012) == []
    (image,) = channel.percepts(41, 0.524, 0.012)
    # It arrived with frame 40, a tick ago, and was 48 ms old then.
    assert image.time == pytest.approx(0.524 - 0.012 - 0.048)
    assert channel.percepts(42, 0.536, 0.012) == []
    offer.close()
    assert channel.percepts(43, 0.548, 0.012) == []
    channel.close()


def test_images_are_dropped_for_a_client_that_does_not_read(
    tmp_path: Path,
) -> None:
    offer = CameraServer(LolaAddress(str(tmp_path / "c")))
    channel = CameraClient(LolaAddress(str(tmp_path / "c")))
    large = CameraModel(640, 480, 500.0, 500.0)
    pixels = np.zeros((480, 640, 3), np.uint8)
    for tick in range(20):
        shown = ColourImage(0.0, large, pixels)
        offer.send(measured(0.012 * tick, shown), tick)
    assert offer.missed > 0
    assert len(channel.percepts(20, 0.0, 0.012)) < 20
    channel.close()
    offer.send(measured(1.0, COLOUR), 21)
    offer.close()


def test_a_channel_that_brings_garbage_is_silent(tmp_path: Path) -> None:
    offer = ClientListener(LolaAddress(str(tmp_path / "c")))
    channel = CameraClient(LolaAddress(str(tmp_path / "c")))
    assert offer.accept()
    offer.send(b"x" * 200)
    assert channel.percepts(0, 0.0, 0.012) == []
    assert channel.percepts(1, 0.0, 0.012) == []
    channel.close()
    offer.close()


def test_a_robot_without_cameras_offers_no_images(tmp_path: Path) -> None:
    place = LolaAddress(str(tmp_path / "r"))
    server = LolaServer(place, MadeUpRobot(), JOINTS)
    assert place.cameras is not None
    with pytest.raises(SessionLost, match="no camera at"):
        CameraClient(place.cameras)
    server.close()
    server = LolaServer(place, MadeUpRobot(), JOINTS, cameras=True)
    CameraClient(place.cameras).close()
    server.close()
    assert list(tmp_path.iterdir()) == []


def measured(time: float, *percepts: ColourImage) -> Measurement:
    """Return a measurement with images."""
    sensors = MadeUpRobot().sensors()
    return sensors._replace(time=time, percepts=percepts)
