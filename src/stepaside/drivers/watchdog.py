"""Watchdog of the reports of a robot that follows velocity commands."""

from dataclasses import dataclass
from math import hypot, isfinite, pi

from ..core.errors import ConfigurationError, check_within
from ..core.poses import wrap_angle
from ..perception.measurement import RobotState, Sighting
from .sighting_checks import sighting_fault

LEAD = 0.1  # by which the stamps may run ahead of this computer's clock, [s]
DRIFT = 0.02  # relative difference of two clocks' rates at most
FASTEST = 10.0  # plausible speed of a walking robot, in [m/s]
FASTEST_TURN = 15.0  # plausible turning rate, in [rad/s]
MIN_PASSED = 0.02  # over which a jump is judged at least, in [s]


@dataclass(frozen=True, slots=True)
class WatchSettings:
    """Thresholds at which a robot must stand.

    Attributes:
        silence: Maximum time without odometry, in [s].
        oldest: Maximum age of the newest sighting, in [s].
        lead: Maximum time by which stamps may run ahead of this computer's
            clock, and sightings ahead of the odometry, in [s].
        warm_up: Consecutive valid reports before the robot may move.
        paced: Whether the robot's clock runs in real time; that of a
            simulator may pause or run faster.
        forsaken: Time without odometry after which the session ends, in
            [s].
        source: What the reports are, for messages.
    """

    silence: float = 0.25
    oldest: float = 0.5
    lead: float = LEAD
    warm_up: int = 3
    paced: bool = True
    forsaken: float = 10.0
    source: str = "odometry"

    def __post_init__(self) -> None:
        """Validate the thresholds."""
        error = ConfigurationError
        check_within(self.silence, 0.01, 60.0, "silence", "s", error)
        check_within(self.oldest, 0.01, 60.0, "oldest", "s", error)
        check_within(self.lead, 0.0, 10.0, "lead", "s", error)
        check_within(self.forsaken, 0.1, 3600.0, "forsaken", "s", error)
        check_within(self.warm_up, 1, 1000, "warm_up", "reports", error)


class LeadMeter:
    """Time by which the clock of a robot runs ahead of this computer's.

    The clocks may have different zeros, so only differences are compared.
    """

    def __init__(self, longest: float = LEAD) -> None:
        """Start before the first report.

        Args:
            longest: Lead that is a fault, in [s].
        """
        self._longest, self._lead = longest, 0.0
        self._arrived: float | None = None

    def fault(self, passed: float, now: float) -> str:
        """Return the fault of a report; empty if its time is in order.

        Args:
            passed: Time since the last report by the robot's clock, in [s].
            now: Time of arrival, in [s].
        """
        if self._arrived is not None:
            gone = (now - self._arrived) * (1.0 + DRIFT)
            self._lead = max(0.0, self._lead + passed - gone)
        self._arrived = now
        if self._lead <= self._longest:
            return ""
        return f"{self._lead:.3f} s ahead of the clock"


class Watchdog:
    """Check of each report, and of its absence.

    The clocks of robot and computer may have different zeros, so only time
    differences are compared: the robot's clock must not run ahead. A report
    with the time of the one before is none: it is repeated.

    Attributes:
        silent: Time since the newest report, in [s].
    """

    def __init__(self, settings: WatchSettings) -> None:
        """Start before the first report."""
        self._settings = settings
        self._newest: RobotState | None = None
        self._repeats = False
        self._last: RobotState | None = None  # if it was valid
        self._arrived = 0.0
        self._lead = LeadMeter(settings.lead)
        self._good = 0
        self._none = f"no {settings.source} received yet"
        self._verdict = self._none
        self._began: float | None = None
        self.silent = 0.0

    def check(self, report: RobotState | None, now: float) -> str:
        """Check a report, or its absence.

        Args:
            report: Newest report; None if none came since the last call.
            now: Time on the clock of this computer, in [s].

        Returns:
            Reason why the robot must stand; empty if it may move.
        """
        if self._began is None:
            self._began = self._arrived = now
        newest = self._newest
        repeats = (
            report is not None
            and newest is not None
            and (report.time == newest.time)
        )
        if report is None or repeats:
            self._repeats = self._repeats or repeats
            verdict = self._silence(now)
            return (report and report.hindrance) or verdict
        fault = self._fault(report, now)
        self._newest, self._repeats = report, False
        self._arrived, self.silent = now, 0.0
        if fault:
            self._good, self._last = 0, None
            self._lead = LeadMeter(self._settings.lead)
            self._verdict = report.hindrance or fault
            return self._verdict
        self._last = report
        self._good += 1
        if self._good < self._settings.warm_up:
            waits = f"waiting for more {self._settings.source}"
            self._verdict = report.hindrance or waits
        else:
            self._verdict = report.hindrance or self._sighting_fault(
                report.sighting, report.time
            )
        return self._verdict

    def _silence(self, now: float) -> str:
        self.silent = now - self._arrived
        if self._settings.paced and self.silent > self._settings.silence:
            self._good, self._last = 0, None
            source, newest = self._settings.source, self._newest
            if newest is not None:
                self._verdict = f"no {source} for {self.silent:.2f} s" + (
                    f": the stamp stays at {newest.time:.3f} s"
                    if self._repeats
                    else ""
                )
        return self._verdict

    def _fault(self, report: RobotState, now: float) -> str:
        """Return why a new report is invalid; empty if it is valid."""
        source, last = self._settings.source, self._last
        passed = 0.0 if last is None else report.time - last.time
        if passed < 0.0:
            return f"{source}: went back in time by {-passed:.3f} s"
        if fault := report_fault(report, last):
            return f"{source}: {fault}"
        if self._settings.paced and (ahead := self._lead.fault(passed, now)):
            return f"{source}: {ahead}"
        return ""

    def _sighting_fault(self, sighting: Sighting | None, now: float) -> str:
        """Return why the sighting cannot be used; empty if it can."""
        if sighting is None:
            return "opponent not detected"
        if not isfinite(sighting.time):
            return f"time of the sighting must be finite, got {sighting.time}"
        if fault := sighting_fault(sighting.bearing, sighting.distance):
            return fault
        age = now - sighting.time
        if age < -self._settings.lead:
            return f"the sighting is {-age:.2f} s in the future"
        if age > self._settings.oldest:
            return f"the sighting is {min(age, 9999.0):.1f} s old"
        return ""


def report_fault(report: RobotState, last: RobotState | None) -> str:
    """Return why a report is implausible; empty if it is plausible.

    Args:
        report: Newest report.
        last: The one before, if it is to be continued; plausible itself.
    """
    if not all(isfinite(v) for v in (report.time, *report.pose)):
        return f"time and pose must be finite, got {_numbers(report)}"
    if abs(report.pose.theta) > 2.0 * pi:
        return (
            "the heading must lie in [-pi, pi] rad, got "
            f"{report.pose.theta:.1f}: is it in degrees?"
        )
    if last is None:
        return ""
    passed = max(report.time - last.time, MIN_PASSED)
    turned = abs(wrap_angle(report.pose.theta - last.pose.theta))
    if turned > FASTEST_TURN * passed:
        return (
            f"the heading jumped by {turned:.2f} rad in {passed:.3f} s: is "
            "it in degrees?"
        )
    moved = hypot(report.pose.x - last.pose.x, report.pose.y - last.pose.y)
    if moved > FASTEST * passed:
        return (
            f"the position jumped by {moved:.2f} m in {passed:.3f} s: is it "
            "in millimetres?"
        )
    return ""


def _numbers(report: RobotState) -> str:
    return ", ".join(f"{v:g}" for v in (report.time, *report.pose))
