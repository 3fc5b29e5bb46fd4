"""Conversion of raw and compressed ROS 2 images, and a camera by topic."""

import logging
from time import monotonic, sleep
from typing import Any

import numpy as np

from ..perception.camera_model import CameraModel
from ..perception.images import Pixels
from .robot import CameraImage
from .robot_camera import PATIENCE, resize_model
from .ros2_dds import DdsParticipant, make, take_messages

log = logging.getLogger(__name__)
RGB, BGR, MONO = "rgb8", "bgr8", "mono8"
MAX_SIZE = 4096  # columns or rows, in [px]
POLL = 0.002  # between two looks for one, in [s]
DEPTH = 2  # images queued until they are taken
CHANNELS = {RGB: 3, BGR: 3, MONO: 1}


def image_message(head: Any, pixels: Pixels) -> Any:
    """Encode an image in ``rgb8``.

    Args:
        head: Header with stamp and frame.
        pixels: Red, green and blue. Shape (height, width, 3).
    """
    height, width = pixels.shape[:2]
    values = height, width, RGB, 0, 3 * width, pixels.tobytes()
    return make("sensor_msgs/Image", head, *values)


def compressed_message(head: Any, pixels: Pixels) -> Any:
    """Encode an image as JPEG.

    Args:
        head: Header with stamp and frame.
        pixels: Red, green and blue. Shape (height, width, 3).
    """
    import cv2

    _, data = cv2.imencode(".jpg", cv2.cvtColor(pixels, cv2.COLOR_RGB2BGR))
    return make("sensor_msgs/CompressedImage", head, "jpeg", data.tobytes())


def camera_info_message(head: Any, camera: CameraModel) -> Any:
    """Return the calibration of a camera without distortion."""
    matrix = camera.calibration_matrix
    projection = np.column_stack([matrix, np.zeros(3)])
    arrays = [m.ravel().tolist() for m in (matrix, np.eye(3), projection)]
    whole = make("sensor_msgs/RegionOfInterest", 0, 0, 0, 0, False)
    return make(
        "sensor_msgs/CameraInfo",
        *(head, camera.height, camera.width, "plumb_bob", [0.0] * 5),
        *(*arrays, 0, 0, whole),
    )


def pixels_of(message: Any) -> Pixels | None:
    """Decode an image; None if it is invalid or of another encoding.

    Args:
        message: Image in ``rgb8``, ``bgr8`` or ``mono8``; rows may be
            padded.

    Returns:
        Red, green and blue. Shape (height, width, 3).
    """
    channels = CHANNELS.get(message.encoding, 0)
    width, height, step = message.width, message.height, message.step
    if not channels or not (0 < width <= MAX_SIZE and 0 < height <= MAX_SIZE):
        return None
    data = np.frombuffer(bytes(message.data), np.uint8)
    if step < channels * width or data.size != step * height:
        return None
    rows = data.reshape(height, step)[:, : channels * width]
    pixels = rows.reshape(height, width, channels)
    if message.encoding == BGR:
        pixels = pixels[:, :, ::-1]
    return np.ascontiguousarray(np.broadcast_to(pixels, (height, width, 3)))


def unpacked(message: Any) -> Pixels | None:
    """Decode a compressed image; None if it is invalid.

    Returns:
        Red, green and blue. Shape (height, width, 3).
    """
    import cv2

    data = np.frombuffer(bytes(message.data), np.uint8)
    if not data.size:
        return None
    image = cv2.imdecode(data, cv2.IMREAD_COLOR)
    if image is None or max(image.shape) > MAX_SIZE:
        return None
    return np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2RGB), dtype=np.uint8)


class TopicCamera:
    """Camera whose images come by topic; only the newest one is used.

    Its focal lengths are those of ``camera_info`` beside the images, once
    that has arrived. The stamps may be of another clock than the robot's
    frames, so an image is assumed to be taken a constant latency before its
    arrival.
    """

    def __init__(
        self,
        dds: DdsParticipant,
        topic: str,
        model: CameraModel,
        *,
        latency: float,
    ) -> None:
        """Subscribe to a topic."""
        self._dds, self._model, self._latency = dds, model, latency
        self._topic = topic
        # As ROS has it, beside the images.
        beside = topic.removesuffix("/compressed").rpartition("/")[0]
        self._calibrations = dds.reader(
            f"{beside}/camera_info", "sensor_msgs/msg/CameraInfo"
        )
        self._is_compressed = topic.endswith("/compressed")
        kind = "CompressedImage" if self._is_compressed else "Image"
        self._reader = dds.reader(topic, f"sensor_msgs/msg/{kind}", DEPTH)

    def image(self) -> CameraImage | None:
        """Return the newest image, if there is a new one."""
        end = monotonic() + PATIENCE
        while not (arrived := take_messages(self._reader)):
            if monotonic() > end:
                return None
            sleep(POLL)
        now = monotonic() - self._latency
        for info in take_messages(self._calibrations)[-1:]:
            self._calibrate(info)
        newest = arrived[-1]
        pixels = unpacked(newest) if self._is_compressed else pixels_of(newest)
        if pixels is None:
            return None
        height, width = pixels.shape[:2]
        model = resize_model(self._model, width, height)
        return CameraImage(now, pixels, model.focal_x, model.focal_y)

    def _calibrate(self, info: Any) -> None:
        """Take the focal lengths of a calibration, if it has any."""
        focal_x, focal_y = float(info.k[0]), float(info.k[4])
        if not (info.width and info.height and focal_x > 0.0 < focal_y):
            return
        model = CameraModel(info.width, info.height, focal_x, focal_y)
        if model == self._model:
            return
        self._model = model
        log.info(
            "%s: focal lengths %.1f and %.1f px, by camera_info",
            *(self._topic, focal_x, focal_y),
        )
        if any(info.d):
            log.warning(
                "%s has distortion, which is not corrected: choose the "
                "rectified images",
                self._topic,
            )

    def close(self) -> None:
        """Unsubscribe and leave DDS."""
        del self._reader, self._calibrations
        self._dds.close()
