"""Fake robots that follow velocity commands."""

import json
from collections.abc import Callable, Iterable
from math import cos, sin
from pathlib import Path
from time import monotonic, sleep
from typing import Any

import numpy as np

from stepaside.core.poses import Array, Pose
from stepaside.drivers.play_log import METADATA, ROWS, columns_in
from stepaside.drivers.robot import REST
from stepaside.perception.measurement import RobotState, Sighting
from stepaside.strategies.velocity_set import BodyVelocity

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


def report(time: float, **changes: object) -> RobotState:
    """Return the report of a standing robot with a new sighting."""
    seen = AHEAD._replace(time=time)
    swayed = Pose(1e-6 * (time % 1.0), 0.0, 0.0)  # no odometry is exact
    told = RobotState(time, sighting=seen, pose=swayed)
    return told._replace(**changes)  # type: ignore[arg-type]


def read_log(folder: Path) -> dict[str, Array]:
    """Return the columns of a play's log so far."""
    about = json.loads((folder / METADATA).read_text(encoding="utf-8"))
    return columns_in((folder / ROWS).read_bytes(), about["columns"])


class FakeWalker:
    """Session with a robot of scripted reports; None is silence.

    Each look of its player takes the time of one report.
    """

    def __init__(self, script: Iterable[RobotState | None]) -> None:
        self.script = iter(script)
        self.now = 500.0
        self.asked: list[BodyVelocity] = []
        self.robot: Any = self
        self.halted = True

    def clock(self) -> float:
        """Time of this computer, by hand."""
        return self.now

    def pause(self, duration: float) -> None:
        """Do not wait."""

    def listen(self, patience: float) -> RobotState | None:
        """Return the next report of the script."""
        self.now += PERIOD
        return next(self.script, None)

    def released(self) -> str:
        """Have no switch."""
        return ""

    def command(self, call: Any) -> None:
        """Store the velocity that a call would command."""
        self.asked.append(BodyVelocity(*call.args))
        self.halted = False

    def halt(self) -> None:
        """Store it."""
        self.asked.append(REST)
        self.halted = True

    def close(self) -> None:
        """Nothing to let go of."""


class SimulatedUnicycle:
    """Simulated unicycle for servers."""

    ready = True

    def __init__(self) -> None:
        self.time = 0.0
        self.pose = Pose(0.0, 0.0, 0.0)
        self.velocity = self.commanded = REST
        self.sighting: Sighting | None = None

    def command(self, velocity: BodyVelocity) -> None:
        """Store the command."""
        self.commanded = velocity

    def state(self) -> RobotState:
        """Return the state now."""
        joints = np.array([0.1, 0.2])
        return RobotState(
            self.time, joints, sighting=self.sighting, pose=self.pose
        )

    def torso(self) -> None:
        """Do not know where the torso is."""

    def move(self, velocity: BodyVelocity, passed: float) -> None:
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
