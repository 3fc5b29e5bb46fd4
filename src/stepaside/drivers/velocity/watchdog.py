"""Whether what a robot says lets it move: a judge without a clock."""

from dataclasses import dataclass
from math import isfinite

from ...core.errors import ConfigurationError, check_within
from ...perception.measurement import Sighting
from ..sighting_checks import fault_of
from .velocity_body import VelocityReport

DRIFT = 0.02  # by which two clocks may differ, relatively


@dataclass(frozen=True, slots=True)
class WatchSettings:
    """When a robot must rest.

    Attributes:
        silence: Without odometry for this long, in [s].
        oldest: Age of the newest sighting, in [s].
        lead: How far stamps may run ahead of this computer's clock, and
            sightings ahead of the odometry, in [s].
        warm_up: Good reports in a row before the robot may move.
        paced: Whether the robot's time passes as ours does; a simulated one
            may stand still and run.
        forsaken: Without odometry for this long the session is over, in
            [s].
    """

    silence: float = 0.25
    oldest: float = 0.5
    lead: float = 0.1
    warm_up: int = 3
    paced: bool = True
    forsaken: float = 10.0

    def __post_init__(self) -> None:
        """Refuse what watches over nothing."""
        error = ConfigurationError
        check_within(self.silence, 0.01, 60.0, "silence", "s", error)
        check_within(self.oldest, 0.01, 60.0, "oldest", "s", error)
        check_within(self.lead, 0.0, 10.0, "lead", "s", error)
        check_within(self.forsaken, 0.1, 3600.0, "forsaken", "s", error)
        check_within(self.warm_up, 1, 1000, "warm_up", "reports", error)


class Watchdog:
    """Says why a robot must rest, if it must.

    Two clocks need not show the same time. What is known is how much time
    passed on each: stamps that outrun the clock here come from the future.

    Attributes:
        silent: How long there was no report, in [s].
    """

    def __init__(self, settings: WatchSettings) -> None:
        """Begin before the first report."""
        self._settings = settings
        self._stamp: float | None = None
        self._arrived = 0.0
        self._lead = 0.0
        self._good = 0
        self._verdict = "has not been heard yet"
        self._began: float | None = None
        self.silent = 0.0

    def look(self, report: VelocityReport | None, now: float) -> str:
        """Look at a report, or at its absence.

        Args:
            report: What came, if anything did.
            now: Time on the clock of this computer, in [s].

        Returns:
            Why the robot must rest; empty if it may move.
        """
        if self._began is None:
            self._began = self._arrived = now
        if report is None:
            return self._silence(now)
        fault = self._fault(report, now)
        self._arrived, self.silent = now, 0.0
        if fault:
            self._good, self._stamp, self._lead = 0, None, 0.0
            self._verdict = fault
            return fault
        self._stamp = report.time
        self._good += 1
        if self._good < self._settings.warm_up:
            self._verdict = "has only just been heard"
        else:
            self._verdict = report.hindrance or self._sight(
                report.sighting, report.time
            )
        return self._verdict

    def _silence(self, now: float) -> str:
        self.silent = now - self._arrived
        if self._settings.paced and self.silent > self._settings.silence:
            self._good, self._stamp = 0, None
            if self._verdict != "has not been heard yet":
                self._verdict = f"no odometry for {self.silent:.2f} s"
        return self._verdict

    def _fault(self, report: VelocityReport, now: float) -> str:
        """What cannot be true of a report, if anything."""
        if not all(isfinite(v) for v in (report.time, *report.pose)):
            return "odometry holds what is no number"
        if self._stamp is None:
            return ""
        passed = report.time - self._stamp
        if passed < 0.0:
            return f"odometry went back in time by {-passed:.3f} s"
        if not self._settings.paced:
            return ""
        gone = (now - self._arrived) * (1.0 + DRIFT)
        self._lead = max(0.0, self._lead + passed - gone)
        if self._lead > self._settings.lead:
            return f"odometry is {self._lead:.3f} s ahead of the clock"
        return ""

    def _sight(self, seen: Sighting | None, now: float) -> str:
        """Why the newest sighting is none to act upon, if it is not."""
        if seen is None:
            return "sees nobody"
        if not isfinite(seen.time):
            return "the sighting holds what is no number"
        if fault := fault_of(seen.bearing, seen.distance):
            return fault
        age = now - seen.time
        if age < -self._settings.lead:
            return f"the sighting is from the future, by {-age:.2f} s"
        if age > self._settings.oldest:
            return f"the other was seen {min(age, 9999.0):.1f} s ago"
        return ""
