"""Client of ALVideoDevice, the camera service of NAOqi."""

from time import monotonic, sleep
from typing import Any

import numpy as np

from ...perception.camera_model import CameraModel
from ...perception.images import Pixels
from ..cameras.image_source import LiveCamera
from ..guardian_process import SessionLost
from .qi_session import ask, connect

TOP = 0  # index of the upper camera
RGB = 11  # colour space kRGB
RESOLUTIONS = {  # index of each size (columns, rows)
    (160, 120): 0,
    (320, 240): 1,
    (640, 480): 2,
    (1280, 960): 3,
}
NAME = "stepaside"  # of the subscriber; a robot accepts six of a name
TIMEOUT = 2.0  # for an answer, and for an image that is new, in [s]
POLL = 0.01  # between two polls for a new image, in [s]
# Fields of an image.
WIDTH, HEIGHT, LAYERS, SPACE, SECONDS, MICROS, DATA = range(7)


def resolution_for(model: CameraModel) -> int:
    """Return the index of the smallest size that is at least a model's.

    Args:
        model: Optics and size.
    """
    for (width, height), number in RESOLUTIONS.items():
        if width >= model.width and height >= model.height:
            return number
    return max(RESOLUTIONS.values())


def pixels_of(image: Any) -> Pixels:
    """Decode an image of ``getImageRemote``.

    Args:
        image: List or tuple: columns, rows, layers, colour space, seconds,
            microseconds, bytes, and more.

    Returns:
        Red, green and blue. Shape (height, width, 3).

    Raises:
        SessionLost: If it is not an RGB image.
    """
    try:
        width, height = int(image[WIDTH]), int(image[HEIGHT])
        known = int(image[LAYERS]) == 3 and int(image[SPACE]) == RGB
        data = bytes(image[DATA])
    except (TypeError, ValueError, IndexError) as error:
        raise SessionLost(f"the robot's camera: {error}") from error
    if not known or len(data) != 3 * width * height or not data:
        raise SessionLost(
            "images of the robot's camera must be RGB with three bytes per "
            f"pixel, got {width} by {height} px in {len(data)} bytes"
        )
    return np.frombuffer(data, np.uint8).reshape(height, width, 3)


def open_video(
    url: str, model: CameraModel, *, rate: float, latency: float
) -> LiveCamera:
    """Subscribe to the top camera of a robot.

    Args:
        url: Address like tcp://HOST:PORT.
        model: Optics and requested size.
        rate: Frame rate, in [1/s].
        latency: Time from exposure to arrival, in [s].

    Raises:
        SessionLost: If no robot with a camera answers.
    """
    session = connect(url)
    try:
        device = session.service("ALVideoDevice")
        handle = ask(
            device,
            "subscribeCamera",
            NAME,
            TOP,
            resolution_for(model),
            RGB,
            round(rate),
            within=TIMEOUT,
        )
    except (RuntimeError, TimeoutError, SessionLost) as error:
        session.close()
        raise SessionLost(f"no camera at {url}: {error}") from error

    newest: tuple[int, int] | None = None

    def grab() -> Pixels | None:
        nonlocal newest
        end = monotonic() + TIMEOUT
        while monotonic() < end:
            image = ask(device, "getImageRemote", handle, within=TIMEOUT)
            ask(device, "releaseImage", handle, within=TIMEOUT)
            if image and image[WIDTH]:
                stamp = int(image[SECONDS]), int(image[MICROS])
                if stamp != newest:
                    newest = stamp
                    return pixels_of(image)
            sleep(POLL)
        raise SessionLost(f"no new image within {TIMEOUT:g} s")

    def let_go() -> None:
        try:
            ask(device, "unsubscribe", handle, within=TIMEOUT)
        except (RuntimeError, TimeoutError, SessionLost):
            pass  # the connection has ended already
        finally:
            session.close()

    return LiveCamera(url, grab, let_go, model, latency=latency)
