"""The robot's side of NAOqi, for a robot that is simulated."""

import logging
from collections.abc import Sequence

from ..velocity.body import REST, Velocity
from ..velocity.served import WalkingRobot
from .services import (
    ALMemory,
    ALMotion,
    ALRobotPosture,
    ALSonar,
    Robot,
)
from .session import listen
from .video_service import ALVideoDevice

SILENCE = 0.5  # of everybody before the robot rests, in [s]
log = logging.getLogger(__name__)


class NaoqiServer:
    """Services of one robot, with a service directory of their own.

    A real ALMotion walks on when whoever commanded it has gone; this one
    rests when nobody asked it anything for half a second.
    """

    def __init__(
        self,
        url: str,
        robot: WalkingRobot,
        joint_names: Sequence[str],
        fastest: Velocity,
        *,
        tick: float,
    ) -> None:
        """Offer the services.

        Args:
            url: Where, like tcp://127.0.0.1:PORT.
            robot: Whom to speak for.
            joint_names: Its joints.
            fastest: What ``moveToward`` takes shares of.
            tick: Time between two calls of :meth:`speak`, in [s].

        Raises:
            ConfigurationError: If nobody can listen there.
        """
        self._walker, self._tick = robot, tick
        self.robot = Robot(robot.state(), joint_names)
        services = {
            "ALMotion": ALMotion(self.robot, fastest),
            "ALRobotPosture": ALRobotPosture(self.robot),
            "ALMemory": ALMemory(self.robot),
            "ALSonar": ALSonar(),
            "ALVideoDevice": ALVideoDevice(self.robot),
        }
        self._services = services
        self._session = listen(url, services)
        self._calls = 0
        self._silent = round(SILENCE / tick) + 1
        self._closed = False

    @property
    def url(self) -> str:
        """Where the services are."""
        endpoint: str = self._session.endpoints()[0]
        return endpoint

    @property
    def connected(self) -> bool:
        """Whether anybody asked anything lately."""
        return self._silent * self._tick <= SILENCE

    @property
    def ready(self) -> bool:
        """Whether somebody is there, and has made the robot stand."""
        with self.robot.lock:
            stands = self.robot.awake and self.robot.posture != "Crouch"
        return self.connected and stands

    def fileno(self) -> int:
        """No descriptor to wait on."""
        return -1

    def press(self, pressed: bool) -> None:
        """Nothing: the button of this robot is not what starts it."""

    def speak(self) -> None:
        """Tell the services what the robot says of itself now."""
        state = self._walker.state()
        with self.robot.lock:
            self.robot.state = state
            calls = self.robot.calls
        self._silent = self._silent + 1 if calls == self._calls else 0
        self._calls = calls

    def hear(self) -> bool:
        """Nobody is waited for."""
        return True

    def act(self) -> Velocity:
        """What the robot is to do at this tick."""
        with self.robot.lock:
            if not self.connected and self.robot.asked != REST:
                log.warning("nobody asks anything: the robot rests")
                self.robot.asked = REST
            head, asked = dict(self.robot.head), self.robot.asked
        if head:
            self._walker.look(head)
        return asked

    def drop(self, why: str) -> None:
        """Let the robot rest, and say why."""
        log.warning("%s", why)
        with self.robot.lock:
            self.robot.asked = REST

    def close(self) -> None:
        """Take the services away."""
        if not self._closed:
            self._closed = True
            self._session.close()
