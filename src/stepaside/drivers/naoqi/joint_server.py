"""Server of NAOqi's services for a simulated robot driven by its joints."""

import logging
from collections.abc import Sequence

from ...perception.measurement import Measurement
from ..joint.frame_clock import COUNTER_RANGE
from ..lola.nao_joints import TICK
from ..lola.served_joints import ServedJointRobot, ServedJoints
from .joint_services import (
    JointMemoryService,
    JointMotionService,
    JointServiceState,
)
from .naoqi_url import IDEAL_SIGHT
from .qi_session import listen
from .sensor_keys import FRAME, values_of

SILENCE = 0.5  # without a command before a client counts as gone, in [s]
log = logging.getLogger(__name__)


class NaoqiJointServer:
    """NAOqi services of one robot, with their own service directory.

    A tick is :meth:`speak`, then :meth:`hear` until the client has set the
    joints or time is up, then :meth:`act`. A real ALMotion keeps the joints
    stiff when its client has gone; here stiffness decays.
    """

    def __init__(
        self,
        url: str,
        robot: ServedJointRobot,
        joint_names: Sequence[str],
        *,
        lock_step: bool = False,
        ideal_sight: bool = True,
    ) -> None:
        """Offer the services.

        Args:
            url: Address like tcp://127.0.0.1:PORT.
            robot: The simulated robot.
            joint_names: Its joints, in the order of its measurements.
            lock_step: Whether the simulation waits for answers.
            ideal_sight: Whether the true line of sight is offered.

        Raises:
            ConfigurationError: If the address cannot be listened on.
            ModelError: If NAOqi has no motor for one of the joints.
        """
        self.joints = ServedJoints(robot, joint_names)
        self._lock_step, self._ideal_sight = lock_step, ideal_sight
        self._chest_pressed = False
        self._max_silent = round(SILENCE / TICK) + 1
        self._silent, self._count = self._max_silent, 0
        self._closed = False
        self.robot = JointServiceState()
        self._publish(self.joints.sense())
        services = {
            "ALMotion": JointMotionService(self.robot),
            "ALMemory": JointMemoryService(self.robot),
        }
        self._services = services
        self._session = listen(url, services)

    @property
    def url(self) -> str:
        """Address of the services."""
        endpoint: str = self._session.endpoints()[0]
        return endpoint

    @property
    def connected(self) -> bool:
        """Whether a client has commanded recently."""
        return self._silent < self._max_silent

    @property
    def ready(self) -> bool:
        """Whether a client is connected and holds the robot stiff."""
        return self.connected and self.joints.stiff

    def fileno(self) -> int:
        """Return -1: there is no descriptor to wait on."""
        return -1

    def press(self, pressed: bool) -> None:
        """Press the chest button, or release it."""
        self._chest_pressed = pressed

    def speak(self) -> None:
        """Read the sensors into ALMemory."""
        self._publish(self.joints.sense())

    def hear(self) -> bool:
        """Return whether the joints were set, or no client is connected."""
        with self.robot.lock:
            answered = self.robot.answered
        return answered or not self.connected

    def act(self) -> None:
        """Apply the newest commands for one tick."""
        command = self.robot.taken()
        if command is None:
            self._silent = min(self._silent + 1, self._max_silent)
        else:
            self._silent = 0
            self.joints.take(command)
        self.joints.act()

    def drop(self, why: str) -> None:
        """Count the client as gone, and log why."""
        log.warning("%s", why)
        self._silent = self._max_silent

    def close(self) -> None:
        """Remove the services."""
        if not self._closed:
            self._closed = True
            self._session.close()

    def _publish(self, measurement: Measurement) -> None:
        self._count = (self._count + 1) % COUNTER_RANGE
        frame = self.joints.frame(
            self._count,
            chest_pressed=self._chest_pressed,
            lock_step=self._lock_step,
        )
        sighting = measurement.sighting if self._ideal_sight else None
        values = values_of(frame) | {
            FRAME: [self._count, int(self._lock_step)],
            IDEAL_SIGHT: None
            if sighting is None
            else [
                measurement.time - sighting.time,
                sighting.bearing,
                sighting.distance,
            ],
        }
        with self.robot.lock:
            if not self.robot.commanded and not self.connected:
                self.robot.targets = self.joints.targets.copy()
            self.robot.values, self.robot.angles = values, frame.position
            self.robot.answered = False
