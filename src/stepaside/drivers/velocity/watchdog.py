"""Watchdog of the reports of a robot that follows velocity commands."""

from dataclasses import dataclass
from math import isfinite

from ...core.errors import ConfigurationError, check_within
from ...perception.measurement import Sighting
from ..sighting_checks import sighting_fault
from .velocity_body import VelocityReport

DRIFT = 0.02  # relative difference of two clocks' rates at most


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
    lead: float = 0.1
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


class Watchdog:
    """Check of each report, and of its absence.

    The clocks of robot and computer may have different zeros, so only time
    differences are compared: the robot's clock must not run ahead.

    Attributes:
        silent: Time since the newest report, in [s].
    """

    def __init__(self, settings: WatchSettings) -> None:
        """Start before the first report."""
        self._settings = settings
        self._stamp: float | None = None
        self._arrived = 0.0
        self._lead = 0.0
        self._good = 0
        self._none = f"no {settings.source} received yet"
        self._verdict = self._none
        self._began: float | None = None
        self.silent = 0.0

    def check(self, report: VelocityReport | None, now: float) -> str:
        """Check a report, or its absence.

        Args:
            report: Newest report; None if none came since the last call.
            now: Time on the clock of this computer, in [s].

        Returns:
            Reason why the robot must stand; empty if it may move.
        """
        if self._began is None:
            self._began = self._arrived = now
        if report is None:
            return self._silence(now)
        fault = self._fault(report, now)
        self._arrived, self.silent = now, 0.0
        if fault:
            self._good, self._stamp, self._lead = 0, None, 0.0
            self._verdict = report.hindrance or fault
            return self._verdict
        self._stamp = report.time
        self._good += 1
        if self._good < self._settings.warm_up:
            self._verdict = f"waiting for more {self._settings.source}"
        else:
            self._verdict = report.hindrance or self._sighting_fault(
                report.sighting, report.time
            )
        return self._verdict

    def _silence(self, now: float) -> str:
        self.silent = now - self._arrived
        if self._settings.paced and self.silent > self._settings.silence:
            self._good, self._stamp = 0, None
            if self._verdict != self._none:
                self._verdict = (
                    f"no {self._settings.source} for {self.silent:.2f} s"
                )
        return self._verdict

    def _fault(self, report: VelocityReport, now: float) -> str:
        """Return why the odometry is invalid; empty if it is valid."""
        if not all(isfinite(v) for v in (report.time, *report.pose)):
            return f"{self._settings.source}: NaN or inf"
        if self._stamp is None:
            return ""
        passed = report.time - self._stamp
        if passed < 0.0:
            source = self._settings.source
            return f"{source}: went back in time by {-passed:.3f} s"
        if not self._settings.paced:
            return ""
        gone = (now - self._arrived) * (1.0 + DRIFT)
        self._lead = max(0.0, self._lead + passed - gone)
        if self._lead > self._settings.lead:
            source = self._settings.source
            return f"{source}: {self._lead:.3f} s ahead of the clock"
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
