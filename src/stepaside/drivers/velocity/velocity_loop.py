"""Control loop of a player whose robot follows velocity commands."""

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
STILL = 1e-6  # velocity below which a robot stands, in [m/s] or [rad/s]


class DrivingState(Enum):
    """State of a robot that follows velocity commands."""

    WAITING = "waiting"  # must stand, for a reason of the watchdog
    STANDING = "standing"  # may move; the strategy's intent is to stand
    WALKING = "walking"  # follows the template
    STOPPING = "stopping"  # slows down to end the session
    RESTING = "resting"  # stands at the end of the session


@dataclass(frozen=True, slots=True)
class VelocityTick:
    """Result of one tick, for logs and the status line.

    Attributes:
        state: State of the robot.
        reason: Reason for the state, as a message.
        time: Time of the newest report on the robot's clock, in [s].
        pose: Pose of the robot in odometry at that time.
        sighting: Newest sighting of the opponent; None without one.
        wanted: Velocity of the template.
        velocity: Command that was sent.
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
        """State, reason and command as a short text."""
        forward, turn, lateral = self.velocity
        aside = f"{lateral:+.3f} m/s aside, " if lateral else ""
        return (
            f"{self.state.value} ({self.reason}), "
            f"{forward:+.3f} m/s, {aside}{turn:+.3f} rad/s"
        )


class VelocityLoop:
    """Loop that drives a robot by the template's velocities.

    Any missing or implausible input stops the robot at once. When the
    inputs are valid again it continues, with a new controller.
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
        """Start the loop; the robot stands.

        Args:
            body: The robot; the caller closes it.
            make_mind: Factory of controllers.
            limits: Limits of the commands.
            watch: Settings of the watchdog.
            dry_run: Whether nothing is commanded.
            clock: Time of this computer, in [s].
        """
        self.body = body
        self._make_controller = make_mind
        self._controller = make_mind()
        self._ramp = Ramp(limits)
        self._watchdog = Watchdog(watch)
        self._paced, self._forsaken = watch.paced, watch.forsaken
        self._dry_run, self._clock = dry_run, clock
        self._report: VelocityReport | None = None
        self._wanted = REST
        self._leave_reason = ""
        self._failure = ""

    def leave(self, reason: str) -> None:
        """Slow down and end the session."""
        self._leave_reason = self._leave_reason or reason

    def tick(self) -> VelocityTick:
        """Read a report, decide, and send a command.

        Raises:
            SessionLost: If the connection failed; the robot was commanded
                to stop if it could be reached.
        """
        report = self.body.listen(PATIENCE)
        hindrance = self._watchdog.check(report, self._clock())
        # The clock of a simulator may pause for any time.
        waits = self._paced or self._report is None
        if waits and self._watchdog.silent > self._forsaken:
            raise SessionLost(
                f"no new report from the robot for {self._forsaken:g} s: "
                f"{hindrance}"
            )
        hindrance = hindrance or self._failure
        velocity = self._decide(report, hindrance)
        if not self._dry_run and (self._paced or report is not None):
            self.body.command(velocity)
        return self._result(hindrance or self._failure, velocity)

    def _decide(
        self, report: VelocityReport | None, hindrance: str
    ) -> VelocityCommand:
        """Return the command; zero while there is a hindrance."""
        last = self._report
        if hindrance:
            if self._controller.moving:
                self._controller = self._make_controller()
            self._report, self._wanted = report or last, REST
            return self._ramp.stop()
        if report is None:
            leaves = bool(self._leave_reason)
            return self._ramp.stop() if leaves else self._ramp.velocity
        self._report = report
        passed = 0.0 if last is None else max(report.time - last.time, 0.0)
        if self._leave_reason:
            self._wanted = REST
        elif passed > 0.0 or last is None:
            self._wanted = self._template_velocity(report)
        return self._ramp.toward(self._wanted, min(passed, 2.0 * PATIENCE))

    def _template_velocity(self, report: VelocityReport) -> VelocityCommand:
        try:
            return self._controller.decide(report)
        except StrategyError as error:
            self._failure = f"the strategy failed: {error}"
            self.leave(self._failure)
            return REST

    def _result(
        self, hindrance: str, velocity: VelocityCommand
    ) -> VelocityTick:
        moves = max(abs(value) for value in velocity) > STILL
        if self._leave_reason:
            state = DrivingState.STOPPING if moves else DrivingState.RESTING
            reason = self._leave_reason
        elif hindrance:
            state, reason = DrivingState.WAITING, hindrance
        elif moves or self._controller.moving:
            state, reason = DrivingState.WALKING, "opponent detected"
        else:
            state, reason = DrivingState.STANDING, "strategy wants to stand"
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
