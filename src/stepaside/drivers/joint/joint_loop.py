"""One player at one robot: control in a process of its own."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from ...control import ControlScheme, Phase
from ...control.walk_snapshots import StepStarted, WalkState
from ...core.errors import ReachError, StrategyError
from ...core.poses import Array
from ...perception.measurement import Measurement, Sighting
from ...strategies import StandStill, Strategy
from .joint_body import JointBody
from .safety import RobotState

MakeScheme = Callable[[Strategy], ControlScheme]


@dataclass(frozen=True, slots=True, eq=False)
class JointTick:
    """What one tick was, for whoever looks on.

    Attributes:
        state: What the robot may do.
        reason: Why, in words.
        phase: What control is doing.
        measurement: What the sensors gave.
        targets: What control wanted, in [rad]. Shape (joints,).
        sighting: The other, as far as is known.
        refused: Frames that were none, so far.
        mind: Number of the mind that thinks; each has its own odometry.
        walk: What control plans and asks, in the odometry of that mind.
        begun: Step that began at this tick; None if none did.
    """

    state: RobotState
    reason: str
    phase: Phase
    measurement: Measurement
    targets: Array
    sighting: Sighting | None
    refused: int
    mind: int
    walk: WalkState
    begun: StepStarted | None

    @property
    def time(self) -> float:
        """When it was, in [s]."""
        return self.measurement.time

    @property
    def words(self) -> str:
        """What it was, in a few words."""
        text = f"{self.state.value} ({self.reason}), {self.phase.value}"
        if self.refused:
            text += f", {self.refused} frames refused"
        return text


class TickObserver(Protocol):
    """Whoever looks on: a status line, a log."""

    def note(self, tick: JointTick) -> None:
        """Look at one tick."""


class JointLoop:
    """Moves a robot by control while it may, tick by tick.

    A mind walks once: after it has come to rest, or was cut off, a new one
    begins where the robot stands then.
    """

    def __init__(
        self,
        open_body: Callable[[ControlScheme], JointBody],
        strategy: Strategy,
        make_scheme: MakeScheme,
        *,
        dry_run: bool = False,
    ) -> None:
        """Think first, connect then: thinking takes longer than a frame.

        Args:
            open_body: Connects to the robot that a scheme will move.
            strategy: From what it knows to what it wants; every walk begins
                with nothing remembered.
            make_scheme: Its control for a strategy.
            dry_run: Whether control runs without moving anything.
        """
        self._strategy, self._make_scheme = strategy, make_scheme
        self._scheme: ControlScheme
        self._minds = 0
        self._think_anew()
        self._dry_run = dry_run
        self.body = open_body(self._scheme)

    def tick(self) -> JointTick:
        """Read, decide, answer.

        Raises:
            SessionLost: If the robot is gone; it was let go of.
        """
        body = self.body
        measurement = body.read()
        state = body.state
        thinks = state.moves_by_control
        if self._dry_run:
            thinks = state in (
                RobotState.REACHING,
                RobotState.READY,
                RobotState.WALKING,
            )
        if self._used and not thinks and state is not RobotState.RESTING:
            self._think_anew()
        targets = self._scheme.joint_targets
        if thinks:
            targets = self._think(measurement, state)
        body.write(targets)
        body.step()
        scheme = self._scheme
        return JointTick(
            body.state,
            body.reason,
            scheme.phase,
            measurement,
            targets,
            scheme.sighting if thinks else body.sighting,
            body.refused,
            self._minds,
            scheme.state,
            scheme.begun if thinks else None,
        )

    def _think(self, measurement: Measurement, state: RobotState) -> Array:
        """Let control decide, and see that it still can."""
        self._used = True
        scheme, body = self._scheme, self.body
        if state is RobotState.STOPPING:
            scheme.decisions.adopt(StandStill())  # comes to rest
            if scheme.phase is Phase.STANDING:
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
            body.fail("control feels that it falls")
        return targets

    def _think_anew(self) -> None:
        self._scheme = self._make_scheme(self._strategy)
        self._minds += 1
        self._used = False
