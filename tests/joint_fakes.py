"""Fake session with a robot of three joints, on a clock set by hand."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from stepaside.core.poses import Array
from stepaside.drivers.guardian_process import SessionLost
from stepaside.drivers.joint_body import JointBody, SystemClock
from stepaside.drivers.joint_robot import JointRobot, JointTargets, Motors
from stepaside.drivers.safety_states import SafetyState
from stepaside.perception.measurement import (
    RobotState,
    RobotStatus,
    Sighting,
)

TICK = 0.02  # [s]
JOINTS = ("gripper", "knee", "neck", "hip")  # of the robot
STANCE = np.array([-0.2, 0.6, 0.0])  # of hip, knee and neck, in [rad]
MOTORS = Motors(
    ("hip", "knee", "neck"),
    low=np.array([-1.0, 0.0, -2.0]),
    high=np.array([1.0, 2.0, 2.0]),
    speed=np.array([4.0, 4.0, 0.25]),
    legs=np.array([0, 1]),
    order=np.array([3, 1, 2]),
    stiffness=np.array([100.0, 80.0, 10.0]),
    damping=np.array([3.0, 2.0, 1.0]),
)


class FakeRobot(JointRobot):
    """Robot that a session would call."""

    tick, stands = TICK, False
    joints: Sequence[str] = JOINTS
    crouch = {"knee": 1.5}  # noqa: RUF012 (as users write it)

    def __init__(self) -> None:
        self.shown: list[SafetyState] = []

    def show(self, state: SafetyState, *, sees: bool) -> None:
        """Note the state."""
        self.shown.append(state)

    def command(self, targets: JointTargets) -> None:
        """Do nothing."""


def status(**changes: Any) -> RobotStatus:
    """Return the status of a healthy robot, with changes."""
    return RobotStatus(
        stiffness=np.ones(4),
        temperature=np.full(4, 30.0),
        heat=np.zeros(4),
        current=np.zeros(4),
        charge=1.0,
        pressed=False,
        bumped=False,
    )._replace(**changes)


class FakeSession:
    """Session whose robot is where it was told to be.

    Each wait is a tick of silence or of a report; ``changes`` are those of
    the next reports.
    """

    def __init__(self, robot: FakeRobot | None = None) -> None:
        self.robot: Any = robot or FakeRobot()
        self.now, self.time = 1000.0, 50.0
        self.angles = np.array([0.3, 0.6, 0.0, -0.2])
        self.changes: dict[str, Any] = {"status": status()}
        self.sent: list[JointTargets | None] = []
        self.silent = self.broken = self.closed = False
        self.halted = True
        self.hold = ""

    @property
    def clock(self) -> SystemClock:
        """Clock of this computer."""
        return SystemClock(lambda: self.now, self._pause)

    def _pause(self, duration: float) -> None:
        self.now += duration

    def name_of(self, method: str) -> str:
        """Return the name of a method."""
        return f"{method}() of FakeRobot"

    def listen(self, patience: float, convert: Any) -> RobotState | None:
        """Let a tick pass."""
        if self.broken:
            raise SessionLost("broken")
        if self.silent:
            self.now += max(patience, 0.0)
            return None
        self.now += TICK
        self.time += TICK
        report = RobotState(
            self.time,
            self.angles,
            np.zeros(3),
            np.array([0.0, 0.0, 9.81 + 0.01 * np.sin(self.time)]),
            np.full(8, 6.5),
            Sighting(self.time, 0.4, 0.7),
            joint_velocities=np.zeros(4),
            tilt=(0.0, 0.0),
        )
        found: RobotState = convert(
            report._replace(**self.changes), self.name_of("listen")
        )
        return found

    def silence(self, waited: float) -> str:
        """Return what a session says."""
        return f"no new report for {waited:.2f} s"

    def released(self) -> str:
        """Return the reason of the switch."""
        return self.hold

    def check_blocked(self) -> None:
        """Check that commands arrive."""
        if self.broken:
            raise SessionLost("broken")

    def tell(self, method: str, call: Any) -> None:
        """Call a method at once."""
        call()

    def command(self, call: Any) -> None:
        """Move to the targets."""
        (targets,) = call.args
        self.sent.append(targets)
        self.halted = False
        stiff = targets.stiffness > 0.0
        self.angles = np.where(stiff, targets.angles, self.angles)

    def halt(self) -> None:
        """Note the release."""
        self.sent.append(None)
        self.halted = True

    def close(self, *, halts: bool = True) -> None:
        """Note it."""
        if halts or not self.halted:
            self.halt()
        self.closed = True


def play(body: JointBody, ticks: int, targets: Array = STANCE) -> None:
    """Play some ticks."""
    for _ in range(ticks):
        body.read()
        body.write(targets)


def press(session: FakeSession, body: JointBody, targets: Array) -> None:
    """Press the button, and let it go."""
    for pressed in (True, False):
        session.changes["status"] = status(pressed=pressed)
        play(body, 1, targets)


def body_of(
    session: FakeSession | None = None, **options: Any
) -> tuple[JointBody, FakeSession]:
    """Return a body, and its session."""
    session = session or FakeSession()
    made: Any = session
    body = JointBody(made, MOTORS, STANCE, clock=session.clock, **options)
    return body, session


def walking(**options: Any) -> tuple[JointBody, FakeSession]:
    """Return the body of a robot that walks since one tick."""
    body, session = body_of(**options)
    play(body, 60)
    press(session, body, STANCE)
    assert body.state is SafetyState.WALKING
    return body, session
