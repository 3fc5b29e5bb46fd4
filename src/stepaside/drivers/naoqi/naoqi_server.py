"""The robot's side of NAOqi, for a robot that is simulated."""

import logging
from collections.abc import Sequence

from ...planning import GaitSettings
from ..velocity.velocity_body import REST, VelocityCommand
from ..velocity.walking_robot import WalkingRobot
from .memory_service import ALMemory, ALSonar
from .motion_services import ALMotion, ALRobotPosture
from .qi_session import listen
from .service_state import WalkServiceState
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
        fastest: VelocityCommand,
        *,
        tick: float,
        gait: GaitSettings | None = None,
    ) -> None:
        """Offer the services.

        Args:
            url: Where, like tcp://127.0.0.1:PORT.
            robot: Whom to speak for.
            joint_names: Its joints.
            fastest: What ``moveToward`` takes shares of.
            tick: Time between two calls of :meth:`speak`, in [s].
            gait: How it walks footsteps; NAO's gait by default.

        Raises:
            ConfigurationError: If nobody can listen there.
        """
        self._walker, self._tick = robot, tick
        self.robot = WalkServiceState(robot.state(), joint_names)
        services = {
            "ALMotion": ALMotion(self.robot, fastest, gait or GaitSettings()),
            "ALRobotPosture": ALRobotPosture(self.robot),
            "ALMemory": ALMemory(self.robot),
            "ALSonar": ALSonar(self.robot),
            "ALVideoDevice": ALVideoDevice(self.robot),
        }
        self._services = services
        self._session = listen(url, services)
        self._calls = 0
        self._begun = robot.state().steps
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
            steps = self.robot.steps
            self.robot.state = state
            for _ in range(min(state.steps - self._begun, len(steps))):
                steps.popleft()  # it has begun
            calls = self.robot.calls
        self._begun = state.steps
        self._silent = self._silent + 1 if calls == self._calls else 0
        self._calls = calls

    def hear(self) -> bool:
        """Nobody is waited for."""
        return True

    def act(self) -> VelocityCommand:
        """What the robot is to do at this tick."""
        with self.robot.lock:
            robot = self.robot
            if not self.connected and (robot.steps or robot.asked != REST):
                log.warning("nobody asks anything: the robot rests")
                robot.rest()
            head, asked = dict(robot.head), robot.asked
            following = robot.steps[0] if robot.steps else None
        if head:
            self._walker.look(head)
        if following is None:
            return asked
        step, velocity = following
        self._walker.lead_with(step.foot)
        return velocity

    def drop(self, why: str) -> None:
        """Let the robot rest, and say why."""
        log.warning("%s", why)
        with self.robot.lock:
            self.robot.rest()

    def close(self) -> None:
        """Take the services away."""
        if not self._closed:
            self._closed = True
            self._session.close()
