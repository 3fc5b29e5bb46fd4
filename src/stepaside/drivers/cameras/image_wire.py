"""Images on their way from a simulated robot to who plays it.

A message has a head of 52 bytes, little-endian, and the pixels after it.
The head: four letters that say what follows (``RGB8``: rows of red, green
and blue, one byte each; ``DPTH``: rows of depths in [m], float32, 0 where
nothing came back), the number of the sensor frame with which it arrived
(uint32), its age then in [s] (float64), columns and rows (uint16 each), the
focal lengths across and down in pixels, and the nearest and the farthest
depth in [m] (float64 each; 0 for colours).
"""

import struct
from math import isfinite
from typing import NamedTuple

import numpy as np

from ...core.errors import StepAsideError
from ...perception.camera_model import CameraModel
from ...perception.images import ColourImage, DepthImage

HEAD = struct.Struct("<4sIdHHdddd")
COLOUR, DEPTH = b"RGB8", b"DPTH"
PIXEL = {COLOUR: 3, DEPTH: 4}  # bytes of one
OLDEST = 10.0  # age beyond which an image says nothing, in [s]
SIZES = (8, 4096)  # columns or rows that an image can have
MOST = 1 << 23  # bytes of one image


class ImageError(StepAsideError, ValueError):
    """Bytes that are no image."""


class ImageMessage(NamedTuple):
    """One image on its way.

    Attributes:
        frame: Number of the sensor frame with which it arrived.
        age: How long before that frame it was taken, in [s].
        image: The image; its time is not known here, and zero.
    """

    frame: int
    age: float
    image: ColourImage | DepthImage


def pack_image(message: ImageMessage) -> bytes:
    """Bytes of a message."""
    frame, age, image = message
    camera = image.camera
    near = far = 0.0
    if isinstance(image, ColourImage):
        letters, data = COLOUR, image.pixels.tobytes()
    else:
        letters, data = DEPTH, image.depths.astype("<f4").tobytes()
        near, far = image.near, image.far
    size = camera.width, camera.height
    focal = camera.focal_x, camera.focal_y
    return HEAD.pack(letters, frame, age, *size, *focal, near, far) + data


class ImageReader:
    """Finds images in a stream of bytes."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self._buffer = bytearray()

    def feed(self, data: bytes) -> list[ImageMessage]:
        """Take bytes, and give the images that are whole.

        Args:
            data: What has arrived.

        Raises:
            ImageError: If the stream is none; it is not to be read on.
        """
        self._buffer += data
        found: list[ImageMessage] = []
        while len(self._buffer) >= HEAD.size:
            head = HEAD.unpack_from(self._buffer)
            size = HEAD.size + _size_of(head)
            if len(self._buffer) < size:
                break
            found.append(_image(head, bytes(self._buffer[HEAD.size : size])))
            del self._buffer[:size]
        return found


def _size_of(
    head: tuple[bytes, int, float, int, int, *tuple[float, ...]],
) -> int:
    """Bytes that follow a head, which must be one."""
    letters, _, age, width, height, *numbers = head
    low, high = SIZES
    if letters not in PIXEL:
        raise ImageError(f"an image must begin with {COLOUR!r} or {DEPTH!r}")
    if not (low <= width <= high and low <= height <= high):
        raise ImageError(f"no image has {width} by {height} pixels")
    if not all(isfinite(value) for value in (age, *numbers)):
        raise ImageError("what an image says of itself must be finite")
    focal_x, focal_y, near, far = numbers
    if not (0.0 <= age <= OLDEST and min(focal_x, focal_y) > 1.0):
        raise ImageError(f"no image has age {age} and focal length {focal_x}")
    if not 0.0 <= near <= far:
        raise ImageError(f"no depth lies from {near} to {far} m")
    size = width * height * PIXEL[letters]
    if size > MOST:
        raise ImageError(f"an image must have at most {MOST} bytes")
    return size


def _image(
    head: tuple[bytes, int, float, int, int, *tuple[float, ...]], data: bytes
) -> ImageMessage:
    letters, frame, age, width, height, *numbers = head
    focal_x, focal_y, near, far = numbers
    camera = CameraModel(width, height, focal_x, focal_y)
    if letters == COLOUR:
        pixels = np.frombuffer(data, np.uint8).reshape(height, width, 3)
        return ImageMessage(frame, age, ColourImage(0.0, camera, pixels))
    depths = np.frombuffer(data, "<f4").reshape(height, width)
    if not np.all(np.isfinite(depths)):
        raise ImageError("depths must be finite")
    image = DepthImage(0.0, camera, depths.astype(np.float32), near, far)
    return ImageMessage(frame, age, image)
