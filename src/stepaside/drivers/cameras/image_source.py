"""What a camera of a robot is to whoever plays it."""

import logging
from collections.abc import Callable
from threading import Event, Thread
from time import monotonic
from typing import NamedTuple, Protocol

from ...perception.camera_model import CameraModel
from ...perception.images import ColourImage, Percept, Pixels

JOINING = 2.0  # longest time that letting go takes, in [s]
STALE = 1.0  # age at which an image says nothing any more, in [s]
log = logging.getLogger(__name__)


class ImageSource(Protocol):
    """Cameras of a robot."""

    def percepts(self, frame: int, now: float, tick: float) -> list[Percept]:
        """What has arrived since the last call, oldest first.

        Args:
            frame: Number of the robot's newest sensor frame.
            now: Its time, in [s].
            tick: Time from one frame to the next, in [s].
        """

    def close(self) -> None:
        """Stop looking."""


class CameraFrame(NamedTuple):
    """An image as it came from a camera.

    Attributes:
        pixels: Red, green and blue. Shape (height, width, 3).
        at: When it came, on this computer's clock, in [s].
    """

    pixels: Pixels
    at: float


class LiveCamera:
    """A camera that is waited for by a thread of its own.

    Only the newest image counts: who is slow misses some. Its exposure is
    taken to have been some time before it came.

    Attributes:
        model: Optics; scaled to the size of the images that come.
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
        """Begin to look.

        Args:
            name: Of the camera, for messages.
            grab: Waits for an image; None where there will be no more.
            let_go: Closes the camera; called by the thread that grabs.
            model: Optics.
            latency: From exposure to the image in hand, in [s].
            clock: Time of this computer, in [s].
        """
        self._name, self._grab, self._let_go = name, grab, let_go
        self.model, self._latency, self._clock = model, latency, clock
        self._newest: CameraFrame | None = None
        self._ended = Event()
        self._thread = Thread(target=self._look, name=name, daemon=True)
        self._thread.start()

    def percepts(self, frame: int, now: float, tick: float) -> list[Percept]:
        """The newest image, if it is new."""
        newest, self._newest = self._newest, None
        if newest is None:
            return []
        age = self._clock() - newest.at + self._latency
        if age > STALE:
            return []
        height, width = newest.pixels.shape[:2]
        model = scaled(self.model, width, height)
        return [ColourImage(now - age, model, newest.pixels)]

    def close(self) -> None:
        """Stop looking, and wait until the camera is let go."""
        self._ended.set()
        self._thread.join(JOINING)

    def _look(self) -> None:
        try:
            while not self._ended.is_set():
                pixels = self._grab()
                if pixels is None:
                    log.warning(
                        "camera %s gives no image any more", self._name
                    )
                    return
                self._newest = CameraFrame(pixels, self._clock())
        except Exception as error:  # whatever a camera's library raises
            log.warning("camera %s is lost: %s", self._name, error)
        finally:
            self._let_go()


def scaled(model: CameraModel, width: int, height: int) -> CameraModel:
    """The same optics with another number of pixels.

    Args:
        model: Optics.
        width: Columns.
        height: Rows.
    """
    if (model.width, model.height) == (width, height):
        return model
    across, down = width / model.width, height / model.height
    return CameraModel(
        width, height, model.focal_x * across, model.focal_y * down
    )
