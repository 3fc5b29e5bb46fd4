"""Control loop of a player whose robot is driven by its joints."""

from collections.abc import Callable
from dataclasses import dataclass

from ..control.scheme import ControlScheme
from ..core.errors import ReachError, StrategyError
from ..core.poses import Array, Pose
from ..locomotion.walk_snapshots import Phase, StepStarted, WalkState
from ..perception.measurement import RobotState, Sighting
from ..strategies import StandStill, Strategy
from .joint_body import JointBody
from .safety_states import SafetyState

SETTLING = 1.0  # of learned legs that were told to stand, in [s]
MakeScheme = Callable[[Strategy], ControlScheme]


@dataclass(frozen=True, slots=True, eq=False)
class JointTick:
    """Result of one tick, for logs and the status line.

    Attributes:
        state: State of the robot.
        reason: Reason for the state, as a message.
        phase: Phase of control.
        measurement: RobotState of the tick.
        targets: Joint targets of control, in [rad]. Shape (joints,).
        sighting: Newest sighting of the opponent; None without one.
        refused: Number of invalid reports so far.
        mind: Number of the control scheme; each has its own odometry.
        walk: State of a walk by maneuvers, in the odometry of that scheme;
            None of other locomotion.
        begun: Step that began at this tick; None if none did.
        pose: Pose of the template in that odometry.
    """

    state: SafetyState
    reason: str
    phase: Phase
    measurement: RobotState
    targets: Array
    sighting: Sighting | None
    refused: int
    mind: int
    walk: WalkState | None
    begun: StepStarted | None
    pose: Pose

    @property
    def time(self) -> float:
        """Time of the measurement, in [s]."""
        return self.measurement.time

    @property
    def walked(self) -> float | None:
        """Time since the walk began, in [s]; None of another state."""
        walks = self.state is SafetyState.WALKING
        return self.measurement.time if walks else None

    @property
    def words(self) -> str:
        """State, reason and phase as a short text."""
        text = f"{self.state.value} ({self.reason}), {self.phase.value}"
        if self.refused:
            text += f", {self.refused} reports refused"
        return text


class JointLoop:
    """Loop of measurement, control and joint command.

    Each walk has its own control scheme: after a walk has ended or was cut
    off, a new scheme starts from the robot's posture.
    """

    def __init__(
        self,
        open_body: Callable[[ControlScheme], JointBody],
        strategy: Strategy,
        make_scheme: MakeScheme,
        *,
        dry_run: bool = False,
    ) -> None:
        """Build the control scheme, then connect.

        In this order, as building takes longer than the time in which the
        first report must be answered.

        Args:
            open_body: Function that connects to the robot of a scheme.
            strategy: Function from knowledge to intent; its memory is
                cleared before each walk.
            make_scheme: Factory of control schemes.
            dry_run: Whether control runs without any joint command.
        """
        self._strategy, self._make_scheme = strategy, make_scheme
        self._scheme: ControlScheme
        self._schemes = 0
        self._renew_scheme()
        self._stood = 0  # ticks of a stop in which control has stood
        self._dry_run = dry_run
        self._leaves = self._was_stiff = False
        self.body = open_body(self._scheme)

    @property
    def ended(self) -> bool:
        """Whether the session has ended, with the robot limp."""
        return self._leaves and self.idle

    @property
    def idle(self) -> bool:
        """Whether the robot is limp."""
        return self.body.state is SafetyState.LIMP

    @property
    def given_up(self) -> str:
        """Reason why a robot without a button was released; else empty."""
        report = self.body.report
        has_button = report is not None and report.status is not None
        if has_button or not (self.idle and self._was_stiff):
            return ""
        return f"the robot was released: {self.body.reason}"

    def leave(self, reason: str) -> None:
        """Stop, crouch and go limp, and end the session."""
        self._leaves = True
        self.body.rest(reason)

    def close(self) -> None:
        """Ramp the stiffness down and disconnect."""
        self.body.close()

    def tick(self) -> JointTick:
        """Read a measurement, decide, and command the joints.

        Raises:
            SessionLost: If the connection failed; the robot was released.
        """
        body = self.body
        measurement = body.read()
        state = body.state
        is_controlled = state.moves_by_control
        if self._dry_run:
            is_controlled = state in (
                SafetyState.REACHING,
                SafetyState.READY,
                SafetyState.WALKING,
            )
        is_resting = state is SafetyState.RESTING
        if self._used and not is_controlled and not is_resting:
            self._renew_scheme()
        targets = self._scheme.joint_targets
        if is_controlled:
            targets = self._update(measurement, state)
        body.write(targets)
        self._was_stiff = self._was_stiff or not self.idle
        scheme = self._scheme
        return JointTick(
            body.state,
            body.reason,
            scheme.phase,
            measurement,
            targets,
            scheme.sighting if is_controlled else measurement.sighting,
            body.refused,
            self._schemes,
            scheme.locomotion.state,
            scheme.begun if is_controlled else None,
            scheme.pose,
        )

    def _update(self, measurement: RobotState, state: SafetyState) -> Array:
        """Update control, and release the robot if that fails."""
        self._used = True
        scheme, body = self._scheme, self.body
        if state is not SafetyState.STOPPING:
            self._stood = 0
        if state is SafetyState.STOPPING:
            scheme.decisions.adopt(StandStill())  # ends the walk
            self._stood = (
                self._stood + 1 if scheme.phase is Phase.STANDING else 0
            )
            settling = 0.0 if scheme.locomotion.state is not None else SETTLING
            if self._stood * body.tick > settling:
                body.halted()
        try:
            targets = scheme.update(measurement)
        except ReachError as error:
            body.fail(f"control lost its footing: {error}")
            return scheme.joint_targets
        except StrategyError as error:
            body.fail(f"the strategy failed: {error}")
            return scheme.joint_targets
        if scheme.phase is Phase.FALLEN:
            body.fail("control detected a fall")
        return targets

    def _renew_scheme(self) -> None:
        self._scheme = self._make_scheme(self._strategy)
        self._schemes += 1
        self._used = False
