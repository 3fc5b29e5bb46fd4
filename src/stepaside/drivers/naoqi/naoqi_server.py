"""Server of NAOqi's services for a simulated robot with walking control."""

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

SILENCE = 0.5  # without a call before the robot stops, in [s]
log = logging.getLogger(__name__)


class NaoqiServer:
    """NAOqi services of one robot, with their own service directory.

    A real ALMotion walks on when its client has gone; this one stops after
    half a second without a call.
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
            url: Address like tcp://127.0.0.1:PORT.
            robot: The simulated robot.
            joint_names: Names of its joints.
            fastest: Velocity of which ``moveToward`` takes fractions.
            tick: Time between two calls of :meth:`speak`, in [s].
            gait: Gait by which footsteps are walked; NAO's by default.

        Raises:
            ConfigurationError: If the address cannot be listened on.
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
        """Address of the services."""
        endpoint: str = self._session.endpoints()[0]
        return endpoint

    @property
    def connected(self) -> bool:
        """Whether a client has called recently."""
        return self._silent * self._tick <= SILENCE

    @property
    def ready(self) -> bool:
        """Whether a client is connected and has made the robot stand."""
        with self.robot.lock:
            stands = self.robot.awake and self.robot.posture != "Crouch"
        return self.connected and stands

    def fileno(self) -> int:
        """Return -1: there is no descriptor to wait on."""
        return -1

    def press(self, pressed: bool) -> None:
        """Do nothing: this robot is not started by its button."""

    def speak(self) -> None:
        """Give the services the robot's present state."""
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
        """Return True: the simulation does not wait for clients."""
        return True

    def act(self) -> None:
        """Command the robot for one tick."""
        with self.robot.lock:
            robot = self.robot
            if not self.connected and (robot.steps or robot.asked != REST):
                log.warning("no call for %g s: the robot stops", SILENCE)
                robot.rest()
            head, asked = dict(robot.head), robot.asked
            following = robot.steps[0] if robot.steps else None
        if head:
            self._walker.look(head)
        if following is None:
            self._walker.command(asked)
        else:
            step, velocity = following
            self._walker.lead_with(step.foot)
            self._walker.command(velocity)

    def drop(self, why: str) -> None:
        """Stop the robot, and log why."""
        log.warning("%s", why)
        with self.robot.lock:
            self.robot.rest()

    def close(self) -> None:
        """Remove the services."""
        if not self._closed:
            self._closed = True
            self._session.close()
