"""Control loop of a player whose robot follows velocity commands."""

from collections.abc import Callable
from enum import Enum
from functools import partial
from math import inf, isfinite
from time import monotonic, sleep

import numpy as np

from ..control.strategy_runner import StrategyRunner
from ..core.errors import StrategyError
from ..core.poses import Pose
from ..locomotion.locomotion import MotionRequest, template_velocity
from ..perception.measurement import RobotState
from ..planning import GaitSettings
from ..strategies import Strategy
from ..strategies.velocity_set import BodyVelocity, VelocitySet
from .method_thread import SessionLost
from .play_log import PlayTick, Row
from .robot import REST, VelocityLimits
from .robot_camera import PosedSight
from .robot_session import RobotSession
from .watchdog import Watchdog

PATIENCE = 0.05  # for a report before the last command is repeated, in [s]
PERIOD = 0.02  # between two reports at least, in [s]
FORSAKEN = 10.0  # without a report before the session ends, in [s]
PAUSED = 3.0  # of a simulator's clock before the status line says so, in [s]
STILL = 1e-6  # velocity below which a robot stands, in [m/s] or [rad/s]


class DrivingState(Enum):
    """State of a robot that follows velocity commands."""

    WAITING = "waiting"  # must stand, for a reason of the watchdog
    STANDING = "standing"  # may move; the strategy's intent is to stand
    WALKING = "walking"  # follows the template
    STOPPING = "stopping"  # slows down to end the session
    RESTING = "resting"  # stands at the end of the session


class TemplateController:
    r"""Controller with the velocities :math:`(\pm \bar{v}, k \theta^*)`.

    Equations (1) to (6) of the paper. ``moving`` is whether the newest
    intent is to walk.
    """

    def __init__(
        self,
        strategy: Strategy,
        gait: GaitSettings,
        velocities: VelocitySet | None = None,
    ) -> None:
        """Start without a sighting."""
        self._decisions = StrategyRunner(strategy, gait, velocities=velocities)
        self._gait, self.moving = gait, False

    def decide(self, report: RobotState) -> BodyVelocity:
        """Return the command for a report; zero without a sighting."""
        decisions, sighting = self._decisions, report.sighting
        decisions.headings.note(report.time, report.pose.theta)
        decisions.templates.note(report.time, report.pose)
        if sighting is None:
            self.moving = False
            return REST
        intent = decisions.decide(report.time, sighting, moving=self.moving)
        self.moving = intent.walks
        strategy = decisions.strategy
        return template_velocity(
            MotionRequest(intent, strategy.direction, strategy.saturated),
            self._gait,
        )


class Ramp:
    """Rate limiter of velocity commands; ``velocity`` is the newest."""

    def __init__(self, limits: VelocityLimits) -> None:
        """Start at zero velocity."""
        self._limits = limits
        self.velocity = REST

    def toward(self, wanted: BodyVelocity, passed: float) -> BodyVelocity:
        """Move the command toward a velocity, for a time in [s].

        NaN or inf stops at once.
        """
        if not all(isfinite(value) for value in wanted):
            return self.stop()
        limits, now = self._limits, self.velocity
        goal = limits.scale(wanted)
        self.velocity = BodyVelocity(
            _step(now.forward, goal.forward, limits.acceleration * passed),
            _step(now.lateral, goal.lateral, limits.acceleration * passed),
            _step(now.turn, goal.turn, limits.turn_acceleration * passed),
        )
        return self.velocity

    def stop(self) -> BodyVelocity:
        """Command zero velocity at once: the robot finishes its own step."""
        self.velocity = REST
        return REST


def _step(value: float, goal: float, most: float) -> float:
    return value + min(max(goal - value, -most), most)


class VelocityLoop:
    """Loop that drives a robot by the template's velocities.

    Any missing or implausible input stops the robot at once. When the
    inputs are valid again it continues, with a new controller.
    """

    idle, given_up = False, ""

    def __init__(
        self,
        session: RobotSession,
        make_controller: Callable[[], TemplateController],
        limits: VelocityLimits,
        *,
        watchdog: Watchdog,
        wait: float = FORSAKEN,
        eyes: PosedSight | None = None,
        clock: Callable[[], float] = monotonic,
        pause: Callable[[float], None] = sleep,
    ) -> None:
        """Start the loop; it waits for a first report for a time in [s]."""
        self._session, self._eyes = session, eyes
        self._make_controller = make_controller
        self._controller = make_controller()
        self._ramp = Ramp(limits)
        self._watchdog, self._wait = watchdog, wait
        self._paced, self._clock, self._pause = watchdog.paced, clock, pause
        self._due = clock()  # of the next report
        self._report: RobotState | None = None
        self._wanted = REST
        self._leave_reason = self._failure = ""
        self._began: float | None = None

    @property
    def ended(self) -> bool:
        """Whether the session has ended, with the robot at rest."""
        return bool(self._leave_reason) and not _moves(self._ramp.velocity)

    def leave(self, reason: str) -> None:
        """Slow down and end the session."""
        self._leave_reason = self._leave_reason or reason

    def close(self) -> None:
        """Stop the robot and disconnect."""
        if self._eyes is not None:
            self._eyes.close()
        self._session.close()

    def tick(self) -> PlayTick:
        """Read a report, decide, and send a command."""
        report, released = self._listen(), self._session.released()
        if report is not None and released:
            why = report.hindrance or released
            report = report._replace(hindrance=why)
        hindrance = self._watchdog.check(
            report, self._clock(), moves=not self._session.halted
        )
        # The clock of a simulator may pause for any time.
        longest = FORSAKEN if self._paced else inf
        if self._report is None:
            longest = self._wait
        if self._watchdog.silent > longest:
            raise SessionLost(
                f"no new report from the robot for {longest:g} s: {hindrance}"
            )
        hindrance = hindrance or released or self._failure
        velocity = self._decide(report, hindrance)
        if self._paced or report is not None:
            if velocity == REST:
                self._session.halt()
            else:
                command = self._session.robot.command
                self._session.command(partial(command, *velocity))
        return self._result(hindrance or self._failure, velocity)

    def _listen(self) -> RobotState | None:
        """Return the newest report, or None; the last one if repeated."""
        early = self._due - self._clock()
        if early > 0.0:
            self._pause(min(early, PATIENCE))
        report = self._session.listen(PATIENCE)
        last = self._report
        if report is not None and (last is None or report.time != last.time):
            self._due = self._clock() + PERIOD
        if report is None or self._eyes is None:
            return report
        return self._eyes.see(report)

    def _decide(
        self, report: RobotState | None, hindrance: str
    ) -> BodyVelocity:
        """Return the command; zero while there is a hindrance."""
        last = self._report
        if hindrance:
            if self._controller.moving:
                self._controller = self._make_controller()
            self._report, self._wanted = report or last, REST
            return self._ramp.stop()
        if report is None:
            leaves = bool(self._leave_reason)
            return self._ramp.stop() if leaves else self._ramp.velocity
        self._report = report
        passed = 0.0 if last is None else max(report.time - last.time, 0.0)
        if self._leave_reason:
            self._wanted = REST
        elif passed > 0.0 or last is None:
            try:
                self._wanted = self._controller.decide(report)
            except StrategyError as error:
                self._failure = f"the strategy failed: {error}"
                self.leave(self._failure)
                self._wanted = REST
        return self._ramp.toward(self._wanted, min(passed, 2.0 * PATIENCE))

    def _result(self, hindrance: str, velocity: BodyVelocity) -> PlayTick:
        moves = _moves(velocity)
        if self._leave_reason:
            state = DrivingState.STOPPING if moves else DrivingState.RESTING
            reason = self._leave_reason
        elif hindrance:
            state, reason = DrivingState.WAITING, hindrance
        elif moves or self._controller.moving:
            state, reason = DrivingState.WALKING, "opponent detected"
        else:
            state, reason = DrivingState.STANDING, "strategy wants to stand"
        if not self._paced and not self._leave_reason and self._report:
            if (stood := self._watchdog.silent) > PAUSED:
                reason = f"the robot's clock stands still for {stood:.0f} s; "
                reason += "Ctrl-C ends"
        report = self._report or RobotState(0.0, pose=Pose(0.0, 0.0, 0.0))
        if self._began is None and state is DrivingState.WALKING:
            self._began = report.time
        forward, lateral, turn = velocity
        aside = f"{lateral:+.3f} m/s aside, " if lateral else ""
        row: Row = {"pose": np.array(report.pose)}
        for name, each in (("wanted", self._wanted), ("velocity", velocity)):
            row[name] = np.array([each.forward, each.turn, each.lateral])
        return PlayTick(
            state,
            reason,
            report.time,
            report.sighting,
            f"{state.value} ({reason}), {forward:+.3f} m/s, "
            f"{aside}{turn:+.3f} rad/s",
            row,
            None if self._began is None else report.time - self._began,
        )


def _moves(velocity: BodyVelocity) -> bool:
    return max(abs(value) for value in velocity) > STILL
