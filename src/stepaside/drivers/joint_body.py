"""Body of a robot that is driven by its joints: states, limits, commands."""

import logging
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from math import pi
from time import monotonic, sleep
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.errors import shown
from ..core.poses import Array
from ..perception.measurement import RobotState, Sighting
from .guardian_process import SessionLost
from .image_source import ImageSource
from .joint_motion import JointMotionState
from .joint_robot import JointRobot, JointTargets, Motors
from .robot_session import RobotSession, joint_state
from .safety_conditions import SafetyInputs, SafetyMonitor, SafetySettings
from .safety_states import Safety, SafetyState
from .sighting_checks import sighting_fault
from .watchdog import LeadMeter

PATIENCE = 10.0  # for the first report, or of a simulator, in [s]
OLDEST = 0.5  # age of a sighting that counts as none, in [s]
EARLY = 0.1  # by which a sighting may be ahead of its report, in [s]
BEYOND = 0.35  # a joint's angle may be outside its range by, in [rad]
FASTEST = 35.0  # plausible angular velocity of a torso, in [rad/s]
log = logging.getLogger(__name__)


class MotorGains(NamedTuple):
    """Gains of the torque of each motor, from target to angle.

    Attributes:
        stiffness: In [N m/rad]. Shape (motors,).
        damping: In [N m s/rad]. Shape (motors,).
    """

    stiffness: Array
    damping: Array


class SystemClock(NamedTuple):
    """Clock of this computer.

    Attributes:
        read: Returns the time, in [s].
        pause: Sleeps for a time, in [s].
    """

    read: Callable[[], float] = monotonic
    pause: Callable[[float], None] = sleep


SYSTEM_CLOCK = SystemClock()


def joint_fault(report: RobotState, motors: Motors) -> str:
    """Return why a report is implausible; empty if it is plausible.

    Args:
        report: The report, in the order of the motors.
        motors: Motors of the robot.
    """
    for name in (
        *("joint_positions", "joint_velocities", "gyro", "accelerometer"),
        "tilt",
    ):
        values = getattr(report, name)
        if not np.all(np.isfinite(values)):
            return f"{name} must be finite, got {shown(values)}"
    forces = report.foot_forces
    if np.isinf(forces).any() or 0 < np.isnan(forces).sum() < len(forces):
        return f"foot_forces must be finite, got {shown(forces)}"
    position = report.joint_positions
    off = np.maximum(motors.low - position, position - motors.high)
    if off.max() > BEYOND:
        at = int(off.argmax())
        return (
            f"{motors.names[at]} is at {position[at]:.2f} rad, outside "
            f"its range [{motors.low[at]:.2f}, {motors.high[at]:.2f}] "
            "rad: is it in degrees?"
        )
    if report.tilt is not None and max(map(abs, report.tilt)) > pi:
        return f"tilt is {report.tilt} rad: is it in degrees?"
    if np.abs(report.gyro).max() > FASTEST:
        rates = report.gyro.tolist()
        return f"gyro reads {rates} rad/s: is it in deg/s?"
    if report.sighting is not None:
        return sighting_fault(*report.sighting[1:3])
    return ""


def in_order(report: RobotState, order: NDArray[np.intp]) -> RobotState:
    """Return a report in the order of the motors.

    Args:
        report: Report in the order of the robot's joints.
        order: Index of each motor among those joints. Shape (motors,).
    """
    assert report.joint_velocities is not None
    status = report.status
    if status is not None:
        status = status._replace(
            stiffness=status.stiffness[order],
            temperature=status.temperature[order],
            heat=status.heat[order],
            current=status.current[order],
        )
    return report._replace(
        joint_positions=report.joint_positions[order],
        joint_velocities=report.joint_velocities[order],
        status=status,
    )


class JointBody:
    """Robot behind the interface read, write, close.

    The joint targets of control are followed only in the states that allow
    it; otherwise the joints move slowly to a posture, or are limp. Nothing
    is sent between two calls of :meth:`read`, so that the robot's own
    watchdog acts if control hangs.

    Attributes:
        tick: Time from one report to the next, in [s].
        report: Newest valid report; None before the first.
        refused: Number of invalid reports so far.
    """

    def __init__(
        self,
        session: RobotSession,
        motors: Motors,
        stance: Array,
        *,
        gains: MotorGains | None = None,
        eyes: ImageSource | None = None,
        needs_forces: bool = False,
        safety: SafetySettings | None = None,
        dry_run: bool = False,
        clock: SystemClock = SYSTEM_CLOCK,
    ) -> None:
        """Start; the robot is limp, or stands by itself.

        Args:
            session: Session with the robot; closed with the body.
            motors: Motors of the robot.
            stance: Posture in which control begins, in [rad].
                Shape (motors,).
            gains: Gains while control moves the joints; None for those that
                hold a posture.
            eyes: Cameras, if used, which replace the sightings of reports.
            needs_forces: Whether control cannot work without foot forces.
            safety: Limits of safe operation.
            dry_run: Whether nothing is commanded.
            clock: Clock of this computer.
        """
        settings = safety or SafetySettings()
        robot: JointRobot = session.robot
        self._session, self._robot, self._motors = session, robot, motors
        self._own = MotorGains(motors.stiffness, motors.damping)
        self._gains, self._eyes = gains, eyes
        self._needs_forces, self._dry_run = needs_forces, dry_run
        self.tick = robot.tick
        self._motion = JointMotionState(
            stance,
            motors,
            robot.tick,
            crouch=robot.crouch,
            soft=gains is not None,
            at_once=robot.stands,
        )
        self._vitals = SafetyMonitor(settings.look_ahead, motors.legs)
        self._silence, self._safety = settings.silence, Safety(settings)
        self._clock, self._pause = clock
        self._lead = LeadMeter()
        self._heard = self._clock()
        self._first = 0.0  # time of the first report, on the robot's clock
        self._count, self._start = -1, 0
        self._state = SafetyState.LIMP
        self._shown: tuple[SafetyState, bool] | None = None
        # One that does not stand by itself may be stiff at first.
        self._is_released = robot.stands
        self._presses = False
        self._refusal = ""
        self.refused = 0
        self.report: RobotState | None = None

    @property
    def state(self) -> SafetyState:
        """State of the robot."""
        return self._state

    @property
    def reason(self) -> str:
        """Reason for the state, as a message."""
        return self._safety.reason

    def read(self) -> RobotState:
        """Wait for the robot's next report.

        Time is zero at the report with which walking begins.

        Raises:
            SessionLost: If there is no valid report in time; the robot has
                been released then.
        """
        try:
            report, gap = self._listen()
        except SessionLost as error:
            self._lose(str(error))
            raise
        is_late = gap > self._silence and self._robot.paced
        if self.report is not None and is_late:
            why = f"no report was read for {gap:.2f} s"
            self._safety.fail(why, self._time)
            if report.status is not None:
                legs = report.status.stiffness[self._motors.legs]
                self._motion.weaken(float(legs.max()))
        self.report = report
        was_walking = self._state.moves_by_control
        self._change(self._safety.frame(self._safety_inputs(report)))
        if self._state is SafetyState.WALKING and not was_walking:
            self._start = self._count
        time = (self._count - self._start) * self.tick
        return self._at(time, report)

    def write(self, joint_targets: Array) -> None:
        """Answer the newest report.

        Args:
            joint_targets: Joint targets of control, in [rad]; followed only
                in the states that allow it. Shape (motors,).

        Raises:
            SessionLost: If the robot cannot be commanded.
        """
        if self.report is None:
            return
        if not np.all(np.isfinite(joint_targets)):
            self.fail("joint targets of control contain NaN or inf")
        targets, stiffness = self._motion.move(
            self._state, self.report, joint_targets
        )
        shown = self._state, self.report.sighting is not None
        if shown != self._shown:
            self._shown = shown
            state, sees = shown
            show = partial(self._robot.show, state, sees=sees)
            self._session.tell("show", show)
        try:
            self._command(targets, stiffness)
        except SessionLost as error:
            self._lose(str(error))
            raise

    def halted(self) -> None:
        """Report that control has stopped the robot."""
        self._safety.halted(self._time)
        self._change(self._safety.state)

    def rest(self, reason: str) -> None:
        """Stop, crouch and go limp."""
        self._safety.rest(reason, self._time)
        self._change(self._safety.state)

    def fail(self, reason: str) -> None:
        """Go limp, for a reason of control."""
        self._safety.fail(reason, self._time)
        self._change(self._safety.state)

    def close(self) -> None:
        """Ramp the stiffness down, in any state, and disconnect."""
        try:
            self._fade()
        finally:
            if self._eyes is not None:
                self._eyes.close()
            self._session.close(halts=False)

    @property
    def _time(self) -> float:
        """Time of the newest report since the first, in [s]."""
        return self._count * self.tick

    def _listen(self) -> tuple[RobotState, float]:
        """Return the newest valid report, and the time since the last [s].

        Reports count by their times: there is one in each tick, the first at
        or after its time.
        """
        is_first = self.report is None
        patient = is_first or not self._robot.paced
        limit = PATIENCE if patient else self._silence
        deadline = max(self._heard + limit, self._clock())
        count = len(self._robot.joints)
        refused = self.refused
        while True:
            report = self._session.listen(
                deadline - self._clock(),
                lambda got, name: joint_state(got, name, count),
            )
            now = self._clock()
            if report is not None and self._is_new(report, now):
                fault = self._fault(report)
                if not fault:
                    gap, self._heard = now - self._heard, now
                    return in_order(report, self._motors.order), gap
                self._refuse(fault)
            if now >= deadline:
                waited = now - self._heard
                if self.refused == refused:
                    raise SessionLost(self._session.silence(waited))
                raise SessionLost(
                    f"no valid report for {waited:.3f} s, {self.refused} "
                    f"refused: {self._refusal}"
                )

    def _is_new(self, report: RobotState, now: float) -> bool:
        """Count a report, and return whether it is the first of its tick.

        Raises:
            SessionLost: If its time is not finite, went back or runs ahead.
        """
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
        number = round((report.time - self._first) / self.tick)
        if number <= self._count:
            return False
        passed = (number - self._count) * self.tick
        if self._robot.paced and (ahead := self._lead.fault(passed, now)):
            raise SessionLost(f"{name}: its times are {ahead}")
        self._count = number
        return True

    def _fault(self, report: RobotState) -> str:
        """Return why a report cannot be used; empty if it can."""
        name = self._session.name_of("listen")
        if self._needs_forces and np.isnan(report.foot_forces).all():
            return (
                f"{name}: foot_forces are needed by the paper's walk; use "
                "--legs"
            )
        fault = joint_fault(in_order(report, self._motors.order), self._motors)
        return f"{name}: {fault}" if fault else ""

    def _refuse(self, fault: str) -> None:
        self.refused += 1
        self._refusal = fault
        if self.refused.bit_count() == 1:  # 1, 2, 4, 8...
            log.warning("report refused (%d): %s", self.refused, fault)

    def _at(self, time: float, report: RobotState) -> RobotState:
        """Return a report at a time of control, in [s], with its images."""
        shift = time - report.time
        sighting = self._sighting_of(report)
        if sighting is not None:
            sighting = sighting._replace(time=sighting.time + shift)
        percepts = report.percepts
        if self._eyes is not None:
            percepts = (*self._eyes.percepts(report.time), *percepts)
        return report._replace(
            time=time,
            sighting=sighting,
            percepts=tuple(
                replace(each, time=each.time + shift) for each in percepts
            ),
        )

    def _sighting_of(self, report: RobotState) -> Sighting | None:
        """Return the sighting of a report, if it counts."""
        sighting = report.sighting
        if self._eyes is not None or sighting is None:
            return None
        age = report.time - sighting.time
        if not -EARLY <= age <= OLDEST:
            return None
        return sighting._replace(time=min(sighting.time, report.time))

    def _safety_inputs(self, report: RobotState) -> SafetyInputs:
        state = self._state
        hindrance = self._session.released() or report.hindrance
        report = report._replace(hindrance=hindrance)
        pressed = False
        if report.status is not None:
            pressed = report.status.pressed
        else:
            # There is no button: walking begins when the robot is ready.
            pressed = state is SafetyState.READY and not self._presses
            if self._eyes is not None:
                unseen = getattr(self._eyes, "hindrance", "")
            elif self._sighting_of(report) is None:
                unseen = "no sighting of the opponent"
            else:
                unseen = ""
            report = report._replace(hindrance=hindrance or unseen)
        self._presses = pressed
        return self._vitals.update(
            report,
            self._time,
            walks=state.moves_by_control,
            reached=self._dry_run
            or self._motion.reached(state, report.joint_positions),
            pressed=pressed,
        )

    def _change(self, state: SafetyState) -> None:
        if state is not self._state:
            log.info("%s: %s", state.value, self._safety.reason)
        self._state = state

    def _command(self, targets: Array, stiffness: Array) -> None:
        """Command targets at a share of the gains, or release the joints."""
        session, order = self._session, self._motors.order
        session.check_blocked()
        if not stiffness.any():
            if not session.halted or not self._is_released:
                self._is_released = True
                session.halt()
            return
        gains = self._own
        if self._gains is not None and self._state.moves_by_control:
            gains = self._gains
        rows = np.zeros((3, len(self._robot.joints)))
        rows[:, order] = (
            targets,
            stiffness * gains.stiffness,
            stiffness * gains.damping,
        )
        session.command(partial(self._robot.command, JointTargets(*rows)))

    def _lose(self, reason: str) -> None:
        """Release a robot whose connection has failed."""
        self.fail(reason)
        self._fade()

    def _fade(self) -> None:
        """Ramp the stiffness down, as far as commands can be sent."""
        if self._dry_run or self.report is None:
            return
        while not self._motion.is_limp:
            targets, stiffness = self._motion.fade()
            try:
                self._command(targets, stiffness)
            except SessionLost:
                return
            self._pause(self.tick)
