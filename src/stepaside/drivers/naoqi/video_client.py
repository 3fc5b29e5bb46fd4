"""NAOqi's cameras: what ALVideoDevice hands over."""

from time import sleep
from typing import Any

import numpy as np

from ...perception.camera_model import CameraModel
from ...perception.images import Pixels
from ..cameras.image_source import LiveCamera
from ..guardian_process import SessionLost
from .qi_session import ask, connect

TOP = 0  # camera over the eyes
RGB = 11  # colour space kRGB
RESOLUTIONS = {  # number of each size (columns, rows)
    (160, 120): 0,
    (320, 240): 1,
    (640, 480): 2,
    (1280, 960): 3,
}
NAME = "stepaside"  # of the subscriber; a robot takes six of a name
ANSWER = 2.0  # longest time that an image takes, in [s]
AGAIN = 0.01  # until a robot that had no new image is asked again, in [s]
# Fields of an image.
WIDTH, HEIGHT, LAYERS, SPACE, SECONDS, MICROS, DATA = range(7)


def resolution_for(model: CameraModel) -> int:
    """Number of the smallest size that is not smaller than a model's.

    Args:
        model: Optics and size.
    """
    for (width, height), number in RESOLUTIONS.items():
        if width >= model.width and height >= model.height:
            return number
    return max(RESOLUTIONS.values())


def pixels_of(image: Any) -> Pixels:
    """Pixels of what ``getImageRemote`` gives. Shape (height, width, 3).

    Args:
        image: A list or tuple: columns, rows, layers, colour space, seconds,
            microseconds, bytes, and more.

    Raises:
        SessionLost: If it is no image in red, green and blue.
    """
    try:
        width, height = int(image[WIDTH]), int(image[HEIGHT])
        known = int(image[LAYERS]) == 3 and int(image[SPACE]) == RGB
        data = bytes(image[DATA])
    except (TypeError, ValueError, IndexError) as error:
        raise SessionLost(f"the robot's camera: {error}") from error
    if not known or len(data) != 3 * width * height or not data:
        raise SessionLost(
            "the robot's camera gives no image in red, green and blue"
        )
    return np.frombuffer(data, np.uint8).reshape(height, width, 3)


def open_video(
    url: str, model: CameraModel, *, rate: float, latency: float
) -> LiveCamera:
    """Subscribe to the top camera of a robot.

    Args:
        url: Like tcp://HOST:PORT.
        model: Optics and size.
        rate: Images per second, in [1/s].
        latency: From exposure to the image in hand, in [s].

    Raises:
        SessionLost: If there is no such robot, or it has no camera.
    """
    session = connect(url)
    try:
        device = session.service("ALVideoDevice")
        handle = ask(
            device,
            "subscribeCamera",
            *(NAME, TOP, resolution_for(model), RGB, round(rate)),
            within=ANSWER,
        )
    except (RuntimeError, TimeoutError, SessionLost) as error:
        session.close()
        raise SessionLost(f"no camera at {url}: {error}") from error

    told: tuple[int, int] | None = None

    def grab() -> Pixels | None:
        nonlocal told
        while True:
            image = ask(device, "getImageRemote", handle, within=ANSWER)
            ask(device, "releaseImage", handle, within=ANSWER)
            if image and image[WIDTH]:
                taken = int(image[SECONDS]), int(image[MICROS])
                if taken != told:
                    told = taken
                    return pixels_of(image)
            sleep(AGAIN)

    def let_go() -> None:
        try:
            ask(device, "unsubscribe", handle, within=ANSWER)
        except (RuntimeError, TimeoutError, SessionLost):
            pass  # it is gone
        finally:
            session.close()

    return LiveCamera(url, grab, let_go, model, latency=latency)
