"""Check of a user's joint-driven robot, which hangs in the air."""

from collections.abc import Callable
from functools import partial
from math import atan2, hypot
from typing import Any

import numpy as np

from ..core.poses import Array
from ..perception.measurement import RobotState
from .joint_loop import SILENCE
from .method_check import (
    FAILED,
    RATIOS,
    UNATTENDED,
    UNKNOWN,
    AdapterFinding,
    MethodCheck,
    TimedReport,
)
from .method_thread import SessionLost
from .motors import Motors
from .robot import JointRobot, JointTargets
from .robot_reports import in_order, joint_fault

WATCHING = 2.0  # duration of the first part, without commands, in [s]
RATE = 0.8  # share of the robot's ticks that must bring a report
HOLDING = 1.0  # of the posture, before joints move, in [s]
AMPLITUDE = 0.1  # of the motion of a joint, in [rad]
RISE, HOLD = 0.4, 0.4  # durations of that motion, in [s]
END = 0.15  # of the hold, over which the angle is measured, in [s]
STILL = 0.2  # share of the amplitude that counts as no motion
GRAVITY_RANGE = (8.0, 11.5)  # of the accelerometer at rest, in [m/s^2]
TILT_ERROR = 0.2  # between tilt and accelerometer at rest, in [rad]
SWING = 0.02  # rate of the tilt that shows the sign of a gyro, in [rad/s]


class JointCheck(MethodCheck):
    """Check of a robot that is driven by its joints.

    The robot holds its posture by its own gains, and each joint in turn
    moves by 0.1 rad and back.
    """

    halts_always = False

    def __init__(
        self,
        robot: JointRobot,
        motors: Motors,
        note: Callable[[AdapterFinding], None],
        **options: Any,
    ) -> None:
        """Begin without results; see :class:`MethodCheck`."""
        super().__init__(robot, note, **options)
        self._motors = motors
        self._reports: list[RobotState] = []
        self._lags: list[float] = []

    def _check(self) -> None:
        still = self._watch(WATCHING)
        if not self._check_reports(still, WATCHING, SILENCE):
            return
        self._check_ticks([each.arrived for each in still])
        reports = [each.report for each in still]
        if not self.passes or not self._check_values(reports):
            return  # nothing is commanded by such reports
        self._check_imu(reports)
        self._check_feet(reports[-1])
        self._check_sighting(still)
        if not self._dry_run:
            self._move(reports[-1].joint_positions)
        self._check_durations(SILENCE)

    def _move(self, begin: Array) -> None:
        """Hold the posture, move each joint, and release the robot."""
        if self._check_hold(begin):
            moved = [
                self._check_joint(number, begin)
                for number in range(len(self._motors.names))
            ]
            self._conclude(sum(moved))
            self._check_silence(begin)
            self._check_gyro()
        self._call("release")

    def _check_hold(self, begin: Array) -> bool:
        """Hold the posture; return whether the robot stays in it.

        Joints in another order, or angles in another unit, leave it at once.
        """
        names = self._motors.names
        end = self._clock() + HOLDING
        off = np.zeros(len(self._motors.names))
        while self._clock() < end and np.abs(off).max() < AMPLITUDE:
            for report, _ in self._watch(self._robot.tick, lambda t: begin):
                off = report.joint_positions - begin
        most = int(np.abs(off).argmax())
        away = float(off[most])
        if abs(away) < AMPLITUDE:
            text = f"stays within {abs(away):.3f} rad of its posture"
            self._add("hold", True, text, away, "rad")
            return True
        self._add(
            "hold",
            FAILED,
            f"{names[most]} moved by {away:+.2f} rad when it was to stay: are "
            "joints in another order, targets in another unit, or the gains "
            "too low?",
            away,
            "rad",
        )
        return False

    def _watch(
        self,
        duration: float,
        targets: Callable[[float], Array] | None = None,
    ) -> list[TimedReport]:
        """Collect new reports in the order of the motors.

        Raises:
            SessionLost: If a robot that was commanded falls silent.
        """
        order, command = self._motors.order, None
        if targets is not None:

            def command(passed: float) -> Callable[[], None]:
                return self._command(targets(passed))

        found = [
            TimedReport(in_order(report, order), arrived)
            for report, arrived in self._collect(duration, command)
        ]
        if targets is not None:
            self._reports += [report for report, _ in found]
        if not found and self._has_moved and duration > SILENCE:
            name = self._methods.name_of("listen")
            raise SessionLost(f"{name} returned no new report")
        return found

    def _rest(self, arrived: float, *, commanded: bool) -> float:
        return 0.5 * self._robot.tick if commanded else 0.0

    def _command(self, angles: Array) -> Callable[[], None]:
        motors, robot = self._motors, self._robot
        rows = np.zeros((3, len(robot.joints)))
        rows[:, motors.order] = angles, motors.stiffness, motors.damping
        return partial(robot.command, JointTargets(*rows))

    def _check_ticks(self, arrivals: list[float]) -> None:
        tick = self._robot.tick
        rate = (len(arrivals) - 1) / (arrivals[-1] - arrivals[0])
        text = f"{rate:.0f} reports per second for {1.0 / tick:.0f} ticks"
        good = rate * tick >= RATE
        if not good:
            text += ": one in each tick is needed"
        self._add("tick", good, text, rate, "Hz")

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
        text = f"{load:.0f} N together"
        self._add("foot forces", True, text, load, "N")

    def _check_joint(self, number: int, begin: Array) -> bool:
        """Move a joint and back; return whether it follows."""
        motors, name = self._motors, self._motors.names[number]
        room_above = motors.high[number] - begin[number]
        up = room_above >= begin[number] - motors.low[number]
        size = AMPLITUDE if up else -AMPLITUDE

        def targets(passed: float) -> Array:
            angles = begin.copy()
            angles[number] += size * min(1.0, passed / RISE)
            return angles

        reports = self._watch(RISE + HOLD, targets)
        self._watch(RISE, lambda t: targets(RISE - t))
        times = np.array([r.report.time for r in reports])
        times -= times[0]
        angles = np.array([r.report.joint_positions for r in reports])
        rates: Any = [r.report.joint_velocities for r in reports]
        turned = float(np.array(rates)[1:, number] @ np.diff(times))
        moved = angles - begin
        fault = self._fault_of(times, moved, turned, number, size)
        if fault:
            self._add(name, FAILED, fault)
            return False
        passed = (moved[:, number] - 0.5 * size) * size >= 0.0
        self._lags.append(float(times[passed.argmax()]) - 0.5 * RISE)
        return True

    def _fault_of(
        self,
        times: Array,
        motion: Array,
        turned: float,
        number: int,
        size: float,
    ) -> str:
        """Return why the motion of a joint is wrong; empty if it fits."""
        moved = motion[times >= times[-1] - END].mean(axis=0)
        own = float(moved[number] / size)
        text = f"commanded {size:+.2f} rad, moved by {moved[number]:+.2f} rad"
        most = int(np.abs(moved).argmax())
        if abs(own) < STILL:
            if abs(moved[most]) > (1.0 - STILL) * abs(size):
                return f"{text}, and {self._motors.names[most]} moved instead"
            return f"{text}: are the gains too low, or the joints not taken?"
        if own < 0.0:
            return f"{text}: the sign is wrong, of the target or of the angle"
        low, high = RATIOS
        if not low <= own <= high:
            return f"{text}: is a unit wrong, or a gain too low?"
        whole = float(motion[-1, number] - motion[0, number])
        if not low <= turned / whole <= high:
            return (
                f"its velocities add up to {turned:+.2f} rad for a motion of "
                f"{whole:+.2f} rad: is a sign or a unit wrong?"
            )
        return ""

    def _conclude(self, moved: int) -> None:
        count = len(self._motors.names)
        text = f"{moved} of {count} joints follow their targets"
        lag = None
        if self._lags:
            lag = float(np.median(self._lags))
            text += f", after {1e3 * lag:.0f} ms"
        self._add("joints", moved == count, text, lag, "s")

    def _check_silence(self, begin: Array) -> None:
        """Check whether the robot holds its targets when commands cease."""
        robot, name = self._robot, "without commands"
        shifted = begin.copy()
        room = np.minimum(begin - self._motors.low, self._motors.high - begin)
        number = int(room.argmax())
        shifted[number] += AMPLITUDE
        self._watch(RISE + HOLD, lambda t: shifted)
        joint = self._motors.names[number]
        before = self._watch(END, lambda t: shifted)[-1].report
        after = self._watch(UNATTENDED)[-1].report
        held = before.joint_positions[number]
        if abs(held - begin[number]) < 0.5 * AMPLITUDE:
            self._add(name, UNKNOWN, f"{joint} did not move before")
            return
        change = abs(float(after.joint_positions[number] - held))
        holds = change < STILL * AMPLITUDE
        if holds and not robot.keeps_targets:
            text = f"holds its targets after {UNATTENDED:g} s; keeps_targets "
            self._add(name, FAILED, f"{text}is False, and must be True")
            return
        text = "holds its targets" if holds else "has left its targets"
        hint = ""
        if not holds and robot.keeps_targets:
            hint = "; keeps_targets may be False"
        self._add(
            name, True, f"{text} after {UNATTENDED:g} s{hint}", change, "rad"
        )

    def _check_gyro(self) -> None:
        """Compare the gyro with the tilt of a robot that has swung."""
        times = np.array([report.time for report in self._reports])
        tilts = np.array([report.tilt for report in self._reports])
        gyros = np.array([report.gyro for report in self._reports])[:, :2]
        steps = np.diff(times)
        known = (steps > 0.0) & (steps < SILENCE)
        rates = np.diff(tilts, axis=0)[known] / steps[known, None]
        gyros = 0.5 * (gyros[1:] + gyros[:-1])[known]
        for axis, name in enumerate(("x", "y")):
            swing = float(np.sqrt(np.mean(rates[:, axis] ** 2)))
            if swing < SWING:
                text = f"the torso hardly turned: push it, and see gyro {name}"
                self._add(f"gyro {name}", UNKNOWN, text, swing, "rad/s")
                continue
            slope = float(gyros[:, axis] @ rates[:, axis])
            slope /= float(rates[:, axis] @ rates[:, axis])
            low, high = RATIOS
            good = low <= slope <= high
            text = f"{slope:.2f} times the rate of the tilt"
            if not good:
                text += ": is a sign, an axis or a unit wrong?"
            self._add(f"gyro {name}", good, text, slope, "1")
