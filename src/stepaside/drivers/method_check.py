"""Check of the methods of a user's robot: rates, times, duration, stopping."""

from collections.abc import Callable, Sequence
from math import isfinite
from time import monotonic, sleep
from typing import Any, ClassVar, NamedTuple

from ..perception.measurement import RobotState
from .guardian_process import Guardian, SessionLost
from .method_thread import (
    BLOCKED,
    CLOSE_TIMEOUT,
    OPEN_TIMEOUT,
    MethodThread,
)
from .sighting_checks import sighting_fault

CLOCK_RATIOS = (0.9, 1.1)  # the robot's clock over this computer's
LEAD = 0.1  # by which a sighting may be ahead of its report, in [s]
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

    report: RobotState
    arrived: float


class MethodCheck:
    """Check of a robot, from connecting to disconnecting.

    Attributes:
        findings: Results so far.
        halting: Method that stops or releases the robot.
        halts_always: Whether it is called at the end if the robot was not
            commanded.
    """

    halting: ClassVar[str]
    halts_always: ClassVar[bool] = True

    def __init__(
        self,
        robot: Any,
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
        self.findings: list[AdapterFinding] = []
        self._methods = MethodThread(robot, clock=clock)
        self._note, self._dry_run = note, dry_run
        self._clock, self._pause = clock, pause
        self._guardian, self._moves = guardian, False
        self._has_moved = False
        methods = ("listen", "command", self.halting)
        self._longest = dict.fromkeys(methods, 0.0)

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
        """Run the checks of a connected robot."""
        raise NotImplementedError

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
            self._has_moved |= self._moves
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
        if not self._dry_run and (self.halts_always or self._has_moved):
            if self._methods.blocked is None:
                self._methods.run(self.halting, CLOSE_TIMEOUT)
            else:
                self._stop_beside()
        if self._methods.blocked is None:
            self._methods.run("close", CLOSE_TIMEOUT)

    def _stop_beside(self) -> None:
        try:
            self._methods.call_apart(self.halting).result(CLOSE_TIMEOUT)
        except TimeoutError as error:
            raise SessionLost(
                f"{self._methods.name_of(self.halting)} did not return either"
            ) from error

    def _check_rate(
        self, arrivals: Sequence[float], over: float, longest: float
    ) -> None:
        """Check how often there is a new report.

        Args:
            arrivals: Times of arrival, in [s].
            over: Duration in which they came, in [s].
            longest: Longest gap between two, in [s].
        """
        if len(arrivals) < 2:
            self._add(
                "rate",
                FAILED,
                f"{len(arrivals)} reports with a new time in {over:g} s; "
                f"listen() must return one every {longest:g} s at least",
                float(len(arrivals)) / over,
                "Hz",
            )
            return
        pairs = zip(arrivals, arrivals[1:], strict=False)
        gap = max(b - a for a, b in pairs)
        rate = (len(arrivals) - 1) / (arrivals[-1] - arrivals[0])
        text = f"{rate:.0f} reports per second, the longest gap {gap:.2f} s"
        if gap > longest:
            text += f"; the robot is stopped after {longest:g} s"
        verdict = PASSED if gap <= longest else FAILED
        self._add("rate", verdict, text, rate, "Hz")

    def _check_clock(
        self, stamps: Sequence[float], arrivals: Sequence[float]
    ) -> None:
        """Check that the times of the reports run as time does.

        Args:
            stamps: Times of the reports, in [s].
            arrivals: Times of their arrivals, in [s].
        """
        back = sum(b < a for a, b in zip(stamps, stamps[1:], strict=False))
        passed = arrivals[-1] - arrivals[0]
        if not all(isfinite(stamp) for stamp in stamps) or passed <= 0.0:
            self._add("times", FAILED, "the times must be finite")
            return
        ratio = (stamps[-1] - stamps[0]) / passed
        low, high = CLOCK_RATIOS
        if back:
            verdict, text = FAILED, f"{back} times are before the last one"
        elif low <= ratio <= high:
            pairs = zip(stamps, arrivals, strict=True)
            delays = [arrived - stamp for stamp, arrived in pairs]
            jitter = max(delays) - min(delays)
            verdict = PASSED if jitter <= BLOCKED else FAILED
            text = f"run as time does; latency varies by {jitter:.3f} s"
        else:
            verdict = FAILED
            text = f"run {ratio:.3g} times as fast as time: are they in [s]?"
        self._add("times", verdict, text, ratio, "1")

    def _check_sighting(
        self, reports: Sequence[RobotState], oldest: float
    ) -> None:
        """Check bearing, distance and age of the sightings.

        Args:
            reports: Reports of the robot.
            oldest: Age beyond which a sighting is not used, in [s].
        """
        age, count = 0.0, 0
        for report in reports:
            if (sighting := report.sighting) is None:
                continue
            count += 1
            time, bearing, distance = sighting[:3]
            if fault := sighting_fault(bearing, distance):
                self._add("sighting", FAILED, fault)
                return
            age = max(age, report.time - time)
        if not count:
            self._add("sighting", UNKNOWN, "no report has a sighting")
            return
        self._add(
            "sighting",
            PASSED if -LEAD <= age <= oldest else FAILED,
            f"in {count} of {len(reports)} reports, {age:.2f} s old at "
            f"most; beyond {oldest:g} s it is not used",
            age,
            "s",
        )

    def _check_durations(self, longest: float) -> None:
        """Check how long each method took.

        Args:
            longest: Time that a method may take, in [s].
        """
        for method, took in self._longest.items():
            if took > 0.0:
                slow = f"; at most {1e3 * longest:.0f} ms"
                self._add(
                    f"{method}() returns",
                    PASSED if took <= longest else FAILED,
                    f"after {1e3 * took:.0f} ms at most"
                    + (slow if took > longest else ""),
                    took,
                    "s",
                )
