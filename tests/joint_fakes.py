"""Fake robot of three motors, and control of it, on a clock set by hand."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from stepaside.control.strategy_runner import StrategyRunner
from stepaside.core.poses import Array, Pose
from stepaside.drivers.joint_loop import JointLoop
from stepaside.drivers.joint_motion import Motors
from stepaside.drivers.method_thread import SessionLost
from stepaside.drivers.robot import JointRobot, JointTargets
from stepaside.drivers.robot_reports import plain_report
from stepaside.drivers.safety import SafetyState
from stepaside.locomotion.locomotion import Phase, resting_step
from stepaside.perception.measurement import RobotState, RobotStatus, Sighting
from stepaside.planning import Foot, GaitSettings
from stepaside.strategies import Evasion, Strategy

TICK = 0.02  # [s]
STANCE = np.array([-0.2, 0.6, 0.0])  # of hip, knee and neck, in [rad]
STRATEGY = Evasion()
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
    joints = "gripper", "knee", "neck", "hip"
    crouch = {"knee": 1.5}  # noqa: RUF012 (as users write it)

    def __init__(self) -> None:
        self.shown: list[SafetyState] = []

    def listen(self) -> RobotState | None:
        """Return nothing: the session has the reports."""
        return None

    def show(self, state: SafetyState, *, sees: bool) -> None:
        """Note the state."""
        self.shown.append(state)

    def command(self, targets: JointTargets) -> None:
        """Do nothing."""

    def release(self) -> None:
        """Do nothing."""


def status(**changes: Any) -> RobotStatus:
    """Return the status of a healthy robot, with changes."""
    return RobotStatus(
        stiffness=np.zeros(4),
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
    the next reports, and ``once`` those of one.
    """

    def __init__(self, **traits: Any) -> None:
        self.robot: Any = FakeRobot()
        for name, value in traits.items():
            setattr(self.robot, name, value)
        self.now, self.time = 1000.0, 50.0
        self.angles = np.array([0.3, 0.6, 0.0, -0.2])
        self.changes: dict[str, Any] = {"status": status()}
        self.once: dict[str, Any] = {}
        self.sent: list[JointTargets | None] = []
        self.silent = self.broken = self.closed = False
        self.halted = True
        self.hold = ""

    def pause(self, duration: float) -> None:
        """Let a time pass, in [s]."""
        self.now += duration

    def name_of(self, method: str) -> str:
        """Return the name of a method."""
        return f"{method}() of FakeRobot"

    def listen(self, patience: float) -> RobotState | None:
        """Let a tick pass."""
        self.check_blocked()
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
        report = report._replace(**self.changes | self.once)
        self.once = {}
        return plain_report(report, self.robot, self.name_of("listen"))

    def silence(self, waited: float) -> str:
        """Return what a session says."""
        return f"no new report for {waited:.2f} s"

    def released(self) -> str:
        """Return the reason of the switch."""
        return self.hold

    def attend(self) -> None:
        """Have no guardian."""

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


def standing_still() -> Any:
    """Nothing planned, on both feet."""
    step = resting_step(Pose(0.0, -0.05, 0.0), Foot.LEFT)
    return SimpleNamespace(
        step=lambda now: step, planned_centers=(0.0, 0.0, 0.0, 0.0)
    )


class FakeScheme:
    """Control that walks until its strategy wants nothing more."""

    def __init__(self, strategy: Strategy) -> None:
        self.decisions = StrategyRunner(strategy, GaitSettings())
        self.phase = Phase.STANDING
        self.joint_targets, self.wanted = STANCE, STANCE
        self.read: list[RobotState] = []
        self.fails: Exception | None = None
        self.begun = None
        self.sighting: Sighting | None = None
        self.locomotion, self.maneuvers = self, standing_still()
        self.pose = Pose(0.0, 0.0, 0.0)

    def update(self, measurement: Any) -> Array:
        """Walk."""
        self.read.append(measurement)
        if self.fails is not None:
            raise self.fails
        if self.phase is Phase.FALLEN:
            return STANCE
        self.decisions.headings.note(measurement.time, 0.0)
        self.decisions.templates.note(measurement.time, Pose(0.0, 0.0, 0.0))
        near = self.sighting = Sighting(measurement.time, 0.0, 0.1)
        going = self.decisions.starts(measurement.time, near)
        self.phase = Phase.WALKING if going else Phase.STANDING
        return self.wanted


class Game:
    """Joint loop with a fake robot and fake control schemes."""

    def __init__(
        self, session: FakeSession | None = None, **options: Any
    ) -> None:
        self.schemes: list[FakeScheme] = []
        self.session = session or FakeSession()
        made: Any = self.session

        def make(strategy: Strategy) -> Any:
            self.schemes.append(FakeScheme(strategy))
            return self.schemes[-1]

        self.loop = JointLoop(
            lambda: made,
            MOTORS,
            STRATEGY,
            make,
            clock=lambda: self.session.now,
            pause=self.session.pause,
            **options,
        )

    def play(self, ticks: int, targets: Array | None = None) -> Any:
        """Play some ticks, and return the last."""
        for _ in range(ticks):
            if targets is not None:
                self.schemes[-1].wanted = targets
            tick = self.loop.tick()
        return tick

    def press(self) -> Any:
        """Press the button, and let it go."""
        for pressed in (True, False):
            self.session.changes["status"] = status(pressed=pressed)
            tick = self.play(1)
        return tick

    @property
    def state(self) -> SafetyState:
        """State of the robot."""
        return self.loop.state

    @property
    def reason(self) -> str:
        """Reason for the state."""
        return self.loop.reason

    @property
    def sent(self) -> JointTargets:
        """Newest command."""
        assert self.session.sent[-1] is not None
        return self.session.sent[-1]


def walking(**options: Any) -> Game:
    """Return a game whose robot has begun to walk."""
    game = Game(**options)
    game.play(60)
    assert game.press().state is SafetyState.WALKING
    return game
