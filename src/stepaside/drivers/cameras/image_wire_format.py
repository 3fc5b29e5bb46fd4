"""Wire format of images from a simulated robot.

A message is a little-endian header of 52 bytes followed by the pixels. The
header holds four letters for the format (``RGB8``: rows of red, green and
blue, one byte each; ``DPTH``: rows of depths in [m], float32, 0 without an
echo; ``DPT1`` to ``DPT9``: the same of further cameras), the number of the
sensor frame with which the image arrived (uint32), its age then in [s]
(float64), columns and rows (uint16 each), the horizontal and vertical focal
lengths in [px], and the minimum and maximum depth in [m] (float64 each; 0 for
colours).
"""

import struct
from math import isfinite
from typing import NamedTuple

import numpy as np

from ...core.errors import StepAsideError
from ...perception.camera_model import CameraModel
from ...perception.images import ColourImage, DepthImage

HEADER = struct.Struct("<4sIdHHdddd")
COLOUR = b"RGB8"
DEPTH = (b"DPTH", *(b"DPT%d" % i for i in range(1, 10)))  # by the camera
PIXEL_BYTES = {COLOUR: 3} | dict.fromkeys(DEPTH, 4)
MAX_AGE = 10.0  # age of an image that is accepted, in [s]
SIZES = (8, 4096)  # range of columns and rows, in [px]
MAX_BYTES = 1 << 23  # size of one image


class ImageError(StepAsideError, ValueError):
    """Bytes that are not a valid image message."""


class ImageMessage(NamedTuple):
    """Image with the sensor frame that it belongs to.

    Attributes:
        frame: Number of the sensor frame with which it arrived.
        age: Time from exposure to that frame, in [s].
        image: The image; its time is unknown here, and zero.
    """

    frame: int
    age: float
    image: ColourImage | DepthImage


def pack_image(message: ImageMessage) -> bytes:
    """Encode a message."""
    frame, age, image = message
    camera = image.camera
    near = far = 0.0
    if isinstance(image, ColourImage):
        letters, data = COLOUR, image.pixels.tobytes()
    else:
        letters, data = (
            DEPTH[image.number],
            image.depths.astype("<f4").tobytes(),
        )
        near, far = image.near, image.far
    header = HEADER.pack(
        letters,
        frame,
        age,
        camera.width,
        camera.height,
        camera.focal_x,
        camera.focal_y,
        near,
        far,
    )
    return header + data


class ImageReader:
    """Incremental decoder of a stream of image messages."""

    def __init__(self) -> None:
        """Start with an empty buffer."""
        self._buffer = bytearray()

    def feed(self, data: bytes) -> list[ImageMessage]:
        """Add received bytes, and return the images that are complete.

        Args:
            data: Received bytes.

        Raises:
            ImageError: If the stream is invalid; it cannot be continued.
        """
        self._buffer += data
        messages: list[ImageMessage] = []
        while len(self._buffer) >= HEADER.size:
            header = HEADER.unpack_from(self._buffer)
            size = HEADER.size + _payload_size(header)
            if len(self._buffer) < size:
                break
            payload = bytes(self._buffer[HEADER.size : size])
            messages.append(_message(header, payload))
            del self._buffer[:size]
        return messages


def _payload_size(
    header: tuple[bytes, int, float, int, int, *tuple[float, ...]],
) -> int:
    """Check a header, and return the number of bytes that follow it."""
    letters, _, age, width, height, *numbers = header
    low, high = SIZES
    if letters not in PIXEL_BYTES:
        known = ", ".join(map(repr, PIXEL_BYTES))
        raise ImageError(f"an image must begin with one of {known}")
    if not (low <= width <= high and low <= height <= high):
        raise ImageError(
            f"width and height must lie in [{low}, {high}] px, got {width} "
            f"and {height} px"
        )
    if not all(isfinite(value) for value in (age, *numbers)):
        raise ImageError("numbers of an image's header must be finite")
    focal_x, focal_y, near, far = numbers
    if not (0.0 <= age <= MAX_AGE and min(focal_x, focal_y) > 1.0):
        raise ImageError(
            f"age must lie in [0, {MAX_AGE:g}] s and focal lengths exceed "
            f"1 px, got {age} s and {focal_x}, {focal_y} px"
        )
    if not 0.0 <= near <= far:
        raise ImageError(
            f"depths must satisfy 0 <= near <= far, got {near} and {far} m"
        )
    size = width * height * PIXEL_BYTES[letters]
    if size > MAX_BYTES:
        raise ImageError(
            f"an image must have at most {MAX_BYTES} bytes, got {size}"
        )
    return size


def _message(
    header: tuple[bytes, int, float, int, int, *tuple[float, ...]], data: bytes
) -> ImageMessage:
    letters, frame, age, width, height, *numbers = header
    focal_x, focal_y, near, far = numbers
    camera = CameraModel(width, height, focal_x, focal_y)
    if letters == COLOUR:
        pixels = np.frombuffer(data, np.uint8).reshape(height, width, 3)
        return ImageMessage(frame, age, ColourImage(0.0, camera, pixels))
    depths = np.frombuffer(data, "<f4").reshape(height, width)
    if not np.all(np.isfinite(depths)):
        raise ImageError("depths must be finite")
    taken, number = depths.astype(np.float32), DEPTH.index(letters)
    image = DepthImage(0.0, camera, taken, near, far, number)
    return ImageMessage(frame, age, image)
