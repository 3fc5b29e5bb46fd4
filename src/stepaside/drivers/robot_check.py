"""Check of a user's robot: rates, times, units, signs, duration, stopping."""

from collections.abc import Callable, Sequence
from functools import partial
from math import atan2, hypot
from time import monotonic, sleep
from typing import Any, NamedTuple

import numpy as np

from ..core.poses import Array
from ..perception.measurement import RobotState
from ..strategies.velocity_set import BodyVelocity
from .guardian_process import Guardian, halting_method
from .joint_loop import REPORT_SILENCE
from .joint_motion import Motors
from .method_thread import (
    BLOCKED,
    CLOSE_TIMEOUT,
    OPEN_TIMEOUT,
    MethodThread,
    SessionLost,
)
from .robot import JointTargets
from .robot_reports import (
    LEAD,
    in_order,
    joint_fault,
    plain_report,
    pose_fault,
    sighting_fault,
)
from .robot_session import POLL, PREPARE_TIMEOUT
from .velocity_loop import PERIOD
from .watchdog import ODOMETRY_SILENCE, OLDEST

CLOCK_RATIOS = (0.9, 1.1)  # the robot's clock over this computer's
LOW, HIGH = 0.3, 2.0  # measured over commanded motion that is plausible
ANSWER = 2.0  # longest time that a method may take in the check, in [s]
SLOW = 0.1  # duration of a method of velocities that is too long, in [s]
STANDING = 2.0  # duration of the first part, without commands, in [s]
UNATTENDED = 1.5  # without commands, to see what the robot does, in [s]
PASSED, FAILED, UNKNOWN = ("pass", "fail", "unknown")

MOVING = 2.5  # in one direction, in [s]
SETTLED = 1.0  # last part of a motion, over which it is measured, in [s]
SHARE = 0.5  # of the limits that is commanded
FASTEST = BodyVelocity(0.2, 0.2, 0.5)  # that is commanded, in [m/s], [rad/s]
STILL = 0.05  # motion that counts as none, in [m/s] or [rad/s]
STOP_TIMEOUT = 2.0  # in which a robot must stand, in [s]
WINDOW = 0.2  # over which a rate is measured, in [s]

RATE = 0.8  # share of the robot's ticks that must bring a report
HOLDING = 1.0  # of the posture, before joints move, in [s]
AMPLITUDE = 0.1  # of the motion of a joint, in [rad]
RISE, HOLD = 0.4, 0.4  # durations of that motion, in [s]
END = 0.15  # of the hold, over which the angle is measured, in [s]
STAYS = 0.2  # share of the amplitude that counts as no motion
GRAVITY_RANGE = (8.0, 11.5)  # of the accelerometer at rest, in [m/s^2]
TILT_ERROR = 0.2  # between tilt and accelerometer at rest, in [rad]
SWING = 0.02  # rate of the tilt that shows the sign of a gyro, in [rad/s]


class AdapterFinding(NamedTuple):
    """Result of one check."""

    name: str  # what was checked
    verdict: str  # "pass", "fail", or "unknown" without a measurement
    text: str  # the measurement in words, and the remedy
    value: float | None = None  # the measurement, if there is one
    unit: str = ""


class TimedReport(NamedTuple):
    """Report of a robot, and its time of arrival on our clock, in [s]."""

    report: RobotState
    arrived: float


class RobotCheck:
    """Check of a robot, from connecting to disconnecting."""

    def __init__(
        self,
        robot: Any,
        motors: Motors | None,
        note: Callable[[AdapterFinding], None],
        *,
        dry_run: bool = False,
        guardian: Guardian | None = None,
        clock: Callable[[], float] = monotonic,
        pause: Callable[[float], None] = sleep,
    ) -> None:
        """Begin without results; motors are those of a JointRobot."""
        self.findings: list[AdapterFinding] = []
        self._methods = MethodThread(robot, clock=clock)
        self._robot, self._note, self._dry_run = robot, note, dry_run
        self._motors: Any = motors
        self._halting = halting_method(robot)
        self._clock, self._pause = clock, pause
        self._guardian, self._has_moved = guardian, False
        methods = ("listen", "command", self._halting)
        self._longest = dict.fromkeys(methods, 0.0)
        self._swung: list[RobotState] = []  # while joints had targets
        self._lags: list[float] = []  # of joints, in [s]

    @property
    def passes(self) -> bool:
        """Whether no check has failed."""
        return all(each.verdict != FAILED for each in self.findings)

    def run(self) -> None:
        """Run all checks; stop the robot and disconnect, whatever happens."""
        try:
            self._timed("open", OPEN_TIMEOUT)
            try:
                if self._motors is None:
                    self._check_walker()
                else:
                    self._check_joints()
            finally:
                self._leave()
        except SessionLost as error:
            self._add(str(error).partition("()")[0], FAILED, str(error))

    def _leave(self) -> None:
        """Stop the robot, beside a method that does not return; disconnect.

        Joints that were never commanded are left as they are.
        """
        methods, halting = self._methods, self._halting
        halts = self._motors is None or self._has_moved
        if halts and not self._dry_run:
            blocked = methods.blocked is not None
            begin = methods.call_apart if blocked else methods.begin
            try:
                begin(halting).result(CLOSE_TIMEOUT)
            except TimeoutError as error:
                text = f"{methods.name_of(halting)} did not return"
                raise SessionLost(text) from error
        if methods.blocked is None:
            methods.run("close", CLOSE_TIMEOUT)

    def _add(
        self, name: str, verdict: str | bool, text: str, *measured: Any
    ) -> None:
        if not isinstance(verdict, str):  # also a bool of NumPy
            verdict = PASSED if verdict else FAILED
        finding = AdapterFinding(name, verdict, text, *measured)
        self.findings.append(finding)
        self._note(finding)

    def _timed(self, method: str, within: float) -> None:
        """Call a method once, and note how long it takes."""
        began = self._clock()
        self._methods.run(method, within)
        took = self._clock() - began
        self._add(method, PASSED, f"{method}() took {took:.2f} s", took, "s")

    def _call(self, method: str, call: Any = None) -> Any:
        """Call a method that returns soon; the guardian knows of motion."""
        began, moves = self._clock(), method == "command"
        self._has_moved |= moves
        if self._guardian is not None and moves:
            self._guardian.hold()
        result = self._methods.run(method, ANSWER, call)
        if self._guardian is not None and method == self._halting:
            self._guardian.leave()
        took = self._clock() - began
        self._longest[method] = max(self._longest[method], took)
        return result

    def _collect(
        self, duration: float, command: Callable[[float], Any] | None = None
    ) -> list[TimedReport]:
        """Collect new reports, with a command before each."""
        found: list[TimedReport] = []
        name, began = self._methods.name_of("listen"), self._clock()
        while (passed := self._clock() - began) < duration:
            if command is not None:
                self._call("command", command(passed))
            got = self._call("listen")
            now = self._clock()
            report = got and plain_report(got, self._robot, name)
            if not report or found and report.time == found[-1].report.time:
                self._pause(POLL)
                continue
            if self._motors is not None:
                report = in_order(report, self._motors.order)
            found.append(TimedReport(report, now))
            if self._motors is None:
                self._pause(max(PERIOD - (self._clock() - now), 0.0))
            elif command is not None:
                self._pause(0.5 * self._robot.tick)
        silent = not found and self._motors is not None and self._has_moved
        if silent and duration > REPORT_SILENCE:
            raise SessionLost(f"{name} returned no new report")
        return found

    def _check_reports(
        self, reports: Sequence[TimedReport], longest: float
    ) -> bool:
        """Check rate and times; return whether there are enough reports."""
        count = len(reports)
        if count < 2:
            text = f"{count} reports with a new time in {STANDING:g} s; "
            text += f"listen() must return one every {longest:g} s at least"
            self._add("rate", FAILED, text, count / STANDING, "Hz")
            return False
        arrivals = np.array([each.arrived for each in reports])
        stamps = np.array([each.report.time for each in reports])
        gap, passed = float(np.diff(arrivals).max()), np.ptp(arrivals)
        rate = float((count - 1) / passed)
        text = f"{rate:.0f} reports per second, the longest gap {gap:.2f} s"
        if gap > longest:
            text += f"; the robot is stopped after {longest:g} s"
        self._add("rate", gap <= longest, text, rate, "Hz")
        if not np.isfinite(stamps).all():
            self._add("times", FAILED, "the times must be finite")
            return True
        ratio = float((stamps[-1] - stamps[0]) / passed)
        low, high = CLOCK_RATIOS
        good = False
        if back := int((np.diff(stamps) < 0.0).sum()):
            text = f"{back} times are before the last one"
        elif low <= ratio <= high:
            jitter = float(np.ptp(arrivals - stamps))
            good = jitter <= BLOCKED
            text = f"run as time does; latency varies by {jitter:.3f} s"
        else:
            text = f"run {ratio:.3g} times as fast as time: are they in [s]?"
        self._add("times", good, text, ratio, "1")
        return True

    def _check_sighting(self, reports: Sequence[TimedReport]) -> None:
        """Check bearing, distance and age of the sightings."""
        seen = [(r.time, r.sighting) for r, _ in reports if r.sighting]
        if not seen:
            self._add("sighting", UNKNOWN, "no report has a sighting")
            return
        for _, sighting in seen:
            if fault := sighting_fault(sighting):
                self._add("sighting", FAILED, fault)
                return
        age = max(time - sighting.time for time, sighting in seen)
        text = f"in {len(seen)} of {len(reports)} reports, {age:.2f} s old at "
        text += f"most; beyond {OLDEST:g} s it is not used"
        self._add("sighting", -LEAD <= age <= OLDEST, text, age, "s")

    def _check_durations(self, longest: float) -> None:
        """Check how long each method took; at most a time, in [s]."""
        for method, took in self._longest.items():
            if took > 0.0:
                good = took <= longest
                text = f"after {1e3 * took:.0f} ms at most"
                if not good:
                    text += f"; at most {1e3 * longest:.0f} ms"
                self._add(f"{method}() returns", good, text, took, "s")

    def _check_walker(self) -> None:
        standing = self._collect(STANDING)
        if not self._check_reports(standing, ODOMETRY_SILENCE):
            return
        self._check_pose(standing)
        self._check_sighting(standing)
        if not self._dry_run:
            self._timed("prepare", PREPARE_TIMEOUT)
            self._check_directions()
            self._check_stop()
            self._check_unattended_walk()
        self._check_durations(SLOW)

    def _moved(self, duration: float, *velocity: float) -> list[TimedReport]:
        command = partial(self._robot.command, *velocity)
        return self._collect(duration, lambda _: command)

    def _turned(self, duration: float) -> float:
        """Turn left for a time; return the last rate, in [rad/s]."""
        rate = min(SHARE * self._robot.limits.turn, FASTEST.turn)
        return _velocity(self._moved(duration, 0.0, 0.0, rate)[-10:]).turn

    def _check_pose(self, reports: list[TimedReport]) -> None:
        """Check the poses of the standing robot."""
        last = None
        for report, _ in reports:
            if fault := pose_fault(report, last):
                self._add("pose", FAILED, fault)
                return
            last = report
        moved = _velocity(reports)
        drift = hypot(moved.forward, moved.lateral)
        still = drift < STILL and abs(moved.turn) < STILL
        text = f"standing, it drifts by {drift:.3f} m/s and "
        text += f"{moved.turn:+.3f} rad/s"
        self._add("pose", still, text, drift, "m/s")

    def _check_directions(self) -> None:
        """Check sign and size of the motion in each direction."""
        limits = self._robot.limits
        metres = "is the position in millimetres?"
        rows = (
            ("turn left", 2, limits.turn, "is the heading in degrees?"),
            ("walk ahead", 0, limits.forward, metres),
            ("walk back", 0, -limits.backward, metres),
            ("walk left", 1, limits.lateral, metres),
        )
        for name, at, limit, wrong in rows:
            most = FASTEST[at]
            wanted = max(min(SHARE * limit, most), -most)
            if wanted:
                command = [0.0, 0.0, 0.0]
                command[at] = wanted
                reports = self._moved(MOVING, *command)
                self._call("stop")
                end = reports[-1].arrived - SETTLED
                got = _velocity([r for r in reports if r.arrived > end])[at]
                unit = "m/s" if at < 2 else "rad/s"
                text = f"commanded {wanted:+.2f} {unit}, measured {got:+.2f}"
                ratio, verdict = got / wanted, FAILED
                if abs(ratio) < 0.1:
                    verdict = UNKNOWN
                    text += ": does odometry stand still in the air?"
                elif ratio < 0.0:
                    text += ": the sign is wrong, of the command or the pose"
                elif ratio > HIGH:
                    text += f": {wrong}"
                elif ratio < LOW:
                    text += ": the units of the command are wrong"
                else:
                    verdict = PASSED
                self._add(name, verdict, text, got, unit)
                self._collect(SETTLED)

    def _check_stop(self) -> None:
        """Check how long the robot turns on after stop()."""
        before = self._turned(MOVING)
        self._call("stop")
        began = self._clock()
        if abs(before) < STILL:
            self._add("stop", UNKNOWN, "no motion was measured before stop()")
            return
        while self._clock() - began < STOP_TIMEOUT:
            rate = _velocity(self._collect(WINDOW)).turn
            if abs(rate) < 0.2 * abs(before):
                took = self._clock() - began
                text = f"stands {took:.1f} s after stop()"
                self._add("stop", PASSED, text, took, "s")
                return
        text = f"still turns at {rate:+.2f} rad/s {STOP_TIMEOUT:g} s after "
        self._add("stop", FAILED, f"{text}stop()", rate, "rad/s")

    def _check_unattended_walk(self) -> None:
        """Check whether the robot stops when commands cease."""
        before = self._turned(SETTLED)
        self._collect(UNATTENDED)
        after = _velocity(self._collect(0.3)).turn
        self._call("stop")
        keeps, good = self._robot.keeps_walking, True
        if abs(before) < STILL:
            text = "no motion was measured before"
            self._add("without commands", UNKNOWN, text)
            return
        if abs(after) < 0.2 * abs(before):
            text = f"stands after {UNATTENDED:g} s"
            text += "; keeps_walking may be False" if keeps else ""
        else:
            good = keeps
            text = f"turns on after {UNATTENDED:g} s; keeps_walking is {keeps}"
            text += "" if keeps else ", and must be True"
        self._add("without commands", good, text, after, "rad/s")

    def _check_joints(self) -> None:
        still = self._collect(STANDING)
        if not self._check_reports(still, REPORT_SILENCE):
            return
        tick, rate = self._robot.tick, self.findings[-2].value or 0.0
        text = f"{rate:.0f} reports per second for {1.0 / tick:.0f} ticks"
        if not (good := rate * tick >= RATE):
            text += ": one in each tick is needed"
        self._add("tick", good, text, rate, "Hz")
        reports = [each.report for each in still]
        if not self.passes or not self._check_values(reports):
            return  # nothing is commanded by such reports
        self._check_imu(reports)
        self._check_feet(reports[-1])
        self._check_sighting(still)
        begin = reports[-1].joint_positions
        if not self._dry_run and self._check_hold(begin):
            count = len(self._motors.names)
            moved = sum(self._check_joint(at, begin) for at in range(count))
            text, lag = f"{moved} of {count} joints follow their targets", None
            if self._lags:
                lag = float(np.median(self._lags))
                text += f", after {1e3 * lag:.0f} ms"
            self._add("joints", moved == count, text, lag, "s")
            self._check_unattended_joints(begin)
            self._check_gyro()
        if not self._dry_run:
            self._call("release")
        self._check_durations(REPORT_SILENCE)

    def _held(
        self, duration: float, targets: Callable[[float], Array]
    ) -> list[TimedReport]:
        """Collect new reports while joints have targets by the time."""
        motors, robot = self._motors, self._robot

        def command(passed: float) -> Callable[[], None]:
            rows = np.zeros((3, len(robot.joints)))
            rows[:, motors.order] = (
                targets(passed), motors.stiffness, motors.damping
            )  # fmt: skip
            return partial(robot.command, JointTargets(*rows))

        found = self._collect(duration, command)
        self._swung += [report for report, _ in found]
        return found

    def _check_values(self, reports: list[RobotState]) -> bool:
        """Check all values of the robot at rest; return whether they fit."""
        for report in reports:
            if fault := joint_fault(report, self._motors):
                self._add("values", FAILED, fault)
                return False
        rates: Any = [report.joint_velocities for report in reports]
        fastest, count = float(np.abs(rates).max()), len(self._motors.names)
        text = f"{count} joints in their ranges, the fastest "
        text += f"at {fastest:.2f} rad/s"
        self._add("values", True, text, fastest, "rad/s")
        return True

    def _check_imu(self, reports: list[RobotState]) -> None:
        """Compare accelerometer and tilt of the robot at rest."""
        x, y, z = np.mean([r.accelerometer for r in reports], axis=0)
        tilts: Any = [report.tilt for report in reports]
        roll, pitch = np.mean(tilts, axis=0)
        size = hypot(x, y, z)
        low, high = GRAVITY_RANGE
        text = f"({x:.1f}, {y:.1f}, {z:.1f}) m/s^2 at rest"
        if not (known := low <= size <= high):
            text += ": is it in [m/s^2]?"
        elif z < 0.0:
            text += ": an upright robot must read +9.8 along z"
        self._add("accelerometer", known and z >= 0.0, text, size, "m/s^2")
        error = max(
            abs(atan2(y, z) - roll), abs(atan2(-x, hypot(y, z)) - pitch)
        )
        text = f"roll {roll:+.2f}, pitch {pitch:+.2f} rad, {error:.2f} rad "
        text += "from the accelerometer"
        if error > TILT_ERROR:
            text += ": a sign, order or unit is wrong"
        self._add("tilt", error <= TILT_ERROR, text, error, "rad")

    def _check_feet(self, report: RobotState) -> None:
        if np.isnan(report.foot_forces).all():
            text = "not measured; only learned legs walk without them"
            self._add("foot forces", UNKNOWN, text)
            return
        load = float(np.sum(report.foot_forces))
        self._add("foot forces", True, f"{load:.0f} N together", load, "N")

    def _check_hold(self, begin: Array) -> bool:
        """Hold the posture; return whether the robot stays in it.

        Joints in another order, or angles in another unit, leave it at once.
        """
        end, off = self._clock() + HOLDING, np.zeros(len(begin))
        while self._clock() < end and np.abs(off).max() < AMPLITUDE:
            for report, _ in self._held(self._robot.tick, lambda _: begin):
                off = report.joint_positions - begin
        most = int(np.abs(off).argmax())
        away = float(off[most])
        if good := abs(away) < AMPLITUDE:
            text = f"stays within {abs(away):.3f} rad of its posture"
        else:
            text = f"{self._motors.names[most]} moved by {away:+.2f} rad when "
            text += "it was to stay: are joints in another order, targets in "
            text += "another unit, or the gains too low?"
        self._add("hold", good, text, away, "rad")
        return good

    def _check_joint(self, number: int, begin: Array) -> bool:
        """Move a joint and back; return whether it follows."""
        motors = self._motors
        room_above = motors.high[number] - begin[number]
        up = room_above >= begin[number] - motors.low[number]
        size = AMPLITUDE if up else -AMPLITUDE

        def targets(passed: float) -> Array:
            angles = begin.copy()
            angles[number] += size * min(1.0, passed / RISE)
            return angles

        reports = self._held(RISE + HOLD, targets)
        self._held(RISE, lambda t: targets(RISE - t))
        times = np.array([r.report.time for r in reports])
        times -= times[0]
        angles = np.array([r.report.joint_positions for r in reports])
        rates: Any = [r.report.joint_velocities for r in reports]
        turned = float(np.array(rates)[1:, number] @ np.diff(times))
        moved = angles - begin
        whole = float(moved[-1, number] - moved[0, number])
        end = moved[times >= times[-1] - END].mean(axis=0)
        most, own = int(np.abs(end).argmax()), float(end[number] / size)
        text = f"commanded {size:+.2f} rad, moved by {end[number]:+.2f} rad"
        if abs(own) < STAYS and abs(end[most]) > (1.0 - STAYS) * AMPLITUDE:
            text += f", and {motors.names[most]} moved instead"
        elif abs(own) < STAYS:
            text += ": are the gains too low, or the joints not taken?"
        elif own < 0.0:
            text += ": the sign is wrong, of the target or of the angle"
        elif not LOW <= own <= HIGH:
            text += ": is a unit wrong, or a gain too low?"
        elif not LOW <= turned / whole <= HIGH:
            text = f"its velocities add up to {turned:+.2f} rad for a motion "
            text += f"of {whole:+.2f} rad: is a sign or a unit wrong?"
        else:
            passed = (moved[:, number] - 0.5 * size) * size >= 0.0
            self._lags.append(float(times[passed.argmax()]) - 0.5 * RISE)
            return True
        self._add(motors.names[number], FAILED, text)
        return False

    def _check_unattended_joints(self, begin: Array) -> None:
        """Check whether the robot holds its targets when commands cease."""
        keeps, name = self._robot.keeps_targets, "without commands"
        shifted = begin.copy()
        room = np.minimum(begin - self._motors.low, self._motors.high - begin)
        number = int(room.argmax())
        shifted[number] += AMPLITUDE
        before = self._held(RISE + HOLD, lambda _: shifted)[-1].report
        silent = self._collect(UNATTENDED)
        held = before.joint_positions[number]
        if abs(held - begin[number]) < 0.5 * AMPLITUDE:
            text = f"{self._motors.names[number]} did not move before"
            self._add(name, UNKNOWN, text)
            return
        after = silent[-1].report.joint_positions[number]
        change = abs(float(after - held))
        holds = change < STAYS * AMPLITUDE
        text = "holds its targets" if holds else "has left its targets"
        text += f" after {UNATTENDED:g} s"
        if holds and not keeps:
            text += "; keeps_targets is False, and must be True"
        elif keeps and not holds:
            text += "; keeps_targets may be False"
        self._add(name, keeps or not holds, text, change, "rad")

    def _check_gyro(self) -> None:
        """Compare the gyro with the tilt of a robot that has swung."""
        times = np.array([report.time for report in self._swung])
        tilts = np.array([report.tilt for report in self._swung])
        gyros = np.array([report.gyro for report in self._swung])[:, :2]
        steps = np.diff(times)
        known = (steps > 0.0) & (steps < REPORT_SILENCE)
        rates = np.diff(tilts, axis=0)[known] / steps[known, None]
        gyros = 0.5 * (gyros[1:] + gyros[:-1])[known]
        for axis, name in enumerate(("gyro x", "gyro y")):
            swing = float(np.sqrt(np.mean(rates[:, axis] ** 2)))
            if swing < SWING:
                text = f"the torso hardly turned: push it, and see {name}"
                self._add(name, UNKNOWN, text, swing, "rad/s")
                continue
            slope = float(gyros[:, axis] @ rates[:, axis])
            slope /= float(rates[:, axis] @ rates[:, axis])
            good = LOW <= slope <= HIGH
            text = f"{slope:.2f} times the rate of the tilt"
            if not good:
                text += ": is a sign, an axis or a unit wrong?"
            self._add(name, good, text, slope, "1")


def _velocity(reports: list[TimedReport]) -> BodyVelocity:
    """Return the mean velocity in the robot's frame, from its poses."""
    if len(reports) < 2:
        return BodyVelocity(0.0, 0.0, 0.0)
    x, y, theta = np.array([each.report.pose for each in reports]).T
    turns = np.diff(np.unwrap(theta))
    moved = (np.diff(x) + 1j * np.diff(y)) * np.exp(
        -1j * (theta[:-1] + 0.5 * turns)
    )
    ahead, passed = moved.sum(), reports[-1].arrived - reports[0].arrived
    velocity = np.array([ahead.real, ahead.imag, turns.sum()]) / passed
    return BodyVelocity(*velocity.tolist())
