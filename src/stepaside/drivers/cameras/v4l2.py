"""Cameras of Video4Linux, and films in place of one, through OpenCV."""

from pathlib import Path

import numpy as np

from ...core.errors import ConfigurationError
from ...perception.camera_model import CameraModel
from ...perception.images import Pixels
from ..guardian_process import SessionLost
from .image_source import LiveCamera

try:
    import cv2
except ImportError as error:
    raise ConfigurationError(
        "cameras need OpenCV: pip install 'stepaside[vision]'"
    ) from error

DEVICE = "/dev/video"


def open_v4l2(place: str, model: CameraModel, *, latency: float) -> LiveCamera:
    """Open a camera of this computer, at the size of a model.

    A device is told to keep one image, so that none is old; what it gives
    may have another size, and the model is scaled to it.

    Args:
        place: Device like ``/dev/video0``, or a film, whose images come as
            fast as they are read.
        model: Optics and size.
        latency: From exposure to the image in hand, in [s].

    Raises:
        SessionLost: If there is no camera.
    """
    is_device = place.startswith(DEVICE)
    if not Path(place).exists():
        raise SessionLost(f"no camera at {place}")
    backend = cv2.CAP_V4L2 if is_device else cv2.CAP_ANY
    device = cv2.VideoCapture(place, backend)
    if not device.isOpened():
        device.release()
        raise SessionLost(f"{place} cannot be opened as a camera")
    if is_device:
        device.set(cv2.CAP_PROP_FRAME_WIDTH, model.width)
        device.set(cv2.CAP_PROP_FRAME_HEIGHT, model.height)
        device.set(cv2.CAP_PROP_BUFFERSIZE, 1)

    def grab() -> Pixels | None:
        there, image = device.read()
        if not there:
            return None
        pixels = cv2.cvtColor(image, cv2.COLOR_BGR2RGB)
        return np.asarray(pixels, dtype=np.uint8)

    return LiveCamera(place, grab, device.release, model, latency=latency)
