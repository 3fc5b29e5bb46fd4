"""A robot whose joints are moved over NAOqi, as a line of LoLA's frames.

A frame is read from ALMemory at every tick and answered by ``setAngles`` and
``setStiffnesses``. Robots do not number what they tell: the clock of this
computer does. Simulated ones do.
"""

import logging
from collections import deque
from collections.abc import Callable, Sequence
from time import monotonic, sleep
from typing import Any, NamedTuple

import numpy as np

from ...core.poses import Array
from ...perception.measurement import Sighting
from ..guardian_process import SessionLost
from ..joint.frame_clock import TICK
from ..joint.frames import ActuatorFrame, Codec, SensorFrame
from ..joint.joint_map import JOINT_COUNT, NAMES
from ..joint.stiffness_guardian import FADING
from ..lola.conventions import COUNTER_RANGE
from .naoqi_url import IDEAL_SIGHT
from .qi_session import answer_of, ask, connect
from .sensor_keys import (
    ACCELEROMETER,
    FRAME,
    KEYS,
    OLDER,
    QUICK_KEYS,
    frame_of,
)
from .sight_reader import SightReader, read_frame

ASKING = 2.0  # longest time for a service or a single answer, in [s]
EVERY = 25  # ticks, after which temperatures and the like are read
EARLY = 0.003  # before a frame is due, when it is looked for, in [s]
POLL = 0.0005  # between two looks at a simulated robot, in [s]
STUCK = 0.5  # for which a command may be on its way, in [s]
FULL_SPEED = 1.0  # share of the motors' speed: who limits it is control
log = logging.getLogger(__name__)


class MemoryReading(NamedTuple):
    """What a robot told at one tick.

    Attributes:
        values: Of ``KEYS``.
        number: Of the frame.
        lock_step: Whether its world waits for answers.
    """

    values: Sequence[Any]
    number: int
    lock_step: bool


def read_heard(heard: MemoryReading) -> SensorFrame:
    """Frame of what a robot told.

    Raises:
        WireError: If it is none.
    """
    values, number, lock_step = heard
    return frame_of(values, number, lock_step=lock_step)


CODEC = Codec(read_heard, lambda frame: frame)


class JointTransport:
    """Carries frames between control and a robot on NAOqi.

    Attributes:
        simulated: Whether the robot is one, which numbers its frames.
        sight: Ideal line of sight that came with the newest frame: age
            [s], bearing [rad] and distance [m].
    """

    def __init__(
        self,
        url: str,
        *,
        clock: Callable[[], float] = monotonic,
        pause: Callable[[float], None] = sleep,
    ) -> None:
        """Connect.

        Args:
            url: Like tcp://HOST:PORT.
            clock: Time of this computer, in [s].
            pause: Lets time pass, in [s].

        Raises:
            SessionLost: If there is no such robot, or it has no ALMotion.
        """
        self._clock, self._pause = clock, pause
        self._session = connect(url)
        try:
            self._motion = service_of(self._session, "ALMotion")
            self._memory = service_of(self._session, "ALMemory")
            asked = [FRAME, ACCELEROMETER[0], OLDER[ACCELEROMETER[0]]]
            told = ask(self._memory, "getListData", asked, within=ASKING)
        except TimeoutError as error:
            self._session.close()
            raise SessionLost(f"the robot: {error}") from error
        except BaseException:
            self._session.close()
            raise
        frame, newer, older = told
        self.simulated = frame is not None
        self._names = OLDER if newer is None and older is not None else {}
        if self._names:
            log.warning("the robot's gyro has two axes: it does not see turns")
        self.sight: tuple[float, float, float] | None = None
        self._began, self._number = clock(), -1
        self._heard: MemoryReading | None = None
        self._due = 0.0
        self._told: dict[str, Any] = {}
        self._reads, self._sights = 0, SightReader()
        self._calls: deque[tuple[float, Any]] = deque()
        self._stiffness: Array = np.full(JOINT_COUNT, np.nan)

    def wait(self, timeout: float) -> bool:
        """Wait, in [s], until a frame is there; whether it is.

        Raises:
            SessionLost: If the robot is gone.
        """
        end = self._clock() + timeout
        while self._heard is None:
            if not self.simulated:
                due = self._began + (self._number + 1) * TICK
                self._pause(max(0.0, min(due, end) - self._clock()))
            left = end - self._clock()
            if left <= 0.0:
                return False
            try:
                self._look(left)
            except TimeoutError:
                return False
            if self._heard is None:
                self._pause(POLL)
        return True

    def receive(self) -> list[MemoryReading]:
        """The frame that has arrived, if one has."""
        heard, self._heard = self._heard, None
        return [] if heard is None else [heard]

    def send(self, frame: ActuatorFrame) -> None:
        """Command joints and stiffness, without waiting for the robot.

        Lights stay as they are.

        Raises:
            SessionLost: If the robot refuses a command, or is stuck.
        """
        self._check()
        limp = frame.position is None
        if frame.stiffness is not None:
            same = np.array_equal(frame.stiffness, self._stiffness)
            # A simulated robot takes it for the answer of who is limp.
            if not same or (limp and self.simulated):
                self._stiffness = frame.stiffness.copy()
                values = frame.stiffness.tolist()
                self._call("setStiffnesses", list(NAMES), values)
        if frame.position is not None:
            values = frame.position.tolist()
            self._call("setAngles", list(NAMES), values, FULL_SPEED)

    def close(self) -> None:
        """Let the last commands arrive, and go."""
        try:
            for _, call in self._calls:
                answer_of(call, "command", within=STUCK)
        except (SessionLost, TimeoutError) as error:
            log.warning("the robot may still be stiff: %s", error)
        finally:
            self._calls.clear()
            self._session.close()

    def _look(self, patience: float) -> None:
        """Ask for a frame; a simulated robot may have no new one."""
        if self.simulated and not self._has_spoken(patience):
            return
        keys = QUICK_KEYS if self._reads % EVERY else KEYS
        names = [self._names.get(key, key) for key in keys]
        asked = [*names, FRAME, IDEAL_SIGHT]
        told = ask(self._memory, "getListData", asked, within=patience)
        *known, frame, sight = told
        self._told.update(zip(keys, known, strict=True))
        self._reads += 1
        values = [self._told[key] for key in KEYS]
        if not self.simulated:
            passed = int((self._clock() - self._began) / TICK)
            self._number = max(passed, self._number + 1)
            self._heard = MemoryReading(
                values, self._number % COUNTER_RANGE, False
            )
            return
        number, waits = read_frame(frame)
        self._number, self.sight = number, self._sights.read(sight)
        self._heard = MemoryReading(values, number, waits)
        self._due = 0.0 if waits else self._clock() + TICK - EARLY

    def _has_spoken(self, patience: float) -> bool:
        """Whether a simulated robot has a new frame: a look that costs little.

        In real time there is none for most of a tick.
        """
        self._pause(max(0.0, min(self._due - self._clock(), patience)))
        told = ask(self._memory, "getData", FRAME, within=patience)
        return read_frame(told)[0] != self._number

    def _call(self, method: str, *values: Any) -> None:
        call = getattr(self._motion, method)(*values, _async=True)
        self._calls.append((self._clock(), call))

    def _check(self) -> None:
        """Drop what has been taken; see that nothing stays away."""
        while self._calls:
            sent, call = self._calls[0]
            if not call.isFinished():
                if self._clock() - sent > STUCK:
                    raise SessionLost("the robot takes no command")
                return
            answer_of(call, "command", within=0.0)
            self._calls.popleft()


class MemorySight:
    """Ideal line of sight of a simulated robot, as its frames bring it."""

    def __init__(self, line: JointTransport) -> None:
        """Listen on a line, which stays with the caller."""
        self._line = line

    def newest(self, frame: int, start: int) -> Sighting | None:
        """Sighting that came with the newest frame.

        Args:
            frame: Number of that frame.
            start: Number of the frame at which time is zero.
        """
        if self._line.sight is None:
            return None
        age, bearing, distance = self._line.sight
        return Sighting((frame - start) * TICK - age, bearing, distance)

    def close(self) -> None:
        """Nothing to let go of."""


def service_of(session: Any, name: str) -> Any:
    """A service of a session.

    Raises:
        TimeoutError: If it does not answer.
        SessionLost: If there is none.
    """
    future = session.service(name, _async=True)
    return answer_of(future, name, within=ASKING)


def fade(url: str, targets: Array, stiffness: Array) -> None:
    """Let the stiffness fall in place of control that is gone.

    Args:
        url: Where the robot is.
        targets: What its joints were told last; they keep it.
        stiffness: Likewise. Shape (25,).
    """
    session = connect(url)
    try:
        motion = service_of(session, "ALMotion")
        count = round(FADING / TICK)
        for left in range(count - 1, -1, -1):
            values = (stiffness * (left / count)).tolist()
            ask(motion, "setStiffnesses", list(NAMES), values, within=ASKING)
            sleep(TICK)
    finally:
        session.close()
