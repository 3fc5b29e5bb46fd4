"""Fake robots that follow velocity commands."""

from collections.abc import Callable, Iterable
from math import cos, sin
from time import monotonic, sleep
from typing import Any

from stepaside.core.poses import Pose
from stepaside.drivers.guardian_process import SessionLost
from stepaside.drivers.velocity.velocity_body import (
    REST,
    VelocityCommand,
    VelocityReport,
)
from stepaside.drivers.velocity.walking_robot import WalkerState
from stepaside.perception.measurement import Sighting

LONGEST = 200.0  # for what takes milliseconds, in [s]
PERIOD = 0.05  # between reports, in [s]
AHEAD = Sighting(0.0, 0.4, 1.0)


def until(done: Callable[[], Any]) -> Any:
    """Wait for a message."""
    end = monotonic() + LONGEST
    while monotonic() < end:
        answer = done()
        if answer:
            return answer
        sleep(0.002)
    raise AssertionError("nothing came")


def report(time: float, **changes: object) -> VelocityReport:
    """Return the report of a standing robot with a new sighting."""
    seen = AHEAD._replace(time=time)
    return VelocityReport(time, Pose(0.0, 0.0, 0.0), seen)._replace(**changes)  # type: ignore[arg-type]


class FakeWalker:
    """Robot with scripted reports; None is silence.

    Each look of its player takes the time of one report.
    """

    def __init__(self, script: Iterable[VelocityReport | None]) -> None:
        self.script = iter(script)
        self.now = 500.0
        self.asked: list[VelocityCommand] = []
        self.breaks = False

    def clock(self) -> float:
        """Time of this computer, in [s]."""
        return self.now

    def listen(self, patience: float) -> VelocityReport | None:
        """Return the next report of the script."""
        self.now += PERIOD
        return next(self.script, None)

    def command(self, velocity: VelocityCommand) -> None:
        """Store the command."""
        if self.breaks:
            raise SessionLost("broken")
        self.asked.append(velocity)

    def close(self) -> None:
        """Nothing to let go of."""


class SimulatedUnicycle:
    """Simulated unicycle for servers."""

    def __init__(self) -> None:
        self.time = 0.0
        self.pose = Pose(0.0, 0.0, 0.0)
        self.velocity = self.commanded = REST
        self.sighting: Sighting | None = None

    def command(self, velocity: VelocityCommand) -> None:
        """Store the command."""
        self.commanded = velocity

    def state(self) -> WalkerState:
        """Return the state now."""
        return WalkerState(
            self.time,
            self.pose,
            self.velocity,
            [0.1, 0.2],
            self.sighting,
        )

    def move(self, velocity: VelocityCommand, passed: float) -> None:
        """Go on for some time, in [s]."""
        x, y, heading = self.pose
        way = velocity.forward * passed
        self.velocity = velocity
        self.time += passed
        self.pose = Pose(
            x + way * cos(heading),
            y + way * sin(heading),
            heading + velocity.turn * passed,
        )
