"""NAOqi's camera service for a simulated robot.

Methods are called from threads of the messaging, by the names and with the
arguments that NAOqi's own service has. Images come in the size that the
simulated camera has, whatever was asked for.
"""

from typing import Any

import qi

from ...perception.images import ColourImage
from .service_state import WalkServiceState
from .video_client import RGB, TOP

IMAGE = "(iiiiiiriffff)"  # an image as NAOqi's messaging spells it
MICRO = 1_000_000  # microseconds in a second


class ALVideoDevice:
    """The camera over the eyes: who subscribes asks for images."""

    def __init__(self, robot: WalkServiceState) -> None:
        """Know the robot."""
        self._robot = robot
        self._handles: set[str] = set()
        self._subscribed = 0

    def subscribeCamera(
        self, name: str, camera: int, resolution: int, space: int, rate: int
    ) -> str:
        """Begin to look; what images are asked for by."""
        if camera != TOP or space != RGB:
            raise ValueError(
                f"only camera {TOP} in colour space {RGB} is offered"
            )
        with self._robot.lock:
            self._robot.calls += 1
            self._subscribed += 1
            handle = f"{name}_{self._subscribed}"
            self._handles.add(handle)
        return handle

    @qi.bind(returnType=IMAGE)  # type: ignore[untyped-decorator]
    def getImageRemote(self, handle: str) -> tuple[Any, ...]:
        """Newest image; one without pixels if there is none yet."""
        with self._robot.lock:
            self._robot.calls += 1
            if handle not in self._handles:
                raise KeyError(f"nobody subscribed as {handle}")
            image: ColourImage | None = self._robot.state.image
        height, width, data, time = 0, 0, b"", 0.0
        if image is not None:
            height, width = image.pixels.shape[:2]
            data, time = image.pixels.tobytes(), image.time
        seconds, micro = divmod(round(time * MICRO), MICRO)
        angles = (0.0, 0.0, 0.0, 0.0)
        size = (width, height, 3, RGB)
        return (*size, seconds, micro, data, TOP, *angles)

    def releaseImage(self, handle: str) -> bool:
        """Give an image back."""
        return True

    def unsubscribe(self, handle: str) -> bool:
        """Stop looking; whether anybody looked."""
        with self._robot.lock:
            known = handle in self._handles
            self._handles.discard(handle)
        return known
