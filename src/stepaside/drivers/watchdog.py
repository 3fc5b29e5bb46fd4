"""Watchdog of the reports of a robot that follows velocity commands."""

from ..perception.measurement import RobotState, Sighting
from .robot_reports import LEAD, LeadMeter, pose_fault, sighting_fault

SILENCE = 0.25  # longest time without odometry, in [s]
OLDEST = 0.5  # greatest age of the newest sighting, in [s]
WARM_UP = 3  # consecutive valid reports before the robot may move


class Watchdog:
    """Check of each report, and of its absence.

    The clocks of robot and computer may have different zeros, so only time
    differences are compared: the robot's clock must not run ahead. A report
    with the time of the one before is none: it is repeated.

    Attributes:
        silent: Time since the newest report, in [s].
    """

    def __init__(
        self, *, paced: bool = True, source: str = "odometry"
    ) -> None:
        """Start before the first report.

        Args:
            paced: Whether the robot's clock runs in real time; that of a
                simulator may pause or run faster.
            source: What the reports are, for messages.
        """
        self._paced, self._source = paced, source
        self._newest: RobotState | None = None
        self._repeats = False
        self._last: RobotState | None = None  # if it was valid
        self._arrived = 0.0
        self._lead = LeadMeter()
        self._good = 0
        self._verdict = f"no {source} received yet"
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
            self._lead = LeadMeter()
        else:
            self._last = report
            self._good += 1
            if self._good < WARM_UP:
                fault = f"waiting for more {self._source}"
            else:
                fault = _unusable(report.sighting, report.time)
        self._verdict = report.hindrance or fault
        return self._verdict

    def _silence(self, now: float) -> str:
        self.silent = now - self._arrived
        if self._paced and self.silent > SILENCE:
            self._good, self._last = 0, None
            if (newest := self._newest) is not None:
                self._verdict = f"no {self._source} for {self.silent:.2f} s"
                if self._repeats:
                    stays = f": the stamp stays at {newest.time:.3f} s"
                    self._verdict += stays
        return self._verdict

    def _fault(self, report: RobotState, now: float) -> str:
        """Return why a new report is invalid; empty if it is valid."""
        source, last = self._source, self._last
        passed = 0.0 if last is None else report.time - last.time
        if passed < 0.0:
            return f"{source}: went back in time by {-passed:.3f} s"
        if fault := pose_fault(report, last):
            return f"{source}: {fault}"
        if self._paced and (ahead := self._lead.fault(passed, now)):
            return f"{source}: {ahead}"
        return ""


def _unusable(sighting: Sighting | None, now: float) -> str:
    """Return why the sighting cannot be used; empty if it can."""
    if sighting is None:
        return "opponent not detected"
    if fault := sighting_fault(sighting):
        return fault
    age = now - sighting.time
    if age < -LEAD:
        return f"the sighting is {-age:.2f} s in the future"
    if age > OLDEST:
        return f"the sighting is {min(age, 9999.0):.1f} s old"
    return ""
