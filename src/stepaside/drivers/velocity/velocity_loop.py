"""One player at one robot that walks by itself."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from time import monotonic

from ...core.errors import StrategyError
from ...core.poses import Pose
from ...perception.measurement import Sighting
from ..guardian_process import SessionLost
from .template_controller import TemplateController
from .velocity_body import REST, VelocityBody, VelocityCommand, VelocityReport
from .velocity_limits import Ramp, VelocityLimits
from .watchdog import Watchdog, WatchSettings

PATIENCE = 0.05  # for a report before the last command is repeated, in [s]
STILL = 1e-6  # velocity below which a robot is asked for none


class DrivingState(Enum):
    """What the robot is doing."""

    WAITING = "waiting"  # must rest: the watchdog says why
    STANDING = "standing"  # may move, and does not want to
    WALKING = "walking"  # goes as control says
    STOPPING = "stopping"  # slows down, for good
    RESTING = "resting"  # is done


@dataclass(frozen=True, slots=True)
class VelocityTick:
    """What one tick was, for whoever looks on.

    Attributes:
        state: What the robot is doing.
        reason: Why, in words.
        time: Of the newest report, on the robot's clock, in [s].
        pose: Where the robot was then, by its odometry.
        sighting: The other, as far as is known.
        wanted: What the template would do.
        velocity: What was asked for.
    """

    state: DrivingState
    reason: str
    time: float
    pose: Pose
    sighting: Sighting | None
    wanted: VelocityCommand
    velocity: VelocityCommand

    @property
    def words(self) -> str:
        """The tick in one line."""
        forward, turn = self.velocity
        return (
            f"{self.state.value} ({self.reason}), "
            f"{forward:+.3f} m/s, {turn:+.3f} rad/s"
        )


class VelocityLoop:
    """Drives a robot by the template's velocities, report by report.

    The robot rests unless everything speaks for motion: whatever is lost or
    cannot be true stops it at once. It goes on by itself when all is well
    again, with a mind that remembers nothing.
    """

    def __init__(
        self,
        body: VelocityBody,
        make_mind: Callable[[], TemplateController],
        limits: VelocityLimits,
        watch: WatchSettings,
        *,
        dry_run: bool = False,
        clock: Callable[[], float] = monotonic,
    ) -> None:
        """Take a robot over.

        Args:
            body: The robot; it is closed by whoever opened it.
            make_mind: Makes a mind that remembers nothing.
            limits: What the robot accepts.
            watch: When it must rest.
            dry_run: Whether nothing is commanded.
            clock: Time of this computer, in [s].
        """
        self.body = body
        self._make_mind = make_mind
        self._mind = make_mind()
        self._ramp = Ramp(limits)
        self._watchdog = Watchdog(watch)
        self._paced, self._forsaken = watch.paced, watch.forsaken
        self._dry_run, self._clock = dry_run, clock
        self._report: VelocityReport | None = None
        self._wanted = REST
        self._why_leave = ""
        self._failure = ""

    def leave(self, reason: str) -> None:
        """Slow down and rest, for good."""
        self._why_leave = self._why_leave or reason

    def tick(self) -> VelocityTick:
        """Listen, decide, command.

        Raises:
            SessionLost: If the robot is gone; it was told to rest as far as
                it could be reached.
        """
        report = self.body.listen(PATIENCE)
        why = self._watchdog.look(report, self._clock())
        if self._watchdog.silent > self._forsaken:
            raise SessionLost(
                f"the robot has not been heard for {self._forsaken:g} s"
            )
        velocity = self._decide(report, why or self._failure)
        if not self._dry_run and (self._paced or report is not None):
            self.body.command(velocity)
        return self._told(why or self._failure, velocity)

    def _decide(
        self, report: VelocityReport | None, why: str
    ) -> VelocityCommand:
        """What to ask for, given why not."""
        last = self._report
        if why:
            if self._mind.moving:
                self._mind = self._make_mind()
            self._report, self._wanted = report or last, REST
            return self._ramp.stop()
        if report is None:
            leaves = bool(self._why_leave)
            return self._ramp.stop() if leaves else self._ramp.velocity
        self._report = report
        passed = 0.0 if last is None else max(report.time - last.time, 0.0)
        if self._why_leave:
            self._wanted = REST
        elif passed > 0.0 or last is None:
            self._wanted = self._ask(report)
        return self._ramp.toward(self._wanted, min(passed, 2.0 * PATIENCE))

    def _ask(self, report: VelocityReport) -> VelocityCommand:
        try:
            return self._mind.decide(report)
        except StrategyError as error:
            self._failure = f"the strategy failed: {error}"
            self.leave(self._failure)
            return REST

    def _told(self, why: str, velocity: VelocityCommand) -> VelocityTick:
        moves = max(abs(velocity.forward), abs(velocity.turn)) > STILL
        if self._why_leave:
            state = DrivingState.STOPPING if moves else DrivingState.RESTING
            reason = self._why_leave
        elif why:
            state, reason = DrivingState.WAITING, why
        elif moves or self._mind.moving:
            state, reason = DrivingState.WALKING, "sees the other"
        else:
            state, reason = DrivingState.STANDING, "no reason to move"
        report = self._report
        return VelocityTick(
            state,
            reason,
            0.0 if report is None else report.time,
            Pose(0.0, 0.0, 0.0) if report is None else report.pose,
            None if report is None else report.sighting,
            self._wanted,
            velocity,
        )
