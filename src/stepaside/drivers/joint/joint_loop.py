"""Control loop of a player whose robot is driven by its joints."""

from collections.abc import Callable
from dataclasses import dataclass

from ...control.scheme import ControlScheme
from ...core.errors import ReachError, StrategyError
from ...core.poses import Array, Pose
from ...locomotion.walk_snapshots import Phase, StepStarted, WalkState
from ...perception.measurement import Measurement, Sighting
from ...strategies import StandStill, Strategy
from .joint_body import JointBody
from .safety_state_machine import RobotState

SETTLING = 1.0  # of learned legs that were told to stand, in [s]
MakeScheme = Callable[[Strategy], ControlScheme]


@dataclass(frozen=True, slots=True, eq=False)
class JointTick:
    """Result of one tick, for logs and the status line.

    Attributes:
        state: State of the robot.
        reason: Reason for the state, as a message.
        phase: Phase of control.
        measurement: Measurement of the tick.
        targets: Joint targets of control, in [rad]. Shape (joints,).
        sighting: Newest sighting of the opponent; None without one.
        refused: Number of invalid frames so far.
        mind: Number of the control scheme; each has its own odometry.
        walk: State of a walk by maneuvers, in the odometry of that scheme;
            None of other locomotion.
        begun: Step that began at this tick; None if none did.
        pose: Pose of the template in that odometry.
    """

    state: RobotState
    reason: str
    phase: Phase
    measurement: Measurement
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
    def words(self) -> str:
        """State, reason and phase as a short text."""
        text = f"{self.state.value} ({self.reason}), {self.phase.value}"
        if self.refused:
            text += f", {self.refused} frames refused"
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
        first frame must be answered.

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
        self.body = open_body(self._scheme)

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
                RobotState.REACHING,
                RobotState.READY,
                RobotState.WALKING,
            )
        is_resting = state is RobotState.RESTING
        if self._used and not is_controlled and not is_resting:
            self._renew_scheme()
        targets = self._scheme.joint_targets
        if is_controlled:
            targets = self._update(measurement, state)
        body.write(targets)
        body.step()
        scheme = self._scheme
        return JointTick(
            body.state,
            body.reason,
            scheme.phase,
            measurement,
            targets,
            scheme.sighting if is_controlled else body.sighting,
            body.refused,
            self._schemes,
            scheme.locomotion.state,
            scheme.begun if is_controlled else None,
            scheme.pose,
        )

    def _update(self, measurement: Measurement, state: RobotState) -> Array:
        """Update control, and release the robot if that fails."""
        self._used = True
        scheme, body = self._scheme, self.body
        if state is not RobotState.STOPPING:
            self._stood = 0
        if state is RobotState.STOPPING:
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
