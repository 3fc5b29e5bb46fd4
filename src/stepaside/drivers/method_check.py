"""Check of the methods of a user's robot: rates, times, duration, stopping."""

from collections.abc import Callable, Sequence
from math import isfinite
from time import monotonic, sleep
from typing import Any, ClassVar, NamedTuple

from ..perception.measurement import RobotState
from .guardian_process import Guardian, halting_method
from .method_thread import (
    BLOCKED,
    CLOSE_TIMEOUT,
    OPEN_TIMEOUT,
    MethodThread,
    SessionLost,
)
from .robot_reports import LEAD, plain_report, sighting_fault
from .robot_session import POLL
from .watchdog import OLDEST

CLOCK_RATIOS = (0.9, 1.1)  # the robot's clock over this computer's
RATIOS = (0.3, 2.0)  # measured over commanded motion that is plausible
ANSWER = 2.0  # longest time that a method may take in the check, in [s]
UNATTENDED = 1.5  # without commands, to see what the robot does, in [s]
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
    """Report of a robot, and its time of arrival on our clock, in [s]."""

    report: RobotState
    arrived: float


class MethodCheck:
    """Check of a robot, from connecting to disconnecting.

    Attributes:
        findings: Results so far.
        halts_always: Whether the robot is halted at the end although it was
            not commanded.
    """

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
        """Begin without results."""
        self.findings: list[AdapterFinding] = []
        self._methods = MethodThread(robot, clock=clock)
        self._robot, self._note, self._dry_run = robot, note, dry_run
        self._halting = halting_method(robot)
        self._clock, self._pause = clock, pause
        self._guardian, self._moves = guardian, False
        self._has_moved = False
        methods = ("listen", "command", self._halting)
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
        verdict: str | bool,
        text: str,
        value: float | None = None,
        unit: str = "",
    ) -> None:
        if not isinstance(verdict, str):  # also a bool of NumPy
            verdict = PASSED if verdict else FAILED
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
            found.append(TimedReport(report, now))
            self._pause(self._rest(now, commanded=command is not None))
        return found

    def _rest(self, arrived: float, *, commanded: bool) -> float:
        """Return how long to wait after a report, in [s]."""
        raise NotImplementedError

    def _leave(self) -> None:
        """Stop the robot, beside a method that does not return; disconnect.

        Raises:
            SessionLost: If it could not be stopped.
        """
        methods, halting = self._methods, self._halting
        if not self._dry_run and (self.halts_always or self._has_moved):
            if methods.blocked is None:
                methods.run(halting, CLOSE_TIMEOUT)
            else:
                try:
                    methods.call_apart(halting).result(CLOSE_TIMEOUT)
                except TimeoutError as error:
                    name = methods.name_of(halting)
                    raise SessionLost(
                        f"{name} did not return either"
                    ) from error
        if methods.blocked is None:
            methods.run("close", CLOSE_TIMEOUT)

    def _check_reports(
        self, reports: Sequence[TimedReport], over: float, longest: float
    ) -> bool:
        """Check how often there is a new report, and their times."""
        count = len(reports)
        if count < 2:
            self._add(
                "rate",
                FAILED,
                f"{count} reports with a new time in {over:g} s; listen() "
                f"must return one every {longest:g} s at least",
                count / over,
                "Hz",
            )
            return False
        arrivals = [each.arrived for each in reports]
        pairs = zip(arrivals, arrivals[1:], strict=False)
        gap = max(b - a for a, b in pairs)
        rate = (count - 1) / (arrivals[-1] - arrivals[0])
        text = f"{rate:.0f} reports per second, the longest gap {gap:.2f} s"
        if gap > longest:
            text += f"; the robot is stopped after {longest:g} s"
        self._add("rate", gap <= longest, text, rate, "Hz")
        self._check_clock([r.time for r, _ in reports], arrivals)
        return True

    def _check_clock(
        self, stamps: Sequence[float], arrivals: Sequence[float]
    ) -> None:
        """Check that the times of reports run as time does, all in [s]."""
        back = sum(b < a for a, b in zip(stamps, stamps[1:], strict=False))
        passed = arrivals[-1] - arrivals[0]
        if not all(isfinite(stamp) for stamp in stamps) or passed <= 0.0:
            self._add("times", FAILED, "the times must be finite")
            return
        ratio = (stamps[-1] - stamps[0]) / passed
        low, high = CLOCK_RATIOS
        good = False
        if back:
            text = f"{back} times are before the last one"
        elif low <= ratio <= high:
            pairs = zip(stamps, arrivals, strict=True)
            delays = [arrived - stamp for stamp, arrived in pairs]
            jitter = max(delays) - min(delays)
            good = jitter <= BLOCKED
            text = f"run as time does; latency varies by {jitter:.3f} s"
        else:
            text = f"run {ratio:.3g} times as fast as time: are they in [s]?"
        self._add("times", good, text, ratio, "1")

    def _check_sighting(self, reports: Sequence[TimedReport]) -> None:
        """Check bearing, distance and age of the sightings."""
        age, count = 0.0, 0
        for report, _ in reports:
            if (sighting := report.sighting) is None:
                continue
            count += 1
            if fault := sighting_fault(sighting):
                self._add("sighting", FAILED, fault)
                return
            age = max(age, report.time - sighting.time)
        if not count:
            self._add("sighting", UNKNOWN, "no report has a sighting")
            return
        self._add(
            "sighting",
            -LEAD <= age <= OLDEST,
            f"in {count} of {len(reports)} reports, {age:.2f} s old at "
            f"most; beyond {OLDEST:g} s it is not used",
            age,
            "s",
        )

    def _check_durations(self, longest: float) -> None:
        """Check how long each method took; at most a time, in [s]."""
        for method, took in self._longest.items():
            if took > 0.0:
                good = took <= longest
                text = f"after {1e3 * took:.0f} ms at most"
                if not good:
                    text += f"; at most {1e3 * longest:.0f} ms"
                self._add(f"{method}() returns", good, text, took, "s")
