"""The robot's side of NAOqi, for a simulated robot moved by its joints."""

import logging
from collections.abc import Sequence

from ...perception.measurement import Measurement
from ..joint.frame_clock import TICK
from ..joint.served_joints import ServedJointRobot, ServedJoints
from ..lola.conventions import COUNTER_RANGE
from .joint_services import (
    JointMemoryService,
    JointMotionService,
    JointServiceState,
)
from .naoqi_url import IDEAL_SIGHT
from .qi_session import listen
from .sensor_keys import FRAME, values_of

SILENCE = 0.5  # without a command before nobody is there, in [s]
log = logging.getLogger(__name__)


class NaoqiJointServer:
    """Services of one robot, with a service directory of their own.

    A tick is :meth:`speak`, then :meth:`hear` until the client has set the
    joints or time is up, then :meth:`act`. A real ALMotion keeps the joints
    stiff when whoever commanded them has gone; here stiffness decays.
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
            url: Where, like tcp://127.0.0.1:PORT.
            robot: Whom to speak for.
            joint_names: Its joints, in the order of its measurements.
            lock_step: Whether its world waits for answers.
            ideal_sight: Whether the true line of sight is told.

        Raises:
            ConfigurationError: If nobody can listen there.
            ModelError: If NAOqi has no motor for one of the joints.
        """
        self.joints = ServedJoints(robot, joint_names)
        self._lock_step, self._ideal_sight = lock_step, ideal_sight
        self._chest_pressed = False
        self._lonely = round(SILENCE / TICK) + 1
        self._silent, self._count = self._lonely, 0
        self._closed = False
        self.robot = JointServiceState()
        self._tell(self.joints.sense())
        services = {
            "ALMotion": JointMotionService(self.robot),
            "ALMemory": JointMemoryService(self.robot),
        }
        self._services = services
        self._session = listen(url, services)

    @property
    def url(self) -> str:
        """Where the services are."""
        endpoint: str = self._session.endpoints()[0]
        return endpoint

    @property
    def connected(self) -> bool:
        """Whether anybody commanded anything lately."""
        return self._silent < self._lonely

    @property
    def ready(self) -> bool:
        """Whether somebody is there, and holds the robot stiff."""
        return self.connected and self.joints.stiff

    def fileno(self) -> int:
        """No descriptor to wait on."""
        return -1

    def press(self, pressed: bool) -> None:
        """Press the chest button, or let it go."""
        self._chest_pressed = pressed

    def speak(self) -> None:
        """Let ALMemory tell what the sensors give."""
        self._tell(self.joints.sense())

    def hear(self) -> bool:
        """Whether the joints were set, or nobody is waited for."""
        with self.robot.lock:
            answered = self.robot.answered
        return answered or not self.connected

    def act(self) -> None:
        """Let the robot do what was asked, as stiff as it may be."""
        asked = self.robot.taken()
        if asked is None:
            self._silent = min(self._silent + 1, self._lonely)
        else:
            self._silent = 0
            self.joints.take(asked)
        self.joints.act()

    def drop(self, why: str) -> None:
        """Count nobody as there any more, and say why."""
        log.warning("%s", why)
        self._silent = self._lonely

    def close(self) -> None:
        """Take the services away."""
        if not self._closed:
            self._closed = True
            self._session.close()

    def _tell(self, measurement: Measurement) -> None:
        self._count = (self._count + 1) % COUNTER_RANGE
        frame = self.joints.frame(
            self._count,
            chest_pressed=self._chest_pressed,
            lock_step=self._lock_step,
        )
        seen = measurement.sighting if self._ideal_sight else None
        told = values_of(frame) | {
            FRAME: [self._count, int(self._lock_step)],
            IDEAL_SIGHT: None
            if seen is None
            else [measurement.time - seen.time, seen.bearing, seen.distance],
        }
        with self.robot.lock:
            if not self.robot.commanded and not self.connected:
                self.robot.targets = self.joints.targets.copy()
            self.robot.values, self.robot.angles = told, frame.position
            self.robot.answered = False
