"""Watchdog of the reports of a robot that follows velocity commands."""

from ..perception.measurement import RobotState, Sighting
from ..planning import GaitSettings
from .robot_reports import LEAD, ClockMeter, pose_fault, sighting_fault

ODOMETRY_SILENCE = 0.25  # longest time without odometry, in [s]
OLDEST = 0.5  # greatest age of the newest sighting, in [s]
# Exactly the same pose while the robot is to move, beyond the time in which a
# standing robot shifts its weight before its first step, in [s].
STUCK = 0.7
WARM_UP = 3  # consecutive valid reports before the robot may move


class Watchdog:
    """Check of each report, and of its absence.

    The clocks of robot and computer may have different zeros, so only time
    differences are compared. A report with the time of the one before is
    none: it is repeated.

    Attributes:
        paced: Whether the robot's clock runs in real time.
        silent: Time since the newest report, in [s].
    """

    def __init__(
        self,
        *,
        paced: bool = True,
        source: str = "odometry",
        start_support: float = GaitSettings().start_support,
    ) -> None:
        """Start before the first report of a source.

        A clock that is not paced may pause or run faster than real time. The
        pose may stay for the start support of the gait, in [s], and a while.
        """
        self.paced, self._source = paced, source
        self._longest = start_support + STUCK
        self._newest: RobotState | None = None
        self._repeats = False
        self._last: RobotState | None = None  # if it was valid
        self._arrived: float | None = None
        self._meter = ClockMeter()
        self._good = 0
        self._verdict = f"no {source} received yet"
        self._stuck = 0.0  # time of the same pose while it was to move, in [s]
        self.silent = 0.0

    def check(
        self, report: RobotState | None, now: float, *, moves: bool = False
    ) -> str:
        """Return why the robot must stand; empty if it may move."""
        newest = self._newest
        if self._arrived is None:
            self._arrived = now
        if report is None or newest and report.time == newest.time:
            self._repeats = self._repeats or report is not None
            self._note_silence(now - self._arrived)
            return (report and report.hindrance) or self._verdict
        fault = self._fault(report, now, moves)
        self._newest, self._repeats = report, False
        self._arrived, self.silent = now, 0.0
        if fault:
            self._good, self._last = 0, None
        else:
            self._last = report
            self._good += 1
            if self._good < WARM_UP:
                fault = f"waiting for more {self._source}"
            else:
                fault = _unusable(report.sighting, report.time)
        self._verdict = report.hindrance or fault
        return self._verdict

    def _note_silence(self, silent: float) -> None:
        self.silent = silent
        if self.paced and silent > ODOMETRY_SILENCE:
            self._good, self._last = 0, None
            if (newest := self._newest) is not None:
                self._verdict = f"no {self._source} for {silent:.2f} s"
                if self._repeats:
                    stays = f": the stamp stays at {newest.time:.3f} s"
                    self._verdict += stays

    def _fault(self, report: RobotState, now: float, moves: bool) -> str:
        """Return why a new report is invalid; empty if it is valid."""
        source, last = self._source, self._last
        if last and report.time < last.time:
            passed = last.time - report.time
            return f"{source}: went back in time by {passed:.3f} s"
        if fault := pose_fault(report, last):
            return f"{source}: {fault}"
        if self.paced and (off := self._meter.fault(report.time, now)):
            return f"{source}: {off}; a simulated clock needs sim_time"
        newest = self._newest
        if newest is None or report.pose != newest.pose:
            self._stuck = 0.0
        elif moves:
            self._stuck += report.time - newest.time
        if self._stuck < self._longest:
            return ""
        return (
            f"{source}: the pose does not change while the robot is to move "
            f"for {self._longest:g} s (gait.start_support + {STUCK:g} s)"
        )


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
