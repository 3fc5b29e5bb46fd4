"""Fake robot on LoLA, and a clock that is advanced by hand."""

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from stepaside.core.poses import Array
from stepaside.drivers.guardian_process import SessionLost
from stepaside.drivers.lola.conventions import LOCK_STEP, REAL_TIME
from stepaside.drivers.lola.lola_frames import (
    ActuatorFrame,
    SensorFrame,
    pack_sensors,
)
from stepaside.drivers.lola.lola_server import ActuatorFrameReader
from stepaside.drivers.lola.nao_joints import NAMES, TICK
from stepaside.perception.measurement import Measurement, Sighting

JOINTS = NAMES[:23]  # a description without hands, in LoLA's order
STANCE = np.linspace(-0.1, 0.1, 23)
STANCE[[5, 8, 13, 19]] = -0.2, 0.0, 0.0, -0.1
STANCE[20] = 0.2
STANCE[21] = 0.2
REAL_ROBOT = "P0000073A00000000012"


def sensor_frame(**changes: Any) -> SensorFrame:
    """Return the frame of a robot that stands without any fault."""
    nothing = np.zeros(25)
    position = nothing.copy()
    position[:23] = STANCE
    frame = SensorFrame(
        position=position,
        stiffness=np.ones(25),
        current=nothing,
        temperature=np.full(25, 30.0),
        status=(0,) * 25,
        accelerometer=np.array([0.0, 0.0, -9.81]),
        gyroscope=np.zeros(3),
        angles=(0.0, 0.0),
        fsr=np.full(8, 0.65),
        sonar=(2.55, 2.55),
        touch=(0.0,) * 14,
        battery=(0.9, 0.0, 0.0, 36.0),
        robot_config=(REAL_ROBOT, "6.0.0", REAL_ROBOT, "6.0.0"),
    )
    return frame._replace(**changes)


def pressed(**changes: Any) -> SensorFrame:
    """Return the same frame with the chest button pressed."""
    return sensor_frame(touch=(1.0,) + (0.0,) * 13, **changes)


def counted(number: int, *, lock_step: bool = False) -> SensorFrame:
    """Return a frame of a simulated robot, with its number."""
    body = LOCK_STEP if lock_step else REAL_TIME
    return sensor_frame(
        battery=(1.0, 0.0, 0.0, float(number)),
        robot_config=(body, "6.0.0", body, "6.0.0"),
    )


class Clock:
    """Clock that is advanced by hand."""

    def __init__(self) -> None:
        self.now = 1000.0

    def __call__(self) -> float:
        """Time, in [s]."""
        return self.now

    def pause(self, duration: float) -> None:
        """Let time pass."""
        self.now += duration


class FakeLink:
    """Link with a script of the bytes that arrive at each tick of 12 ms.

    None is a tick of silence. A robot that follows moves to its targets at
    once.
    """

    def __init__(self, clock: Clock, script: Iterable[Any] = ()) -> None:
        self.clock = clock
        self.script = iter(script)
        self.sent: list[ActuatorFrame] = []
        self.queue: list[bytes] = []
        self.follow: Callable[[ActuatorFrame], None] | None = None
        self.closed = self.broken = False

    def wait(self, timeout: float) -> bool:
        """Let ticks pass until something arrives."""
        end = self.clock.now + timeout
        while not self.queue and self.clock.now < end - 1e-9:
            self.clock.now += min(TICK, end - self.clock.now)
            self._next()
        return bool(self.queue)

    def _next(self) -> None:
        entry = next(self.script, None)
        if isinstance(entry, SensorFrame):
            entry = pack_sensors(entry)
        if isinstance(entry, bytes):
            self.queue.append(entry)
        elif entry is not None:
            self.queue += entry

    def receive(self) -> list[bytes]:
        """All that has arrived."""
        if self.broken:
            raise SessionLost("broken")
        queue, self.queue = self.queue, []
        return queue

    def send(self, data: bytes) -> None:
        """Note what is sent."""
        if self.broken:
            raise SessionLost("broken")
        self.sent += ActuatorFrameReader().feed(data)
        if self.follow is not None:
            self.follow(self.sent[-1])

    def close(self) -> None:
        """Note it."""
        self.closed = True


class MadeUpRobot:
    """A robot to be served: it is where it was told to be."""

    def __init__(self) -> None:
        self.time = 0.0
        self.angles: Array = STANCE.copy()
        self.sighting: Sighting | None = None
        self.stiffness: Array = np.full(23, np.nan)

    def sensors(self) -> Measurement:
        """Stand upright."""
        return Measurement(
            self.time,
            self.angles,
            np.zeros(3),
            np.array([0.0, 0.0, 9.81]),
            np.full(8, 6.5),
            self.sighting,
        )

    def command(self, targets: Array, stiffness: Array) -> None:
        """Follow where there is stiffness."""
        self.angles = np.where(stiffness > 0.0, targets, self.angles)
        self.stiffness = stiffness
        self.time += TICK
