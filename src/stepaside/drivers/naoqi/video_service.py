"""Camera service of a simulated robot on NAOqi.

The methods have the names and arguments of NAOqi's own service, and are
called from threads of the ``qi`` library. Images have the size of the
simulated camera, not the requested one.
"""

from typing import Any

import qi

from ...perception.images import ColourImage
from .service_state import WalkServiceState
from .video_client import RGB, TOP

IMAGE = "(iiiiiiriffff)"  # signature of an image in the qi library
MICRO = 1_000_000  # microseconds in a second


class ALVideoDevice:
    """Upper camera, whose subscribers request images."""

    def __init__(self, robot: WalkServiceState) -> None:
        """Create the service of a robot."""
        self._robot = robot
        self._handles: set[str] = set()
        self._subscribed = 0

    def subscribeCamera(
        self, name: str, camera: int, resolution: int, space: int, rate: int
    ) -> str:
        """Subscribe, and return the handle by which images are requested."""
        if camera != TOP or space != RGB:
            raise ValueError(
                f"camera must be {TOP} and colour space {RGB}, got {camera} "
                f"and {space}"
            )
        with self._robot.lock:
            self._robot.calls += 1
            self._subscribed += 1
            handle = f"{name}_{self._subscribed}"
            self._handles.add(handle)
        return handle

    @qi.bind(returnType=IMAGE)  # type: ignore[untyped-decorator]
    def getImageRemote(self, handle: str) -> tuple[Any, ...]:
        """Return the newest image; one without pixels if there is none."""
        with self._robot.lock:
            self._robot.calls += 1
            if handle not in self._handles:
                raise KeyError(f"no subscription has the handle {handle}")
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
        """Release an image; does nothing here."""
        return True

    def unsubscribe(self, handle: str) -> bool:
        """Unsubscribe; return whether the handle was valid."""
        with self._robot.lock:
            known = handle in self._handles
            self._handles.discard(handle)
        return known
