"""A robot on NAOqi, behind the interface that velocities move."""

import logging
from collections.abc import Callable, Sequence
from math import isfinite
from time import monotonic, sleep
from typing import Any

import numpy as np

from ...poses import Array, Pose
from ...sensing.measurement import Sighting
from ..session import SessionLost
from ..velocity.body import Report, Velocity
from .address import IDEAL_SIGHT
from .moving import Mover, VelocityMover
from .session import answer_of, ask, connect

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
    let go, makes it rest, and lets it go on. ALMotion walks on for ever
    when nobody tells it to stop: who can die needs a guardian.

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
            self._standing: Any = None
            if not dry_run:
                self._stand_up()
        except BaseException:
            self._session.close()
            raise
        self._names, self._head = list(joint_names), list(head)
        self._turning: Any = None
        self.joints: Array = np.zeros(len(self._names))
        self._mover = make_mover(self._motion, clock)
        self._listened = clock() - PERIOD
        self._pressed = self._held = False
        self._told_ideal = False

    def listen(self, patience: float) -> Report | None:
        """Where the robot is, and what it knows; None if it is too slow.

        Args:
            patience: Longest time to wait for it, in [s].

        Raises:
            SessionLost: If the robot is gone.
        """
        early = self._listened + PERIOD - self._clock()
        if early > 0.0:
            sleep(min(early, patience))
        self._listened = self._clock()
        try:
            place = ask(
                self._motion, "getRobotPosition", True, within=patience
            )
            told = ask(self._memory, "getListData", KEYS, within=patience)
            if self._names:
                self.joints = self._angles(patience)
        except TimeoutError:
            return None
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
        return Report(now, Pose(x, y, theta), seen, hindrance)

    def command(self, velocity: Velocity) -> None:
        """Ask for a velocity, without waiting for the robot.

        Raises:
            SessionLost: If the robot is gone or stuck.
        """
        if not self._dry_run:
            self._mover.command(velocity)

    def look(self, yaw: float, pitch: float) -> None:
        """Turn the head, in [rad], without waiting for the robot."""
        if self._dry_run or self._standing is not None:
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

    def _angles(self, patience: float) -> Array:
        """Joints as measured, in [rad]. Shape (joints,)."""
        names = self._names
        told = ask(self._motion, "getAngles", names, True, within=patience)
        try:
            angles = np.array([float(value) for value in told])
        except (TypeError, ValueError) as error:
            raise SessionLost(f"the robot says {told!r:.60}") from error
        if angles.shape != (len(names),) or not np.isfinite(angles).all():
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
        motion = self._motion
        try:
            ask(motion, "wakeUp", within=STANDING_UP)
        except TimeoutError as error:
            raise SessionLost(f"the robot: {error}") from error
        self._standing = posture.goToPosture(STAND, SLOWLY, _async=True)

    def _hindrance(self, fallen: bool, pressed: bool) -> str:
        """Why the robot must not move, by its own senses."""
        if self._pressed and not pressed:
            self._held = not self._held
        self._pressed = pressed
        if fallen:
            return "has fallen"
        if self._standing is not None:
            if not self._standing.isFinished():
                return "stands up"
            if not answer_of(self._standing, "goToPosture", within=0.0):
                return "could not stand up"
            self._standing = None
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
        future = session.service("ALMotion", _async=True)
        motion = answer_of(future, "ALMotion", within=PARTING)
        ask(motion, "stopMove", within=PARTING)
    finally:
        session.close()
