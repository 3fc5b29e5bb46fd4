"""Driver for a robot that walks by NAOqi's ALMotion."""

import logging
from collections import deque
from collections.abc import Callable, Sequence
from math import isfinite
from time import monotonic, sleep
from typing import Any

import numpy as np

from ...core.poses import Array, Pose
from ...perception.measurement import Sighting
from ..guardian_process import SessionLost
from ..velocity.velocity_body import VelocityCommand, VelocityReport
from .naoqi_url import IDEAL_SIGHT
from .qi_session import Call, answer_of, ask, connect
from .velocity_mover import VelocityMover

PERIOD = 0.05  # between two queries of the robot's state, in [s]
STAND_UP_TIMEOUT = 20.0  # in [s]
STOP_TIMEOUT = 2.0  # for stopMove at the end, in [s]
CROUCH_TIMEOUT = 10.0  # for the crouch at the end, in [s]
STAND = "StandInit"
STAND_UP_SPEED = 0.4  # fraction of the maximum speed
HEAD = ("HeadYaw", "HeadPitch")
HEAD_SPEED = 0.3  # fraction of the maximum speed
FALLEN, BUTTON = "robotHasFallen", "ChestButtonPressed"
KEYS = [FALLEN, BUTTON, IDEAL_SIGHT]
log = logging.getLogger(__name__)


class NaoqiBody:
    """Robot that walks by ALMotion.

    The robot is woken up and stands before it moves. Each press of the
    chest button pauses or resumes it. After a fall the robot lies still
    until the button is pressed and released; then it stands up first.
    ALMotion keeps its last velocity without a time limit, so control needs
    a guardian.

    Attributes:
        joints: Measured angles of ``joint_names``, in [rad].
    """

    def __init__(
        self,
        url: str,
        *,
        dry_run: bool = False,
        joint_names: Sequence[str] = (),
        head: tuple[str, str] = HEAD,
        clock: Callable[[], float] = monotonic,
    ) -> None:
        """Connect, and make the robot stand up.

        Args:
            url: Address like tcp://HOST:PORT.
            dry_run: Whether nothing is commanded.
            joint_names: Joints whose angles are read, if any.
            head: Names of the yaw and pitch joints of the head.
            clock: Time of this computer, in [s]; that of the reports.

        Raises:
            SessionLost: If no robot with ALMotion answers.
        """
        self._session = connect(url)
        self._dry_run, self._clock = dry_run, clock
        try:
            self._motion = self._service("ALMotion")
            self._memory = self._service("ALMemory")
            self._steps_up: deque[Call] = deque()
            self._down = ""
            if not dry_run:
                self._stand_up()
                if not self._steps_up[0].answered(STAND_UP_TIMEOUT):
                    raise SessionLost(
                        "the robot did not answer wakeUp within "
                        f"{STAND_UP_TIMEOUT:g} s"
                    )
        except BaseException:
            self._session.close()
            raise
        self._names, self._head = list(joint_names), list(head)
        self._turning: Any = None
        self.joints: Array = np.zeros(len(self._names))
        self._mover = VelocityMover(self._motion, clock)
        position = Call(self._motion, "getRobotPosition", True)
        memory = Call(self._memory, "getListData", KEYS)
        self._queries = [position, memory]
        if self._names:
            angles = Call(self._motion, "getAngles", self._names, True)
            self._queries.append(angles)
        self._listened = clock() - PERIOD
        self._pressed = self._paused = self._waits = False
        self._is_ideal_logged = False

    def listen(self, patience: float) -> VelocityReport | None:
        """Return a report; None if the robot does not answer in time.

        All queries are sent at once. Answers that are late are collected by
        the next call, so that a slow robot reports less often.

        Args:
            patience: Longest time to wait for a report, in [s].

        Raises:
            SessionLost: If the connection has failed.
        """
        early = self._listened + PERIOD - self._clock()
        if early > 0.0 and not self._waits:
            sleep(min(early, patience))
        if not self._waits:
            self._listened, self._waits = self._clock(), True
            for query in self._queries:
                query.begin()
        end = self._clock() + patience
        for query in self._queries:
            if not query.answered(max(end - self._clock(), 0.0)):
                return None
        self._waits = False
        pose, memory, *angles = [query.take() for query in self._queries]
        if angles:
            self.joints = self._angles(angles[0])
        now = self._clock()
        try:
            x, y, theta = (float(value) for value in pose)
            fallen, pressed, sight = memory
        except (TypeError, ValueError) as error:
            raise SessionLost(
                f"cannot read the robot's state: got {pose!r:.60} and "
                f"{memory!r:.60}"
            ) from error
        hindrance = self._hindrance(bool(fallen), bool(pressed))
        sighting = self._sighting(sight, now)
        return VelocityReport(now, Pose(x, y, theta), sighting, hindrance)

    def command(self, velocity: VelocityCommand) -> None:
        """Send a velocity command, without waiting for the answer.

        Raises:
            SessionLost: If the robot cannot be reached or does not answer.
        """
        if not self._dry_run:
            self._mover.command(velocity)

    def look(self, yaw: float, pitch: float) -> None:
        """Command the head, in [rad], without waiting for the answer."""
        if self._dry_run or self._steps_up:
            return
        if self._turning is None or self._turning.isFinished():
            self._turning = self._motion.setAngles(
                self._head, [yaw, pitch], HEAD_SPEED, _async=True
            )

    def close(self) -> None:
        """Stop, crouch and go limp, if the robot can be reached."""
        try:
            if not self._dry_run:
                ask(self._motion, "stopMove", within=STOP_TIMEOUT)
                ask(self._motion, "rest", within=CROUCH_TIMEOUT)
        except (SessionLost, TimeoutError) as error:
            log.warning("the robot may still stand: %s", error)
        finally:
            self._session.close()

    def _angles(self, answer: Any) -> Array:
        """Check measured angles, in [rad]. Shape (joints,)."""
        try:
            angles = np.array([float(value) for value in answer])
        except (TypeError, ValueError) as error:
            raise SessionLost(
                f"cannot read the joint angles: got {answer!r:.60}"
            ) from error
        if (
            angles.shape != (len(self._names),)
            or not np.isfinite(angles).all()
        ):
            raise SessionLost(
                f"{len(self._names)} finite joint angles are needed, got "
                f"{answer!r:.60}"
            )
        return angles

    def _service(self, name: str) -> Any:
        future = self._session.service(name, _async=True)
        try:
            return answer_of(future, name, within=STOP_TIMEOUT)
        except TimeoutError as error:
            raise SessionLost(f"the robot: {error}") from error

    def _stand_up(self) -> None:
        """Begin to stand up; :meth:`_rise` follows the progress."""
        posture = self._service("ALRobotPosture")
        self._steps_up = deque(
            [
                Call(self._motion, "wakeUp"),
                Call(posture, "goToPosture", STAND, STAND_UP_SPEED),
            ]
        )
        self._rising_until = self._clock() + STAND_UP_TIMEOUT

    def _rise(self) -> str:
        """Return why the robot does not stand yet; empty if it does."""
        while self._steps_up:
            step = self._steps_up[0]
            if not step.answered(0.0):
                if self._clock() > self._rising_until:
                    raise SessionLost(
                        "the robot did not stand up within "
                        f"{STAND_UP_TIMEOUT:g} s"
                    )
                return "stands up"
            self._steps_up.popleft()
            if step.take() is False:
                self._steps_up.clear()
                self._down = "could not stand up"
        return ""

    def _hindrance(self, fallen: bool, pressed: bool) -> str:
        """Return why the robot must not move, by its own sensors.

        A fallen robot lies still until its chest button is released, by a
        person who has set it upright; then it stands up again.
        """
        released = self._pressed and not pressed
        self._pressed = pressed
        if fallen:
            self._down = "has fallen"
            self._steps_up.clear()
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

    def _sighting(self, value: Any, now: float) -> Sighting | None:
        """Return the ideal sighting of a simulated robot, if there is one."""
        if not isinstance(value, list | tuple) or len(value) != 3:
            return None
        if not self._is_ideal_logged:
            self._is_ideal_logged = True
            log.warning("uses the ideal line of sight of the robot")
        age, bearing, distance = (float(entry) for entry in value)
        time = now - age if isfinite(age) else age
        return Sighting(time, bearing, distance)


def stop(url: str) -> None:
    """Stop a robot when control has failed; it stays stiff and stands."""
    session = connect(url)
    try:
        motion = _motion_of(session)
        ask(motion, "stopMove", within=STOP_TIMEOUT)
    finally:
        session.close()


def connect_stopper(url: str) -> Callable[[], None]:
    """Connect to a robot in advance, and return a function that stops it.

    Raises:
        SessionLost: If no robot answers.
    """
    motion = _motion_of(connect(url))

    def stop_now() -> None:
        try:
            ask(motion, "stopMove", within=STOP_TIMEOUT)
        except (SessionLost, TimeoutError):
            stop(url)  # the session was lost meanwhile

    return stop_now


def _motion_of(session: Any) -> Any:
    future = session.service("ALMotion", _async=True)
    try:
        return answer_of(future, "ALMotion", within=STOP_TIMEOUT)
    except TimeoutError as error:
        raise SessionLost(f"the robot: {error}") from error
