"""A robot on NAOqi, behind the interface that velocities move."""

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
from .velocity_mover import Mover, VelocityMover

PERIOD = 0.05  # between two looks at the robot, in [s]
STANDING_UP = 20.0  # longest time for it, in [s]
STAND, SLOWLY = "StandInit", 0.4  # posture, and share of the top speed
PARTING = 2.0  # longest time for stopping at the end, in [s]
LYING_DOWN = 10.0  # longest time for the crouch in the end, in [s]
HEAD, CALMLY = ("HeadYaw", "HeadPitch"), 0.3  # and share of the top speed
FALLEN, BUTTON = "robotHasFallen", "ChestButtonPressed"
KEYS = [FALLEN, BUTTON, IDEAL_SIGHT]
log = logging.getLogger(__name__)


class NaoqiBody:
    """One robot whose ALMotion walks.

    It is woken up and stands before it moves. Its chest button, when it is
    let go, makes it rest, and lets it go on. After a fall the robot stays
    where it is until then, and stands up again first. ALMotion walks on for
    ever when nobody tells it to stop: control needs a guardian.

    Attributes:
        joints: Angles of the joints that are asked for, in [rad].
    """

    def __init__(
        self,
        url: str,
        *,
        dry_run: bool = False,
        joint_names: Sequence[str] = (),
        head: tuple[str, str] = HEAD,
        make_mover: Callable[
            [Any, Callable[[], float]], Mover
        ] = VelocityMover,
        clock: Callable[[], float] = monotonic,
    ) -> None:
        """Connect, and let the robot stand up.

        Args:
            url: Like tcp://HOST:PORT.
            dry_run: Whether nothing is ever commanded.
            joint_names: Joints whose angles are asked for, if any are.
            head: Names of its yaw and its pitch.
            make_mover: What takes velocities to its ALMotion, and how; by
                ``move`` by default. Given that and a clock.
            clock: Time of this computer, in [s]; that of the reports.

        Raises:
            SessionLost: If there is no such robot, or it has no ALMotion.
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
                if not self._steps_up[0].answered(STANDING_UP):
                    raise SessionLost("the robot: wakeUp was not answered")
        except BaseException:
            self._session.close()
            raise
        self._names, self._head = list(joint_names), list(head)
        self._turning: Any = None
        self.joints: Array = np.zeros(len(self._names))
        self._mover = make_mover(self._motion, clock)
        position = Call(self._motion, "getRobotPosition", True)
        memory = Call(self._memory, "getListData", KEYS)
        self._questions = [position, memory]
        if self._names:
            angles = Call(self._motion, "getAngles", self._names, True)
            self._questions.append(angles)
        self._listened = clock() - PERIOD
        self._pressed = self._held = self._waits = False
        self._told_ideal = False

    def listen(self, patience: float) -> VelocityReport | None:
        """Where the robot is, and what it knows; None if it is too slow.

        All is asked at once. What is not answered in time is waited for at
        the next call: a slow robot tells less often, but it tells.

        Args:
            patience: Longest time to wait for it, in [s].

        Raises:
            SessionLost: If the robot is gone.
        """
        early = self._listened + PERIOD - self._clock()
        if early > 0.0 and not self._waits:
            sleep(min(early, patience))
        if not self._waits:
            self._listened, self._waits = self._clock(), True
            for question in self._questions:
                question.begin()
        end = self._clock() + patience
        for question in self._questions:
            if not question.answered(max(end - self._clock(), 0.0)):
                return None
        self._waits = False
        place, told, *angles = [
            question.take() for question in self._questions
        ]
        if angles:
            self.joints = self._angles(angles[0])
        now = self._clock()
        try:
            x, y, theta = (float(value) for value in place)
            fallen, pressed, sight = told
        except (TypeError, ValueError) as error:
            raise SessionLost(
                f"the robot says {place!r:.60}, {told!r:.60}"
            ) from error
        hindrance = self._hindrance(bool(fallen), bool(pressed))
        seen = self._sighting(sight, now)
        return VelocityReport(now, Pose(x, y, theta), seen, hindrance)

    def command(self, velocity: VelocityCommand) -> None:
        """Ask for a velocity, without waiting for the robot.

        Raises:
            SessionLost: If the robot is gone or stuck.
        """
        if not self._dry_run:
            self._mover.command(velocity)

    def look(self, yaw: float, pitch: float) -> None:
        """Turn the head, in [rad], without waiting for the robot."""
        if self._dry_run or self._steps_up:
            return
        if self._turning is None or self._turning.isFinished():
            self._turning = self._motion.setAngles(
                self._head, [yaw, pitch], CALMLY, _async=True
            )

    def close(self) -> None:
        """Stop, crouch and let the motors go, as far as it can be asked."""
        try:
            if not self._dry_run:
                ask(self._motion, "stopMove", within=PARTING)
                ask(self._motion, "rest", within=LYING_DOWN)
        except (SessionLost, TimeoutError) as error:
            log.warning("the robot may still stand: %s", error)
        finally:
            self._session.close()

    def _angles(self, told: Any) -> Array:
        """Joints as measured, in [rad]. Shape (joints,)."""
        try:
            angles = np.array([float(value) for value in told])
        except (TypeError, ValueError) as error:
            raise SessionLost(f"the robot says {told!r:.60}") from error
        if (
            angles.shape != (len(self._names),)
            or not np.isfinite(angles).all()
        ):
            raise SessionLost("the robot's joints are no numbers")
        return angles

    def _service(self, name: str) -> Any:
        future = self._session.service(name, _async=True)
        try:
            return answer_of(future, name, within=PARTING)
        except TimeoutError as error:
            raise SessionLost(f"the robot: {error}") from error

    def _stand_up(self) -> None:
        """Ask for it; it takes its time."""
        posture = self._service("ALRobotPosture")
        self._steps_up = deque(
            [
                Call(self._motion, "wakeUp"),
                Call(posture, "goToPosture", STAND, SLOWLY),
            ]
        )
        self._rising_until = self._clock() + STANDING_UP

    def _rise(self) -> str:
        """Why the robot does not stand yet; empty if it does."""
        while self._steps_up:
            step = self._steps_up[0]
            if not step.answered(0.0):
                if self._clock() > self._rising_until:
                    raise SessionLost(
                        f"the robot did not stand up in {STANDING_UP:g} s"
                    )
                return "stands up"
            self._steps_up.popleft()
            if step.take() is False:
                self._steps_up.clear()
                self._down = "could not stand up"
        return ""

    def _hindrance(self, fallen: bool, pressed: bool) -> str:
        """Why the robot must not move, by its own senses.

        A robot that fell stays where it is until its chest button is let
        go: somebody has put it upright then, and it stands up again.
        """
        released = self._pressed and not pressed
        self._pressed = pressed
        if fallen:
            self._down = "has fallen"
            self._steps_up.clear()
            return self._down
        if rises := self._rise():
            return rises
        if self._down and released:
            self._down, self._held = "", False
            self._stand_up()
            return self._rise()
        if self._down:
            return f"{self._down}: the chest button makes it stand up"
        if released:
            self._held = not self._held
        return "chest button" if self._held or pressed else ""

    def _sighting(self, told: Any, now: float) -> Sighting | None:
        """What a simulated robot tells of the other, if it does."""
        if not isinstance(told, list | tuple) or len(told) != 3:
            return None
        if not self._told_ideal:
            self._told_ideal = True
            log.warning("sees by the ideal line of sight of the robot")
        age, bearing, distance = (float(value) for value in told)
        time = now - age if isfinite(age) else age
        return Sighting(time, bearing, distance)


def stop(url: str) -> None:
    """Stop a robot in place of control that is gone.

    It stays stiff: whoever finds it standing can let it crouch.
    """
    session = connect(url)
    try:
        motion = _motion_of(session)
        ask(motion, "stopMove", within=PARTING)
    finally:
        session.close()


def stopper_of(url: str) -> Callable[[], None]:
    """Connect to a robot in advance, and return what stops it.

    Raises:
        SessionLost: If there is no such robot.
    """
    motion = _motion_of(connect(url))

    def stop_now() -> None:
        try:
            ask(motion, "stopMove", within=PARTING)
        except (SessionLost, TimeoutError):
            stop(url)  # the session was lost meanwhile

    return stop_now


def _motion_of(session: Any) -> Any:
    future = session.service("ALMotion", _async=True)
    try:
        return answer_of(future, "ALMotion", within=PARTING)
    except TimeoutError as error:
        raise SessionLost(f"the robot: {error}") from error
