"""Check of a user's robot: rates, latency, units, signs and stopping.

The robot is to hang in the air, or to have room for a few steps.
"""

from functools import partial
from math import cos, hypot, sin
from typing import NamedTuple

from ..core.poses import wrap_angle
from ..strategies.velocity_set import BodyVelocity
from .method_check import (
    FAILED,
    PASSED,
    RATIOS,
    UNATTENDED,
    UNKNOWN,
    MethodCheck,
    TimedReport,
)
from .robot_reports import pose_fault
from .robot_session import PREPARE_TIMEOUT
from .velocity_loop import PERIOD
from .watchdog import SILENCE

STANDING, MOVING = 2.0, 2.5  # durations of the parts, in [s]
SETTLED = 1.0  # last part of a motion, over which it is measured, in [s]
SHARE = 0.5  # of the limits that is commanded
FASTEST = BodyVelocity(0.2, 0.2, 0.5)  # that is commanded, in [m/s], [rad/s]
STILL = 0.05  # motion that counts as none, in [m/s] or [rad/s]
SLOW = 0.1  # duration of a method that is too long, in [s]
STOP_TIMEOUT = 2.0  # in which a robot must stand, in [s]
WINDOW = 0.2  # over which a rate is measured, in [s]


class Axis(NamedTuple):
    """Direction of motion that is checked.

    Attributes:
        name: Its name.
        command: Commanded velocity.
        unit: Unit of the velocity.
        wrong: Likely cause of a velocity that is much too large.
    """

    name: str
    command: BodyVelocity
    unit: str
    wrong: str


class VelocityCheck(MethodCheck):
    """Check of a robot that is driven by velocities."""

    def _check(self) -> None:
        standing = self._collect(STANDING)
        if not self._check_reports(standing, STANDING, SILENCE):
            return
        self._check_pose(standing)
        self._check_sighting(standing)
        if not self._dry_run:
            self._timed("prepare", PREPARE_TIMEOUT)
            for axis in self._axes():
                self._check_axis(axis)
            self._check_stop()
            self._check_silence()
        self._check_durations(SLOW)

    def _rest(self, arrived: float, *, commanded: bool) -> float:
        return max(PERIOD - (self._clock() - arrived), 0.0)

    def _moved(
        self, duration: float, velocity: BodyVelocity
    ) -> list[TimedReport]:
        """Walk at a velocity for a time, in [s]."""
        command = partial(self._robot.command, *velocity)
        return self._collect(duration, lambda _: command)

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
        self._add(
            "pose",
            still,
            f"standing, it drifts by {drift:.3f} m/s and "
            f"{moved.turn:+.3f} rad/s",
            drift,
            "m/s",
        )

    def _axes(self) -> list[Axis]:
        """Return the directions of motion that the robot has."""
        limits = self._robot.limits
        turn = min(SHARE * limits.turn, FASTEST.turn)
        ahead = min(SHARE * limits.forward, FASTEST.forward)
        back = min(SHARE * limits.backward, FASTEST.forward)
        aside = min(SHARE * limits.lateral, FASTEST.lateral)
        metres = "is the position in millimetres?"
        axes = [
            Axis("turn left", BodyVelocity(0.0, 0.0, turn), "rad/s",
                 "is the heading in degrees?"),
            Axis("walk ahead", BodyVelocity(ahead, 0.0, 0.0), "m/s", metres),
            Axis("walk back", BodyVelocity(-back, 0.0, 0.0), "m/s", metres),
        ]  # fmt: skip
        if aside > 0.0:
            left = BodyVelocity(0.0, aside, 0.0)
            axes.append(Axis("walk left", left, "m/s", metres))
        return axes

    def _check_axis(self, axis: Axis) -> None:
        """Check sign and size of the motion in one direction."""
        reports = self._moved(MOVING, axis.command)
        self._call("stop")
        wanted = next(value for value in axis.command if value)
        at = axis.command.index(wanted)
        late = [
            r for r in reports if r.arrived > reports[-1].arrived - SETTLED
        ]
        got = _velocity(late)[at]
        low, high = RATIOS
        text = f"commanded {wanted:+.2f} {axis.unit}, measured {got:+.2f}"
        ratio = got / wanted
        if abs(got) < 0.1 * abs(wanted):
            verdict = UNKNOWN
            text += ": does odometry stand still while the robot hangs?"
        elif ratio < 0.0:
            verdict = FAILED
            text += ": the sign is wrong, of the command or of the pose"
        elif ratio > high:
            verdict = FAILED
            text += f": {axis.wrong}"
        elif ratio < low:
            verdict = FAILED
            text += ": the units of the command, or its share, are wrong"
        else:
            verdict = PASSED
        self._add(axis.name, verdict, text, got, axis.unit)
        self._collect(SETTLED)

    def _check_stop(self) -> None:
        """Check how long the robot turns on after stop()."""
        turn = self._axes()[0].command
        before = _velocity(self._moved(MOVING, turn)[-10:]).turn
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
        self._add(
            "stop",
            FAILED,
            f"still turns at {rate:+.2f} rad/s {STOP_TIMEOUT:g} s after "
            "stop()",
            rate,
            "rad/s",
        )

    def _check_silence(self) -> None:
        """Check whether the robot stops when commands cease."""
        turn = self._axes()[0].command
        before = _velocity(self._moved(SETTLED, turn)[-10:]).turn
        self._collect(UNATTENDED)
        after = _velocity(self._collect(0.3)).turn
        self._call("stop")
        keeps = self._robot.keeps_walking
        name = "without commands"
        if abs(before) < STILL:
            self._add(name, UNKNOWN, "no motion was measured before")
        elif abs(after) < 0.2 * abs(before):
            hint = "; keeps_walking may be False" if keeps else ""
            text = f"stands after {UNATTENDED:g} s{hint}"
            self._add(name, PASSED, text, after, "rad/s")
        else:
            self._add(
                name,
                PASSED if keeps else FAILED,
                f"turns on after {UNATTENDED:g} s; keeps_walking is {keeps}"
                + ("" if keeps else ", and must be True"),
                after,
                "rad/s",
            )


def _velocity(reports: list[TimedReport]) -> BodyVelocity:
    """Return the mean velocity in the robot's frame, from its poses."""
    if len(reports) < 2:
        return BodyVelocity(0.0, 0.0, 0.0)
    ahead = left = turned = 0.0
    for (a, _), (b, _) in zip(reports, reports[1:], strict=False):
        turn = wrap_angle(b.pose.theta - a.pose.theta)
        heading = a.pose.theta + 0.5 * turn
        dx, dy = b.pose.x - a.pose.x, b.pose.y - a.pose.y
        ahead += cos(heading) * dx + sin(heading) * dy
        left += cos(heading) * dy - sin(heading) * dx
        turned += turn
    passed = reports[-1].arrived - reports[0].arrived
    return BodyVelocity(ahead / passed, left / passed, turned / passed)
