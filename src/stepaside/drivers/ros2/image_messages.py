"""Images of ROS 2 topics, and back: whole ones and compressed ones."""

from typing import Any

import numpy as np

from ...perception.camera_model import CameraModel
from ...perception.images import ColourImage, Percept, Pixels
from ..cameras.image_source import scaled
from .dds_domain import DdsParticipant, taken
from .messages import CompressedImage, Header, Image
from .topics import dds_topic

RGB, BGR, MONO = "rgb8", "bgr8", "mono8"
LARGEST = 4096  # columns or rows
DEPTH = 2  # images kept until they are taken
CHANNELS = {RGB: 3, BGR: 3, MONO: 1}


def image_message(header: Header, pixels: Pixels) -> Image:
    """An image as a message, in red, green and blue.

    Args:
        header: When and in which frame.
        pixels: Shape (height, width, 3).
    """
    height, width = pixels.shape[:2]
    data: Any = pixels.tobytes()
    return Image(header, height, width, RGB, 0, 3 * width, data)


def compressed_message(header: Header, pixels: Pixels) -> CompressedImage:
    """The same as JPEG.

    Args:
        header: When and in which frame.
        pixels: Shape (height, width, 3).
    """
    import cv2

    _, data = cv2.imencode(".jpg", cv2.cvtColor(pixels, cv2.COLOR_RGB2BGR))
    squeezed: Any = data.tobytes()
    return CompressedImage(header, "jpeg", squeezed)


def pixels_of(message: Image) -> Pixels | None:
    """Pixels of a message; None if it is no image of ours.

    Args:
        message: In ``rgb8``, ``bgr8`` or ``mono8``; rows may be padded.
    """
    channels = CHANNELS.get(message.encoding, 0)
    width, height, step = message.width, message.height, message.step
    if not channels or not (0 < width <= LARGEST and 0 < height <= LARGEST):
        return None
    data = np.frombuffer(bytes(message.data), np.uint8)
    if step < channels * width or data.size != step * height:
        return None
    rows = data.reshape(height, step)[:, : channels * width]
    pixels = rows.reshape(height, width, channels)
    if message.encoding == BGR:
        pixels = pixels[:, :, ::-1]
    return np.ascontiguousarray(np.broadcast_to(pixels, (height, width, 3)))


def unpacked(message: CompressedImage) -> Pixels | None:
    """Pixels of a compressed message; None if it is none.

    Args:
        message: JPEG or PNG.
    """
    import cv2

    data = np.frombuffer(bytes(message.data), np.uint8)
    if not data.size:
        return None
    image = cv2.imdecode(data, cv2.IMREAD_COLOR)
    if image is None or max(image.shape) > LARGEST:
        return None
    return np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2RGB), dtype=np.uint8)


class TopicCamera:
    """Images of a topic, of which the newest counts.

    Its stamps are of another clock than the robot's frames: an image is
    taken to be as old as it usually is when it arrives.
    """

    def __init__(
        self,
        dds: DdsParticipant,
        topic: str,
        model: CameraModel,
        *,
        latency: float,
    ) -> None:
        """Take part in a topic.

        Args:
            dds: Where; it is closed with the camera.
            topic: Like ``/camera/image_raw``; its last word being
                ``compressed`` says that it is.
            model: Optics; scaled to the size of the images that come.
            latency: From exposure to the image in hand, in [s].
        """
        self._dds, self._model, self._latency = dds, model, latency
        self._squeezed = topic.endswith("/compressed")
        kind: Any = CompressedImage if self._squeezed else Image
        self._reader = dds.reader(dds_topic("", topic.strip("/")), kind, DEPTH)

    def percepts(self, frame: int, now: float, tick: float) -> list[Percept]:
        """The newest image, if it is new."""
        arrived = taken(self._reader)
        if not arrived:
            return []
        newest = arrived[-1]
        pixels = unpacked(newest) if self._squeezed else pixels_of(newest)
        if pixels is None:
            return []
        height, width = pixels.shape[:2]
        model = scaled(self._model, width, height)
        return [ColourImage(now - self._latency, model, pixels)]

    def close(self) -> None:
        """Leave the topic."""
        del self._reader
        self._dds.close()
