"""Link of sensor and actuator frames over NAOqi.

At every tick a frame is read from ALMemory and answered by ``setAngles`` and
``setStiffnesses``. Frames of a real robot are numbered by the clock of this
computer; a simulated robot numbers its frames.
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
from ..joint.frame_clock import COUNTER_RANGE
from ..joint.frames import Codec, JointCommand
from ..joint.stiffness_guardian import FADING
from ..lola.conventions import joint_frame_of
from ..lola.lola_frames import SensorFrame
from ..lola.nao_joints import JOINT_COUNT, NAMES, TICK
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

ANSWER_TIMEOUT = 2.0  # for a service or a single answer, in [s]
SLOW_INTERVAL = 25  # ticks between two readings of slow values
EARLY = 0.003  # time before a frame is due at which polling starts, in [s]
POLL = 0.0005  # between two polls of a simulated robot, in [s]
COMMAND_TIMEOUT = 0.5  # for the answer to a command, in [s]
FULL_SPEED = 1.0  # fraction of the motors' speed: control limits the speed
log = logging.getLogger(__name__)


class MemoryReading(NamedTuple):
    """Values of ALMemory at one tick.

    Attributes:
        values: Values of ``KEYS``, in that order.
        number: Number of the frame.
        lock_step: Whether the simulation waits for answers.
    """

    values: Sequence[Any]
    number: int
    lock_step: bool


def read_frame_values(reading: MemoryReading) -> SensorFrame:
    """Convert a reading to a sensor frame.

    Raises:
        WireError: If a required value is missing or invalid.
    """
    values, number, lock_step = reading
    return frame_of(values, number, lock_step=lock_step)


CODEC = Codec(
    lambda reading: joint_frame_of(read_frame_values(reading)),
    lambda command: command,
)


class JointTransport:
    """Link between control and a robot on NAOqi.

    Attributes:
        simulated: Whether the robot is simulated, and numbers its frames.
        sight: Ideal line of sight of the newest frame: age [s], bearing
            [rad] and distance [m]; None without one.
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
            url: Address like tcp://HOST:PORT.
            clock: Time of this computer, in [s].
            pause: Function that sleeps for a time in [s].

        Raises:
            SessionLost: If no robot with ALMotion and ALMemory answers.
        """
        self._clock, self._pause = clock, pause
        self._session = connect(url)
        try:
            self._motion = service_of(self._session, "ALMotion")
            self._memory = service_of(self._session, "ALMemory")
            keys = [FRAME, ACCELEROMETER[0], OLDER[ACCELEROMETER[0]]]
            frame, newer, older = ask(
                self._memory, "getListData", keys, within=ANSWER_TIMEOUT
            )
        except TimeoutError as error:
            self._session.close()
            raise SessionLost(f"the robot: {error}") from error
        except BaseException:
            self._session.close()
            raise
        self.simulated = frame is not None
        self._names = OLDER if newer is None and older is not None else {}
        if self._names:
            log.warning("the robot's gyro has two axes: no turning rate")
        self.sight: tuple[float, float, float] | None = None
        self._began, self._number = clock(), -1
        self._reading: MemoryReading | None = None
        self._due = 0.0
        self._values: dict[str, Any] = {}
        self._reads, self._sights = 0, SightReader()
        self._calls: deque[tuple[float, Any]] = deque()
        self._stiffness: Array = np.full(JOINT_COUNT, np.nan)

    def wait(self, timeout: float) -> bool:
        """Wait up to ``timeout``, in [s]; return whether a frame is there.

        Raises:
            SessionLost: If the connection has failed.
        """
        end = self._clock() + timeout
        while self._reading is None:
            if not self.simulated:
                due = self._began + (self._number + 1) * TICK
                self._pause(max(0.0, min(due, end) - self._clock()))
            left = end - self._clock()
            if left <= 0.0:
                return False
            try:
                self._read(left)
            except TimeoutError:
                return False
            if self._reading is None:
                self._pause(POLL)
        return True

    def receive(self) -> list[MemoryReading]:
        """Return the frame that has arrived, if any."""
        reading, self._reading = self._reading, None
        return [] if reading is None else [reading]

    def send(self, command: JointCommand) -> None:
        """Command joints and stiffness, without waiting for the answer.

        Lights are not commanded.

        Raises:
            SessionLost: If the robot refuses a command or does not answer.
        """
        self._check()
        limp = command.position is None
        if command.stiffness is not None:
            same = np.array_equal(command.stiffness, self._stiffness)
            # A simulated robot takes it for the answer of a limp client.
            if not same or (limp and self.simulated):
                self._stiffness = command.stiffness.copy()
                values = command.stiffness.tolist()
                self._call("setStiffnesses", list(NAMES), values)
        if command.position is not None:
            values = command.position.tolist()
            self._call("setAngles", list(NAMES), values, FULL_SPEED)

    def close(self) -> None:
        """Wait for the last commands, and disconnect."""
        try:
            for _, call in self._calls:
                answer_of(call, "command", within=COMMAND_TIMEOUT)
        except (SessionLost, TimeoutError) as error:
            log.warning("the robot may still be stiff: %s", error)
        finally:
            self._calls.clear()
            self._session.close()

    def _read(self, timeout: float) -> None:
        """Read a frame; a simulated robot may not have a new one."""
        if self.simulated and not self._has_new_frame(timeout):
            return
        keys = QUICK_KEYS if self._reads % SLOW_INTERVAL else KEYS
        names = [self._names.get(key, key) for key in keys]
        *new, frame, sight = ask(
            self._memory,
            "getListData",
            [*names, FRAME, IDEAL_SIGHT],
            within=timeout,
        )
        self._values.update(zip(keys, new, strict=True))
        self._reads += 1
        values = [self._values[key] for key in KEYS]
        if not self.simulated:
            passed = int((self._clock() - self._began) / TICK)
            self._number = max(passed, self._number + 1)
            self._reading = MemoryReading(
                values, self._number % COUNTER_RANGE, False
            )
            return
        number, waits = read_frame(frame)
        self._number, self.sight = number, self._sights.read(sight)
        self._reading = MemoryReading(values, number, waits)
        self._due = 0.0 if waits else self._clock() + TICK - EARLY

    def _has_new_frame(self, timeout: float) -> bool:
        """Poll the number of a simulated robot's frame.

        Cheaper than a full read: in real time there is no new frame for
        most of a tick.
        """
        self._pause(max(0.0, min(self._due - self._clock(), timeout)))
        frame = ask(self._memory, "getData", FRAME, within=timeout)
        return read_frame(frame)[0] != self._number

    def _call(self, method: str, *values: Any) -> None:
        call = getattr(self._motion, method)(*values, _async=True)
        self._calls.append((self._clock(), call))

    def _check(self) -> None:
        """Remove answered calls; raise if an answer is overdue."""
        while self._calls:
            sent, call = self._calls[0]
            if not call.isFinished():
                if self._clock() - sent > COMMAND_TIMEOUT:
                    raise SessionLost(
                        "the robot did not answer a command within "
                        f"{COMMAND_TIMEOUT:g} s"
                    )
                return
            answer_of(call, "command", within=0.0)
            self._calls.popleft()


class MemorySight:
    """Ideal line of sight that a simulated robot sends with its frames."""

    def __init__(self, link: JointTransport) -> None:
        """Read from a link, which the caller closes."""
        self._link = link

    def newest(self, frame: int, start: int) -> Sighting | None:
        """Return the sighting of the newest frame.

        Args:
            frame: Number of that frame.
            start: Number of the frame at which time is zero.
        """
        if self._link.sight is None:
            return None
        age, bearing, distance = self._link.sight
        return Sighting((frame - start) * TICK - age, bearing, distance)

    def close(self) -> None:
        """Do nothing: the link is closed by its owner."""


def service_of(session: Any, name: str) -> Any:
    """Return a service of a session.

    Raises:
        TimeoutError: If it does not answer.
        SessionLost: If it does not exist.
    """
    future = session.service(name, _async=True)
    return answer_of(future, name, within=ANSWER_TIMEOUT)


def ramp_stiffness_down(url: str, targets: Array, stiffness: Array) -> None:
    """Ramp the stiffness down when control has failed.

    Args:
        url: Address of the robot.
        targets: Newest joint targets, which the joints keep.
        stiffness: Newest commanded stiffness. Shape (25,).
    """
    session = connect(url)
    try:
        motion = service_of(session, "ALMotion")
        count = round(FADING / TICK)
        for left in range(count - 1, -1, -1):
            values = (stiffness * (left / count)).tolist()
            ask(
                motion,
                "setStiffnesses",
                list(NAMES),
                values,
                within=ANSWER_TIMEOUT,
            )
            sleep(TICK)
    finally:
        session.close()
