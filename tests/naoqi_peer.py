"""A robot on NAOqi: the services that we call, over a real session."""

from math import cos, sin
from time import monotonic, sleep
from typing import Any

import qi

FALLEN, BUTTON = "robotHasFallen", "ChestButtonPressed"
SERVICES = "ALMotion", "ALMemory", "ALRobotPosture", "ALVideoDevice"
REST = (0.0, 0.0, 0.0)


@qi.multiThreaded()
class Services:
    """All services; while silent, it does not say where the robot is."""

    def __init__(self) -> None:
        self.silent = self.frozen = False
        self.watched: tuple[Any, ...] = ()
        self.head: tuple[Any, ...] = ()
        self.stands = True
        self.velocity = REST
        self.moves: list[tuple[float, float, float]] = []
        self.calls: list[str] = []
        self.values: dict[str, Any] = {FALLEN: 0, BUTTON: 0.0}
        self._pose, self._since = [0.0, 0.0, 0.0], monotonic()
        self._images, self.url = 0, ""

    def wakeUp(self) -> None:
        """Stiffen the motors."""
        self.calls.append("wakeUp")

    def rest(self) -> None:
        """Crouch and go limp."""
        self.velocity = REST
        self.calls.append("rest")

    def move(self, x: float, y: float, theta: float) -> None:
        """Walk with a velocity, in [m/s] and [rad/s]."""
        self.velocity = (x, y, theta)
        self.moves.append(self.velocity)

    def stopMove(self) -> None:
        """Stop walking."""
        self.velocity = REST
        self.calls.append("stopMove")

    def goToPosture(self, name: str, speed: float) -> bool:
        """Take a posture, at once."""
        assert name == "StandInit" and 0.39 < speed < 0.41
        return self.stands

    def setAngles(
        self, names: list[str], angles: list[float], speed: float
    ) -> None:
        """Turn the head."""
        self.head = names, [round(a, 6) for a in angles], round(speed, 6)

    def getPosition(self, name: str, frame: int, sensors: bool) -> list[float]:
        """Return place [m] and roll, pitch and yaw [rad] of the camera."""
        assert (name, frame) == ("CameraTop", 2)
        return [0.05, 0.0, 0.5, 0.0, 0.1, 0.2]

    def getRobotPosition(self, use_sensors: bool) -> list[float]:
        """Return x [m], y [m] and heading [rad]."""
        while self.silent:
            sleep(0.02)
        passed, self._since = monotonic() - self._since, monotonic()
        (x, y, turn), (_, _, heading) = self.velocity, self._pose
        self._pose[0] += passed * (cos(heading) * x - sin(heading) * y)
        self._pose[1] += passed * (sin(heading) * x + cos(heading) * y)
        self._pose[2] += passed * turn
        return list(self._pose)

    def getListData(self, names: list[str]) -> list[Any]:
        """Return values of sensors; None for unknown names."""
        return [self.values.get(name) for name in names]

    def subscribeCamera(self, *how: Any) -> str:
        """Return a handle."""
        self.watched = how
        return "one"

    def releaseImage(self, handle: str) -> bool:
        """Forget an image."""
        return True

    @qi.bind(returnType="(iiiiiir)")  # type: ignore[untyped-decorator]
    def getImageRemote(self, handle: str) -> tuple[Any, ...]:
        """Return two columns and a row in RGB, red and blue, with a stamp."""
        self._images += not self.frozen
        stamp = divmod(self._images * 66_667, 1_000_000)
        return (2, 1, 3, 11, *stamp, bytes((255, 0, 0, 0, 0, 255)))

    def unsubscribe(self, handle: str) -> None:
        """Take a handle back."""
        self.watched = ()


def serve() -> tuple[Any, Services]:
    """Return session and services of a robot on this machine."""
    qi.logging.setLevel(qi.logging.FATAL)
    services, session = Services(), qi.Session()
    session.listenStandalone("tcp://127.0.0.1:0")
    for name in SERVICES:
        session.registerService(name, services)
    services.url = str(session.endpoints()[0])
    return session, services
