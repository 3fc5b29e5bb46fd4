"""A robot on NAOqi: the services that we call, over a real session."""

from math import cos, sin
from time import monotonic, sleep
from typing import Any

import qi

FALLEN, BUTTON = "robotHasFallen", "ChestButtonPressed"
SIGHT = "Stepaside/IdealSight"  # age [s], bearing [rad], distance [m]


@qi.multiThreaded()
class ALMotion:
    """Walk by ``move``, as long as nothing else is said.

    While it is silent it takes commands, but does not say where it is.
    """

    def __init__(self) -> None:
        self.silent = False
        self.velocity = (0.0, 0.0, 0.0)
        self.moves: list[tuple[float, float, float]] = []
        self.calls: list[str] = []
        self._pose, self._since = [0.0, 0.0, 0.0], monotonic()

    def wakeUp(self) -> None:
        """Stiffen the motors."""
        self.calls.append("wakeUp")

    def rest(self) -> None:
        """Crouch and go limp."""
        self._go((0.0, 0.0, 0.0))
        self.calls.append("rest")

    def move(self, x: float, y: float, theta: float) -> None:
        """Walk with a velocity, in [m/s] and [rad/s]."""
        self._go((x, y, theta))
        self.moves.append((x, y, theta))

    def stopMove(self) -> None:
        """Stop walking."""
        self._go((0.0, 0.0, 0.0))
        self.calls.append("stopMove")

    def getPosition(self, name: str, frame: int, sensors: bool) -> list[float]:
        """Return place [m] and roll, pitch and yaw [rad] of the camera."""
        assert (name, frame) == ("CameraTop", 2)
        return [0.05, 0.0, 0.5, 0.0, 0.1, 0.2]

    def getRobotPosition(self, use_sensors: bool) -> list[float]:
        """Return x [m], y [m] and heading [rad]."""
        while self.silent:
            sleep(0.02)
        self._go(self.velocity)
        return list(self._pose)

    def _go(self, velocity: tuple[float, float, float]) -> None:
        """Move as until now, then with another velocity."""
        now = monotonic()
        passed, self._since = now - self._since, now
        x, y, theta = self.velocity
        c, s = cos(self._pose[2]), sin(self._pose[2])
        self._pose[0] += passed * (c * x - s * y)
        self._pose[1] += passed * (s * x + c * y)
        self._pose[2] += passed * theta
        self.velocity = velocity


class ALMemory:
    """Values of the sensors by name."""

    def __init__(self) -> None:
        self.values: dict[str, Any] = {FALLEN: 0, BUTTON: 0.0}

    def getListData(self, names: list[str]) -> list[Any]:
        """Return values; None for unknown names."""
        return [self.values.get(name) for name in names]


class ALRobotPosture:
    """Postures, reached at once."""

    def goToPosture(self, name: str, speed: float) -> bool:
        """Take a posture."""
        return True


class ALVideoDevice:
    """One camera, whose images differ by their stamps only."""

    def __init__(self) -> None:
        self.taken, self.frozen, self.watched = 0, False, False

    def subscribeCamera(self, *_: Any) -> str:
        """Return a handle."""
        self.watched = True
        return "one"

    def unsubscribe(self, handle: str) -> bool:
        """Take a handle back."""
        self.watched = False
        return True

    @qi.bind(returnType="(iiiiiir)")  # type: ignore[untyped-decorator]
    def getImageRemote(self, handle: str) -> tuple[Any, ...]:
        """Return two columns and a row in RGB, red and blue."""
        self.taken += not self.frozen
        stamp = divmod(self.taken * 66_667, 1_000_000)
        return (2, 1, 3, 11, *stamp, bytes((255, 0, 0, 0, 0, 255)))

    def releaseImage(self, handle: str) -> bool:
        """Forget the image."""
        return True


class NaoqiPeer:
    """Robot that listens on this machine."""

    def __init__(self) -> None:
        qi.logging.setLevel(qi.logging.FATAL)
        self.motion, self.memory = ALMotion(), ALMemory()
        self.video = ALVideoDevice()
        self.session = qi.Session()
        self.session.listenStandalone("tcp://127.0.0.1:0")
        for service in (
            self.motion,
            self.memory,
            ALRobotPosture(),
            self.video,
        ):
            self.session.registerService(type(service).__name__, service)
        self.url = str(self.session.endpoints()[0])
