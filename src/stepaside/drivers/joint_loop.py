"""Control loop of a player whose robot is driven by its joints."""

import logging
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from time import monotonic, sleep

import numpy as np

from ..control.scheme import ControlScheme
from ..core.errors import ReachError, StrategyError
from ..core.poses import Array
from ..locomotion.locomotion import Phase
from ..perception.measurement import RobotState
from ..strategies import StandStill, Strategy
from .joint_motion import JointMotion, Motors
from .method_thread import SessionLost
from .play_log import PlayTick, joint_row
from .robot import JointRobot, JointTargets
from .robot_camera import RobotCamera, colour_image
from .robot_reports import LEAD, ClockMeter, in_order, joint_fault, joint_jump
from .robot_session import RobotSession
from .safety import FrozenMeter, Safety, SafetyState, safety_inputs

SETTLING = 1.0  # of learned legs that were told to stand, in [s]
PATIENCE = 10.0  # for the first report, or a valid one of a simulator, in [s]
REPORT_SILENCE = 0.1  # without a valid one until the session is lost, in [s]
OLDEST = 0.5  # age of a sighting that counts as none, in [s]
# In which a robot that is not commanded is controlled all the same.
DRY_STATES = SafetyState.REACHING, SafetyState.READY, SafetyState.WALKING
MakeScheme = Callable[[Strategy], ControlScheme]
log = logging.getLogger(__name__)


class JointLoop:
    """Loop of measurement, control and joint command.

    The joint targets of control are followed only in the states that allow
    it; otherwise the joints move slowly to a posture, or are limp. Nothing
    is sent between two ticks, so that the robot's own watchdog acts if
    control hangs.

    Each walk has its own control scheme: after a walk has ended or was cut
    off, a new scheme starts from the robot's posture.

    Attributes:
        report: Newest valid report; None before the first.
        refused: Number of invalid reports so far.
    """

    def __init__(
        self,
        open_session: Callable[[], RobotSession],
        motors: Motors,
        strategy: Strategy,
        make_scheme: MakeScheme,
        *,
        gains: tuple[Array, Array] | None = None,
        open_eyes: Callable[[JointRobot], RobotCamera] | None = None,
        needs_forces: bool = False,
        dry_run: bool = False,
        clock: Callable[[], float] = monotonic,
        pause: Callable[[float], None] = sleep,
    ) -> None:
        """Build the control scheme, then connect.

        In this order, as building takes longer than the time in which the
        first report must be answered. A camera replaces the sightings of
        reports; other gains hold while control moves the motors.
        """
        self._strategy, self._make_scheme = strategy, make_scheme
        self._schemes = 0
        self._renew_scheme()
        self._motors, self._dry_run = motors, dry_run
        self._own = motors.stiffness, motors.damping
        self._gains, self._needs_forces = gains, needs_forces
        self._clock, self._pause = clock, pause
        self._session = open_session()
        self._robot: JointRobot = self._session.robot
        robot = self._robot
        try:
            self._eyes = open_eyes(robot) if open_eyes else None
        except BaseException:
            self._session.close(halts=False)
            raise
        self._motion = JointMotion(
            self._scheme.joint_targets,
            motors,
            robot.tick,
            crouch=robot.crouch,
            soft=gains is not None,
            at_once=robot.stands,
        )
        self._safety, self._accelerometer = Safety(), FrozenMeter()
        self._meter = ClockMeter(stamped=robot.stamped)
        self._heard = clock()
        self._first = 0.0  # time of the first report, on the robot's clock
        self._count, self._start = -1, 0
        self._shown: tuple[SafetyState, bool] | None = None
        # One that does not stand by itself may be stiff at first.
        self._is_released = robot.stands
        self._presses = False
        self._jump = ""
        self.refused = 0
        self.report: RobotState | None = None
        self._stood = 0  # ticks of a stop in which control has stood
        self._leaves = self._was_stiff = False

    @property
    def state(self) -> SafetyState:
        """State of the robot."""
        return self._safety.state

    @property
    def reason(self) -> str:
        """Reason for the state, as a message."""
        return self._safety.reason

    @property
    def ended(self) -> bool:
        """Whether the session has ended, with the robot limp."""
        return self._leaves and self.idle

    @property
    def idle(self) -> bool:
        """Whether the robot is limp."""
        return self.state is SafetyState.LIMP

    @property
    def given_up(self) -> str:
        """Reason why a robot without a button was released; else empty."""
        has_button = self.report is not None and self.report.status is not None
        if has_button or not (self.idle and self._was_stiff):
            return ""
        return f"the robot was released: {self.reason}"

    def leave(self, reason: str) -> None:
        """Stop, crouch and go limp, and end the session."""
        self._leaves = True
        self._safety.rest(reason, self._time)

    def close(self) -> None:
        """Ramp the stiffness down, in any state, and disconnect."""
        try:
            self._fade()
        finally:
            if self._eyes is not None:
                self._eyes.close()
            self._session.close(halts=False)

    def tick(self) -> PlayTick:
        """Read a measurement, decide, and command the joints."""
        try:
            measurement = self._read()
            state = self.state
            is_controlled = state.moves_by_control
            if self._dry_run:
                is_controlled = state in DRY_STATES
            is_resting = state is SafetyState.RESTING
            if self._used and not is_controlled and not is_resting:
                self._renew_scheme()
            targets = self._scheme.joint_targets
            if is_controlled:
                targets = self._update(measurement)
            self._write(targets)
        except SessionLost as error:
            self._fail(str(error))
            self._fade()
            raise
        self._was_stiff = self._was_stiff or not self.idle
        scheme = self._scheme
        words = f"{self.state.value} ({self.reason}), {scheme.phase.value}"
        if self.refused:
            words += f", {self.refused} reports refused"
        walks = self.state is SafetyState.WALKING
        return PlayTick(
            self.state,
            self.reason,
            measurement.time,
            scheme.sighting if is_controlled else measurement.sighting,
            words,
            joint_row(
                measurement,
                targets,
                scheme,
                self._schemes,
                scheme.begun if is_controlled else None,
            ),
            measurement.time if walks else None,
        )

    def _update(self, measurement: RobotState) -> Array:
        """Update control, and release the robot if that fails."""
        self._used = True
        scheme = self._scheme
        if self.state is not SafetyState.STOPPING:
            self._stood = 0
        else:
            scheme.decisions.adopt(StandStill())  # ends the walk
            self._stood = (
                self._stood + 1 if scheme.phase is Phase.STANDING else 0
            )
            learned = scheme.locomotion.maneuvers is None
            settling = SETTLING if learned else 0.0
            if self._stood * self._robot.tick > settling:
                self._safety.halted(self._time)
        try:
            targets = scheme.update(measurement)
        except (ReachError, StrategyError) as error:
            lost = isinstance(error, ReachError)
            what = (
                "control lost its footing" if lost else "the strategy failed"
            )
            self._fail(f"{what}: {error}")
            return scheme.joint_targets
        if scheme.phase is Phase.FALLEN:
            self._fail("control detected a fall")
        if not np.all(np.isfinite(targets)):
            self._fail("joint targets of control contain NaN or inf")
        return targets

    def _renew_scheme(self) -> None:
        self._scheme = self._make_scheme(self._strategy)
        self._schemes += 1
        self._used = False

    def _read(self) -> RobotState:
        """Wait for the robot's next report, and update the state.

        Time is zero at the report with which walking begins.
        """
        report, gap = self._listen()
        is_first, share = self.report is None, 0.0
        if report.status is not None:
            legs = report.status.stiffness[self._motors.legs]
            share = float(np.clip(legs, 0.0, 1.0).max())
        if is_first:
            self._motion.share = share  # of who held the robot before
            self._motion.targets = report.joint_positions
        elif gap > REPORT_SILENCE and self._robot.paced:
            self._safety.fail(f"no report was read for {gap:.2f} s",
                              self._time)  # fmt: skip
            if report.status is not None:
                self._motion.weaken(share)
        self.report = report
        was_walking = self.state.moves_by_control
        unseen = self._unseen(report)
        self._note_safety(report, unseen)
        if self.state is SafetyState.WALKING and not was_walking:
            self._start = self._count
        time = (self._count - self._start) * self._robot.tick
        shift = time - report.time
        sighting, percepts = report.sighting, report.percepts
        if unseen or self._eyes is not None or sighting is None:
            sighting = None
        else:
            taken = min(sighting.time, report.time)
            sighting = sighting._replace(time=taken + shift)
        if self._eyes is not None:
            image = self._eyes.take(report.time)
            if image is not None:
                percepts = (colour_image(image), *percepts)
        return report._replace(
            time=time,
            sighting=sighting,
            percepts=tuple(
                replace(each, time=each.time + shift) for each in percepts
            ),
        )

    def _unseen(self, report: RobotState) -> str:
        """Return why there is no sighting that counts; empty if there is."""
        if self._eyes is not None:
            return self._eyes.hindrance
        if report.sighting is None:
            return "no sighting of the opponent"
        age = report.time - report.sighting.time
        if -LEAD <= age <= OLDEST:
            return ""
        return f"the sighting of the opponent is {age:.2f} s old"

    def _note_safety(self, report: RobotState, unseen: str) -> None:
        state, motors, now = self.state, self._motors, self._time
        hindrance = self._session.released() or report.hindrance or self._jump
        self._jump = ""
        if report.status is not None:
            pressed = report.status.pressed
        else:
            # There is no button: walking begins when the robot is ready.
            pressed = state is SafetyState.READY and not self._presses
            hindrance = hindrance or unseen
        self._presses = pressed
        motion = self._motion
        legs = [report.joint_positions, motion.targets]
        frozen = self._accelerometer.frozen(
            report.accelerometer,
            np.concatenate([each[motors.legs] for each in legs]),
            now,
            walks=state.moves_by_control,
        )
        self._safety.frame(
            safety_inputs(
                report._replace(hindrance=hindrance),
                motors.legs,
                now,
                pressed=pressed,
                reached=self._dry_run
                or motion.reached(state, report.joint_positions),
                frozen=frozen,
            )
        )

    def _listen(self) -> tuple[RobotState, float]:
        """Return the newest valid report, and the time since the last [s].

        Reports count by their times: there is one in each tick, the first at
        or after its time. A simulator may pause for any time.
        """
        pauses = self.report is not None and not self._robot.paced
        patient = self.report is None or pauses
        limit = PATIENCE if patient else REPORT_SILENCE
        deadline = max(self._heard + limit, self._clock())
        refused, refusal = self.refused, ""
        while True:
            report = self._session.listen(deadline - self._clock())
            now = self._clock()
            if report is not None and self._is_new(report, now):
                report = in_order(report, self._motors.order)
                fault = self._fault(report)
                if not fault:
                    gap, self._heard = now - self._heard, now
                    return report, gap
                self.refused, refusal = self.refused + 1, fault
                if self.refused.bit_count() == 1:  # 1, 2, 4, 8...
                    log.warning("report refused (%d): %s", self.refused, fault)
            if now >= deadline:
                waited = now - self._heard
                if self.refused == refused:
                    if pauses:
                        deadline = now + PATIENCE
                        continue
                    raise SessionLost(self._session.silence(waited))
                raise SessionLost(
                    f"no valid report for {waited:.3f} s, {self.refused} "
                    f"refused: {refusal}"
                )

    def _is_new(self, report: RobotState, now: float) -> bool:
        """Count a report, and return whether it is the first of its tick."""
        name = self._session.name_of("listen")
        if not np.isfinite(report.time):
            raise SessionLost(
                f"{name}: the time must be finite, got {report.time}"
            )
        if self._count < 0:
            self._first = report.time
        elif report.time < self._first:
            raise SessionLost(
                f"{name}: the time went back to {report.time:.3f} s"
            )
        tick = self._robot.tick
        number = round((report.time - self._first) / tick)
        if number <= self._count:
            return False
        off = self._meter.fault(number * tick, now)
        if self._robot.paced and off:
            raise SessionLost(f"{name}: its times are {off}")
        self._count = number
        return True

    def _fault(self, report: RobotState) -> str:
        """Return why a report cannot be used; empty if it can."""
        name = self._session.name_of("listen")
        if self._needs_forces and np.isnan(report.foot_forces).all():
            return (
                f"{name}: foot_forces are needed by the paper's walk; use "
                "learned legs"
            )
        fault = joint_fault(report, self._motors)
        if not fault and self.report is not None:
            fault = joint_jump(report, self.report, self._motors)
            self._jump = self._jump or fault
        return f"{name}: {fault}" if fault else ""

    def _fail(self, reason: str) -> None:
        """Go limp, for a reason of control."""
        self._safety.fail(reason, self._time)

    @property
    def _time(self) -> float:
        """Time of the newest report since the first, in [s]."""
        return self._count * self._robot.tick

    def _write(self, wanted: Array) -> None:
        """Answer the newest report with the targets of control, in [rad]."""
        assert self.report is not None
        targets, stiffness = self._motion.move(self.state, self.report, wanted)
        shown = self.state, self.report.sighting is not None
        if shown != self._shown:
            self._shown = shown
            state, sees = shown
            show = partial(self._robot.show, state, sees=sees)
            self._session.tell("show", show)
        self._command(targets, stiffness)

    def _command(self, targets: Array, stiffness: Array) -> None:
        """Command targets at a share of the gains, or release the joints."""
        session = self._session
        session.check_blocked()
        if not stiffness.any():
            if not session.halted or not self._is_released:
                self._is_released = True
                session.halt()
            session.attend()
            return
        gains = self._own
        if self._gains is not None and self.state.moves_by_control:
            gains = self._gains
        rows = np.zeros((3, len(self._robot.joints)))
        rows[:, self._motors.order] = (
            targets, stiffness * gains[0], stiffness * gains[1]
        )  # fmt: skip
        session.command(partial(self._robot.command, JointTargets(*rows)))

    def _fade(self) -> None:
        """Ramp the stiffness down, as far as commands can be sent."""
        if self._dry_run or self.report is None:
            return
        while self._motion.share > 0.0:
            targets, stiffness = self._motion.fade()
            try:
                self._command(targets, stiffness)
            except SessionLost:
                return
            self._pause(self._robot.tick)
