"""NAO and Pepper on NAOqi, which walk by ALMotion at velocities.

The robot is woken up and stands before it moves. Each press of the chest
button pauses or resumes it. After a fall the robot lies still until the
button is pressed and released; then it stands up first. Messages carry no
time, so the times of reports and images are those of their arrival.
"""

import logging
import re
from collections import deque
from collections.abc import Callable
from functools import cache, partial
from time import monotonic, sleep
from typing import Any

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Pose
from ..perception.camera_model import CameraModel
from ..perception.measurement import RobotState
from .method_thread import SessionLost
from .robot import (
    CameraImage,
    CameraMount,
    HeadLimits,
    VelocityLimits,
    VelocityRobot,
)
from .robot_loader import RobotRequest

try:
    import qi
except ImportError as error:
    raise ConfigurationError(
        "NAOqi needs its library qi: pip install 'stepaside[robot]'"
    ) from error

_URL = re.compile(r"(?:tcp://)?(?P<host>[A-Za-z0-9_.-]+)(?::(?P<port>\d+))?")
PORT = 9559
CONNECT_TIMEOUT = 5.0  # in [s]
TIMEOUT = 2.0  # of a call that returns soon, in [s]
ANSWER = 1.0  # of a velocity command, in [s]
STAND_UP_TIMEOUT = 20.0  # in [s]
CROUCH_TIMEOUT = 10.0  # at the end, in [s]
PERIOD, PATIENCE = 0.05, 0.1  # of the queries of the state, in [s]
REPEAT = 0.25  # after which an unchanged velocity is sent again, in [s]
STAND, STAND_UP_SPEED = "StandInit", 0.4  # and fraction of the maximum speed
HEAD, HEAD_SPEED = ("HeadYaw", "HeadPitch"), 0.3
KEYS = ["robotHasFallen", "ChestButtonPressed"]
TOP, RGB, FRAME_ROBOT = 0, 11, 2  # camera, colour space, frame on the floor
SIZES = {160: 0, 320: 1, 640: 2, 1280: 3}  # resolutions, by columns
TRACEBACK = "\n\nAt:\n"  # begins the traceback in errors of Python services
log = logging.getLogger(__name__)


@cache
def _application() -> Any:
    """Create the application, of which a process can have only one."""
    qi.logging.setLevel(qi.logging.ERROR)
    return qi.Application(["stepaside"], raw=True)


def _reason_of(error: object) -> str:
    """Return the reason of a failed call in one line, without traceback."""
    reason, _, _ = str(error).partition(TRACEBACK)
    return " ".join(reason.split()) or "no reason was given"


class Call:
    """Call of a service, whose late answer is not lost."""

    def __init__(self, service: Any, method: str, *values: Any) -> None:
        """Make the call, without waiting."""
        self._what, self._began = method, monotonic()
        self._future = getattr(service, method)(*values, _async=True)

    @property
    def age(self) -> float:
        """Time since the call, in [s]."""
        return monotonic() - self._began

    def answered(self, patience: float = 0.0) -> bool:
        """Wait up to a time in [s]; return whether the answer came."""
        self._future.wait(round(1000.0 * max(patience, 0.0)))
        return bool(self._future.isFinished())

    def answer(self, patience: float = TIMEOUT) -> Any:
        """Wait up to a time in [s], and return the answer."""
        if not self.answered(patience):
            raise SessionLost(f"the robot did not answer {self._what}")
        try:
            return self._future.value(0)
        except RuntimeError as error:
            why = _reason_of(error)
            raise SessionLost(f"the robot's {self._what}: {why}") from error


class NaoqiRobot(VelocityRobot):
    """Robot that walks by ALMotion, which keeps its last velocity."""

    limits = VelocityLimits()
    closing = CROUCH_TIMEOUT + 2.0 * TIMEOUT
    head = HeadLimits(yaw=2.0, up=0.6, down=0.5)

    def __init__(self, url: str, camera: CameraModel, latency: float) -> None:
        """Make a robot."""
        self._url, self._camera, self._latency = url, camera, latency
        self._steps_up: deque[Callable[[], Call]] = deque()
        self._rising: Call | None = None
        self._rising_until = 0.0
        self._down = ""
        self._pressed = self._paused = self._prepared = False
        self._queries: list[Call] = []
        self._due = 0.0
        self._moving: Call | None = None
        self._velocity = (0.0, 0.0, 0.0)
        self._watching: Any = None
        self._stamp: Any = None  # of the newest image

    def open(self) -> None:
        """Connect to ALMotion and ALMemory."""
        _application()
        self._session = qi.Session()
        try:
            joined = self._session.connect(self._url, _async=True)
            joined.value(round(1000.0 * CONNECT_TIMEOUT))
            self._motion = self._service("ALMotion")
            self._memory = self._service("ALMemory")
        except RuntimeError as error:
            self._session.close()
            why = _reason_of(error)
            raise SessionLost(
                f"no robot answers at {self._url}: {why}"
            ) from error

    def prepare(self) -> None:
        """Wake the robot up; it stands up while it reports."""
        self._prepared = True
        self._stand_up()
        assert self._rising is not None
        self._rising.answer(STAND_UP_TIMEOUT)

    def listen(self) -> RobotState | None:
        """Return pose, falls and button; None if the robot is late."""
        if not self._queries:
            sleep(max(self._due - monotonic(), 0.0))
            self._due = monotonic() + PERIOD
            self._queries = [
                Call(self._motion, "getRobotPosition", True),
                Call(self._memory, "getListData", KEYS),
            ]
        end = monotonic() + PATIENCE
        if not all(each.answered(end - monotonic()) for each in self._queries):
            return None
        queries, self._queries = self._queries, []
        (x, y, theta), (fallen, pressed) = (each.answer() for each in queries)
        return RobotState(
            monotonic(),
            pose=Pose(x, y, theta),
            hindrance=self._hindrance(bool(fallen), bool(pressed)),
        )

    def command(self, forward: float, lateral: float, turn: float) -> None:
        """Walk at a velocity; a pending answer is waited for by the next."""
        velocity = forward, lateral, turn
        if self._moving is not None:
            if not self._moving.answered():
                if self._moving.age > ANSWER:
                    self._moving.answer(0.0)
                return
            self._moving.answer()
            if velocity == self._velocity and self._moving.age < REPEAT:
                return
        self._velocity = velocity
        self._moving = Call(self._motion, "move", *velocity)

    def stop(self) -> None:
        """Stop walking, once."""
        if self._moving is None or any(self._velocity):
            self._velocity = (0.0, 0.0, 0.0)
            self._moving = Call(self._motion, "stopMove")
            self._moving.answer()

    def look(self, yaw: float, pitch: float) -> None:
        """Turn the head, unless the robot stands up."""
        if self._rising is None:
            Call(self._motion, "setAngles", list(HEAD), [yaw, pitch],
                 HEAD_SPEED).answer()  # fmt: skip

    def image(self) -> CameraImage | None:
        """Return an image of the top camera, with the pose of the camera."""
        if self._watching is None:
            fits = [size for size in SIZES if size >= self._camera.width]
            columns = min(fits, default=max(SIZES))
            device = self._service("ALVideoDevice")
            handle = Call(device, "subscribeCamera", "stepaside", TOP,
                          SIZES[columns], RGB, 15).answer()  # fmt: skip
            self._watching = device, handle
        device, handle = self._watching
        where = Call(
            self._motion, "getPosition", "CameraTop", FRAME_ROBOT, True
        )
        found = Call(device, "getImageRemote", handle).answer()
        now = monotonic() - self._latency
        forward, left, up, roll, pitch, yaw = where.answer()
        Call(device, "releaseImage", handle).answer()
        if not found or not found[0] or found[4:6] == self._stamp:
            return None
        self._stamp = found[4:6]
        width, height, layers, space = found[:4]
        data = bytes(found[6])
        if (layers, space) != (3, RGB) or len(data) != 3 * width * height:
            raise ConnectionError(
                "images of the robot's camera must be RGB with three bytes "
                f"per pixel, got {width} by {height} px in {len(data)} bytes"
            )
        share = width / self._camera.width
        return CameraImage(
            now,
            np.frombuffer(data, np.uint8).reshape(height, width, 3),
            self._camera.focal_x * share,
            self._camera.focal_y * share,
            CameraMount(forward, left, up, yaw, pitch, roll),
        )

    def close(self) -> None:
        """Crouch and go limp, if the robot was woken up; disconnect."""
        try:
            if self._watching is not None:
                device, handle = self._watching
                Call(device, "unsubscribe", handle).answer()
            if self._prepared:
                Call(self._motion, "rest").answer(CROUCH_TIMEOUT)
        except SessionLost as error:
            log.warning("the robot may still stand: %s", error)
        finally:
            self._session.close()

    def _service(self, name: str) -> Any:
        return Call(self._session, "service", name).answer()

    def _stand_up(self) -> None:
        """Begin to stand up; :meth:`_rise` follows the progress."""
        posture = self._service("ALRobotPosture")
        how = STAND, STAND_UP_SPEED
        stand = partial(Call, posture, "goToPosture", *how)
        self._steps_up = deque([stand])
        self._rising = Call(self._motion, "wakeUp")
        self._rising_until = monotonic() + STAND_UP_TIMEOUT

    def _rise(self) -> str:
        """Return why the robot does not stand yet; empty if it does."""
        while self._rising is not None:
            if not self._rising.answered():
                if monotonic() > self._rising_until:
                    raise ConnectionError(
                        "the robot did not stand up within "
                        f"{STAND_UP_TIMEOUT:g} s"
                    )
                return "stands up"
            stands, self._rising = self._rising.answer(), None
            if stands is False:
                self._steps_up.clear()
                self._down = "could not stand up"
            elif self._steps_up:
                self._rising = self._steps_up.popleft()()
        return ""

    def _hindrance(self, fallen: bool, pressed: bool) -> str:
        """Return why the robot must not move, by its own sensors.

        A fallen robot lies still until its chest button is released, by a
        person who has set it upright; then it stands up again.
        """
        released = self._pressed and not pressed
        self._pressed = pressed
        if fallen:
            self._down, self._rising = "has fallen", None
            return self._down
        if rising := self._rise():
            return rising
        if self._down and released:
            self._down, self._paused = "", False
            self._stand_up()
            return self._rise()
        if self._down:
            return f"{self._down}: the chest button makes it stand up"
        if released:
            self._paused = not self._paused
        return "chest button" if self._paused or pressed else ""


def make_robot(request: RobotRequest) -> Callable[[], NaoqiRobot]:
    """Return a function that makes the robot at ``naoqi:tcp://HOST:PORT``.

    ``tcp://`` and the port, 9559, may be omitted.
    """
    found = _URL.fullmatch(request.address)
    ascii_only = found is not None and request.address.isascii()
    port = int(found["port"] or PORT) if found and ascii_only else 0
    if found is None or not 0 < port < 65536:
        raise ConfigurationError(
            "robot must be naoqi:tcp://HOST:PORT, got "
            f"'naoqi:{request.address}'"
        )
    camera = request.camera or CameraModel(320, 240, 277.0, 277.0)
    url = f"tcp://{found['host']}:{port}"
    return partial(NaoqiRobot, url, camera, request.latency)
