"""Interface of image sources, and a live camera read by a thread."""

import logging
from collections.abc import Callable
from pathlib import Path
from threading import Event, Thread
from time import monotonic
from typing import NamedTuple, Protocol

import numpy as np

from ..core.errors import ConfigurationError
from ..perception.camera_model import CameraModel
from ..perception.images import ColourImage, Percept, Pixels
from .guardian_process import SessionLost

JOIN_TIMEOUT = 5.0  # for the camera's thread to end, in [s]
MAX_AGE = 1.0  # age at which an image is discarded, in [s]
DEVICE = "/dev/video"
log = logging.getLogger(__name__)


class ImageSource(Protocol):
    """One or more cameras of a robot."""

    def percepts(self, now: float) -> list[Percept]:
        """Return the images since the last call, oldest first.

        Args:
            now: Time of the robot's newest report, in [s].
        """

    def close(self) -> None:
        """Release the cameras."""


class CameraFrame(NamedTuple):
    """Image with its time of arrival.

    Attributes:
        pixels: Red, green and blue. Shape (height, width, 3).
        at: Time of arrival on this computer's clock, in [s].
    """

    pixels: Pixels
    at: float


class LiveCamera:
    """Camera read by its own thread; only the newest image is used.

    The exposure is assumed a constant latency before the arrival.

    Attributes:
        model: Optics, which are resize_model to the size of each image.
    """

    def __init__(
        self,
        name: str,
        grab: Callable[[], Pixels | None],
        let_go: Callable[[], None],
        model: CameraModel,
        *,
        latency: float,
        clock: Callable[[], float] = monotonic,
    ) -> None:
        """Start the thread.

        Args:
            name: Name of the camera, for messages.
            grab: Function that waits for an image; None at the end.
            let_go: Function that closes the camera, called by the thread.
            model: Optics.
            latency: Time from exposure to arrival, in [s].
            clock: Time of this computer, in [s].
        """
        self._name, self._grab, self._let_go = name, grab, let_go
        self.model, self._latency, self._clock = model, latency, clock
        self._newest: CameraFrame | None = None
        self._ended = Event()
        self._thread = Thread(target=self._grab_all, name=name, daemon=True)
        self._thread.start()

    def percepts(self, now: float) -> list[Percept]:
        """Return the newest image, if there is a new one."""
        newest, self._newest = self._newest, None
        if newest is None:
            return []
        age = self._clock() - newest.at + self._latency
        if age > MAX_AGE:
            return []
        height, width = newest.pixels.shape[:2]
        model = resize_model(self.model, width, height)
        return [ColourImage(now - age, model, newest.pixels)]

    def close(self) -> None:
        """Stop the thread, which closes the camera."""
        self._ended.set()
        self._thread.join(JOIN_TIMEOUT)

    def _grab_all(self) -> None:
        try:
            while not self._ended.is_set():
                pixels = self._grab()
                if pixels is None:
                    log.warning("camera %s sends no more images", self._name)
                    return
                self._newest = CameraFrame(pixels, self._clock())
        except Exception as error:  # any error of the camera's library
            log.warning("camera %s failed: %s", self._name, error)
        finally:
            self._let_go()


def resize_model(model: CameraModel, width: int, height: int) -> CameraModel:
    """Return the same optics for another image size.

    Args:
        model: Optics.
        width: Columns, in [px].
        height: Rows, in [px].
    """
    if (model.width, model.height) == (width, height):
        return model
    across, down = width / model.width, height / model.height
    return CameraModel(
        width, height, model.focal_x * across, model.focal_y * down
    )


def open_v4l2(path: str, model: CameraModel, *, latency: float) -> LiveCamera:
    """Open a camera of this computer by Video4Linux, through OpenCV.

    The device's buffer is set to one image, so that images are current. If
    the device delivers another size than requested, the optics are scaled.

    Args:
        path: Device like ``/dev/video0``, or a video file, which is read
            without pause.
        model: Optics and requested size.
        latency: Time from exposure to arrival, in [s].

    Raises:
        SessionLost: If there is no camera.
        ConfigurationError: If OpenCV is not installed.
    """
    try:
        import cv2
    except ImportError as error:
        raise ConfigurationError(
            "cameras need OpenCV: pip install 'stepaside[vision]'"
        ) from error
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
