"""Video4Linux cameras, or video files in their place, through OpenCV."""

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


def open_v4l2(path: str, model: CameraModel, *, latency: float) -> LiveCamera:
    """Open a camera of this computer.

    The device's buffer is set to one image, so that images are current. If
    the device delivers another size than requested, the optics are scaled.

    Args:
        path: Device like ``/dev/video0``, or a video file, which is read
            without pause.
        model: Optics and requested size.
        latency: Time from exposure to arrival, in [s].

    Raises:
        SessionLost: If there is no camera.
    """
    is_device = path.startswith(DEVICE)
    if not Path(path).exists():
        raise SessionLost(f"no camera at {path}")
    backend = cv2.CAP_V4L2 if is_device else cv2.CAP_ANY
    device = cv2.VideoCapture(path, backend)
    if not device.isOpened():
        device.release()
        raise SessionLost(f"{path} cannot be opened as a camera")
    if is_device:
        device.set(cv2.CAP_PROP_FRAME_WIDTH, model.width)
        device.set(cv2.CAP_PROP_FRAME_HEIGHT, model.height)
        device.set(cv2.CAP_PROP_BUFFERSIZE, 1)

    def grab() -> Pixels | None:
        is_read, image = device.read()
        if not is_read:
            return None
        pixels = cv2.cvtColor(image, cv2.COLOR_BGR2RGB)
        return np.asarray(pixels, dtype=np.uint8)

    return LiveCamera(path, grab, device.release, model, latency=latency)
