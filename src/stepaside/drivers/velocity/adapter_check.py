"""Check of a user's robot: rates, latency, units, signs and stopping.

The robot is to hang in the air, or to have room for a few steps.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import cos, hypot, isfinite, sin
from time import monotonic, sleep
from typing import Any, NamedTuple

from ...core.poses import wrap_angle
from ...strategies.velocity_set import BodyVelocity
from ..guardian_process import Guardian, SessionLost
from ..method_thread import (
    BLOCKED,
    CLOSE_TIMEOUT,
    OPEN_TIMEOUT,
    MethodThread,
)
from ..sighting_checks import sighting_fault
from .adapter_body import (
    PERIOD,
    POLL,
    PREPARE_TIMEOUT,
    converted_report,
    report_fault,
)
from .velocity_body import VelocityReport
from .velocity_robot import VelocityRobot
from .watchdog import WatchSettings

STANDING, MOVING = 2.0, 2.5  # durations of the parts, in [s]
SETTLED = 1.0  # last part of a motion, over which it is measured, in [s]
SHARE = 0.5  # of the limits that is commanded
FASTEST = BodyVelocity(0.2, 0.2, 0.5)  # that is commanded, in [m/s], [rad/s]
STILL = 0.05  # motion that counts as none, in [m/s] or [rad/s]
RATIOS = (0.3, 2.0)  # measured over commanded velocity that is plausible
CLOCK_RATIOS = (0.9, 1.1)  # the robot's clock over this computer's
SLOW = 0.1  # duration of a method that is too long, in [s]
STOP_TIMEOUT = 2.0  # in which a robot must stand, in [s]
UNATTENDED = 1.5  # without commands, to see whether the robot stops, in [s]
ANSWER = 2.0  # longest time that a method may take in the check, in [s]
PASSED, FAILED, UNKNOWN = ("pass", "fail", "unknown")


class AdapterFinding(NamedTuple):
    """Result of one check.

    Attributes:
        name: What was checked.
        verdict: "pass", "fail" or "unknown"; unknown without a measurement.
        text: The measurement in words, and the remedy.
        value: The measurement; None without one.
        unit: Its unit.
    """

    name: str
    verdict: str
    text: str
    value: float | None = None
    unit: str = ""


class TimedReport(NamedTuple):
    """Report of a robot with its time of arrival.

    Attributes:
        report: The report.
        arrived: Time of arrival on this computer's clock, in [s].
    """

    report: VelocityReport
    arrived: float


@dataclass(frozen=True, slots=True)
class Axis:
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


class AdapterCheck:
    """Check of a robot, from connecting to disconnecting.

    Attributes:
        findings: Results so far.
    """

    def __init__(
        self,
        robot: VelocityRobot,
        note: Callable[[AdapterFinding], None],
        *,
        dry_run: bool = False,
        guardian: Guardian | None = None,
        clock: Callable[[], float] = monotonic,
        pause: Callable[[float], None] = sleep,
    ) -> None:
        """Begin without results.

        Args:
            robot: The robot, not connected.
            note: Function called with each result.
            dry_run: Whether nothing is commanded.
            guardian: Guardian that stops the robot if the check dies.
            clock: Time of this computer, in [s].
            pause: Function that waits for a time, in [s].
        """
        self._pause = pause
        self._methods = MethodThread(robot, clock=clock)
        self._note, self._dry_run, self._clock = note, dry_run, clock
        self._guardian, self._moves = guardian, False
        self.findings: list[AdapterFinding] = []
        self._longest = {"listen": 0.0, "command": 0.0, "stop": 0.0}

    @property
    def passes(self) -> bool:
        """Whether no check has failed."""
        return all(each.verdict != FAILED for each in self.findings)

    def run(self) -> None:
        """Run all checks; stop the robot and disconnect, whatever happens."""
        try:
            self._timed("open", OPEN_TIMEOUT)
            try:
                self._check()
            finally:
                self._leave()
        except SessionLost as error:
            self._add(str(error).partition("()")[0], FAILED, str(error))

    def _check(self) -> None:
        standing = self._listen(STANDING)
        self._check_rate(standing)
        if not standing:
            return
        self._check_clock(standing)
        self._check_pose(standing)
        self._check_sighting(standing)
        if not self._dry_run:
            self._timed("prepare", PREPARE_TIMEOUT)
            for axis in self._axes():
                self._check_axis(axis)
            self._check_stop()
            self._check_silence()
        for method, longest in self._longest.items():
            if longest > 0.0:
                self._add(
                    f"{method}() returns",
                    PASSED if longest <= SLOW else FAILED,
                    f"after {1e3 * longest:.0f} ms at most"
                    + (f"; at most {1e3 * SLOW:.0f} ms" * (longest > SLOW)),
                    longest,
                    "s",
                )

    def _add(
        self,
        name: str,
        verdict: str,
        text: str,
        value: float | None = None,
        unit: str = "",
    ) -> None:
        finding = AdapterFinding(name, verdict, text, value, unit)
        self.findings.append(finding)
        self._note(finding)

    def _timed(self, method: str, within: float) -> None:
        """Call a method once, and note how long it takes."""
        began = self._clock()
        self._methods.run(method, within)
        took = self._clock() - began
        self._add(method, PASSED, f"{method}() took {took:.2f} s", took, "s")

    def _call(self, method: str, call: Any = None) -> Any:
        """Call a method that returns soon."""
        began = self._clock()
        if method != "listen":
            self._moves = method == "command"
        if self._guardian is not None and self._moves:
            self._guardian.hold()
        result = self._methods.run(method, ANSWER, call)
        if self._guardian is not None and not self._moves:
            self._guardian.leave()
        took = self._clock() - began
        self._longest[method] = max(self._longest[method], took)
        return result

    def _leave(self) -> None:
        """Stop the robot, beside a method that does not return; disconnect.

        Raises:
            SessionLost: If it could not be stopped.
        """
        if not self._dry_run:
            if self._methods.blocked is None:
                self._methods.run("stop", CLOSE_TIMEOUT)
            else:
                self._stop_beside()
        if self._methods.blocked is None:
            self._methods.run("close", CLOSE_TIMEOUT)

    def _stop_beside(self) -> None:
        try:
            self._methods.call_apart("stop").result(CLOSE_TIMEOUT)
        except TimeoutError as error:
            raise SessionLost(
                f"{self._methods.name_of('stop')} did not return either"
            ) from error

    def _listen(
        self, duration: float, command: BodyVelocity | None = None
    ) -> list[TimedReport]:
        """Collect new reports, with a command after each, as ``play`` does."""
        reports: list[TimedReport] = []
        end = self._clock() + duration
        name = self._methods.name_of("listen")
        robot = self._methods.robot
        while self._clock() < end:
            if command is not None:
                self._call("command", lambda: robot.command(*command))
            got = self._call("listen")
            now = self._clock()
            if got is None:
                self._pause(POLL)
                continue
            report = converted_report(got, name)
            if reports and report.time == reports[-1].report.time:
                self._pause(POLL)
                continue
            reports.append(TimedReport(report, now))
            self._pause(max(PERIOD - (self._clock() - now), 0.0))
        return reports

    def _check_rate(self, reports: list[TimedReport]) -> None:
        silence = WatchSettings().silence
        if len(reports) < 2:
            self._add(
                "rate",
                FAILED,
                f"{len(reports)} reports with a new time in {STANDING:g} s; "
                f"listen() must return one every {silence:g} s at least",
                float(len(reports)) / STANDING,
                "Hz",
            )
            return
        times = [each.arrived for each in reports]
        gap = max(b - a for a, b in zip(times, times[1:], strict=False))
        rate = (len(times) - 1) / (times[-1] - times[0])
        text = f"{rate:.0f} reports per second, the longest gap {gap:.2f} s"
        if gap > silence:
            text += f"; the robot is stopped after {silence:g} s"
        verdict = PASSED if gap <= silence else FAILED
        self._add("rate", verdict, text, rate, "Hz")

    def _check_clock(self, reports: list[TimedReport]) -> None:
        """Check that the times of the reports run as time does."""
        stamps = [each.report.time for each in reports]
        back = sum(b < a for a, b in zip(stamps, stamps[1:], strict=False))
        passed = reports[-1].arrived - reports[0].arrived
        if not all(isfinite(stamp) for stamp in stamps) or passed <= 0.0:
            self._add("times", FAILED, "the times must be finite")
            return
        ratio = (stamps[-1] - stamps[0]) / passed
        low, high = CLOCK_RATIOS
        if back:
            verdict, text = FAILED, f"{back} times are before the last one"
        elif low <= ratio <= high:
            delays = [each.arrived - each.report.time for each in reports]
            jitter = max(delays) - min(delays)
            verdict = PASSED if jitter <= BLOCKED else FAILED
            text = f"run as time does; latency varies by {jitter:.3f} s"
        else:
            verdict = FAILED
            text = f"run {ratio:.3g} times as fast as time: are they in [s]?"
        self._add("times", verdict, text, ratio, "1")

    def _check_pose(self, reports: list[TimedReport]) -> None:
        """Check the poses of the standing robot."""
        last = None
        for report, _ in reports:
            if fault := report_fault(report, last):
                self._add("pose", FAILED, fault)
                return
            last = report
        moved = _velocity(reports)
        drift = hypot(moved.forward, moved.lateral)
        still = drift < STILL and abs(moved.turn) < STILL
        self._add(
            "pose",
            PASSED if still else FAILED,
            f"standing, it drifts by {drift:.3f} m/s and "
            f"{moved.turn:+.3f} rad/s",
            drift,
            "m/s",
        )

    def _check_sighting(self, reports: list[TimedReport]) -> None:
        seen = [r.report for r in reports if r.report.sighting is not None]
        if not seen:
            self._add("sighting", UNKNOWN, "no report has a sighting")
            return
        age = 0.0
        for report in seen:
            assert report.sighting is not None
            time, bearing, distance = report.sighting[:3]
            if fault := sighting_fault(bearing, distance):
                self._add("sighting", FAILED, fault)
                return
            age = max(age, report.time - time)
        watch = WatchSettings()
        fits = -watch.lead <= age <= watch.oldest
        self._add(
            "sighting",
            PASSED if fits else FAILED,
            f"in {len(seen)} of {len(reports)} reports, {age:.2f} s old at "
            f"most; beyond {watch.oldest:g} s it is not used",
            age,
            "s",
        )

    def _axes(self) -> list[Axis]:
        """Return the directions of motion that the robot has."""
        limits = self._methods.robot.limits
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
        reports = self._listen(MOVING, axis.command)
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
        self._listen(SETTLED)

    def _check_stop(self) -> None:
        """Check how long the robot turns on after stop()."""
        turn = self._axes()[0].command
        before = _velocity(self._listen(MOVING, turn)[-10:]).turn
        self._call("stop")
        began = self._clock()
        if abs(before) < STILL:
            self._add("stop", UNKNOWN, "no motion was measured before stop()")
            return
        window = 0.2  # over which a rate is measured, in [s]
        while self._clock() - began < STOP_TIMEOUT:
            rate = _velocity(self._listen(window)).turn
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
        before = _velocity(self._listen(SETTLED, turn)[-10:]).turn
        self._listen(UNATTENDED)
        after = _velocity(self._listen(0.3)).turn
        self._call("stop")
        keeps = self._methods.robot.keeps_walking
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
