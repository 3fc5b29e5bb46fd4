"""The control scheme of one robot (paper, Fig. 4), and how it is built."""

from typing import TYPE_CHECKING

from ..core.poses import Array, Pose
from ..locomotion.control_settings import ControlSettings
from ..locomotion.locomotion import (
    MotionRequest,
    Phase,
    StepStarted,
    Surroundings,
)
from ..locomotion.maneuver_walk import ManeuverWalk
from ..locomotion.step_reach import SHORT, check_steps
from ..locomotion.zmp.open_loop import LoadFeedforward, OpenLoop
from ..perception.measurement import RobotState, Sighting
from ..planning import Foot, GaitSettings
from ..robots.description import RobotDescription
from ..robots.leg_kinematics import LegKinematics
from ..strategies.knowledge import Knowledge
from ..strategies.strategy import BodyStrategy, Strategy
from .sight_sources import MeasuredSight, SightSource
from .strategy_runner import StrategyRunner

if TYPE_CHECKING:
    from ..locomotion.guard import ClearanceSetup
    from ..locomotion.policy.policy_legs import PolicyWalk
    from ..robots.forward_kinematics import ForwardKinematics
    from .body_odometry import BodyTracker


class ControlScheme:
    """Control of one robot (paper, Fig. 4): sense, decide, walk.

    The locomotion asks for a decision when it can use one: at every tick
    while standing, at the end of each step while walking.

    Attributes:
        decisions: Strategy with its memory.
        locomotion: Locomotion, from decisions to joint targets.
        senses: Source of sightings of the opponent.
        sighting: Last sighting of the opponent; None if it is lost.
    """

    def __init__(
        self,
        strategy: Strategy,
        locomotion: "ManeuverWalk | PolicyWalk",
        senses: SightSource | None = None,
        surroundings: Surroundings | None = None,
    ) -> None:
        """Combine its parts; by default measurements bring the sightings."""
        self.senses = senses = senses or MeasuredSight()
        self.locomotion = locomotion
        self.decisions = StrategyRunner(
            strategy,
            locomotion.gait,
            surroundings,
            None if locomotion.maneuvers else locomotion.velocities,
            senses.views,
        )
        self.sighting: Sighting | None = None
        self.decisions.templates.note(0.0, locomotion.pose)
        self._body: BodyTracker | None = None
        if isinstance(strategy, BodyStrategy):
            from .body_odometry import track_body

            self._body = body = track_body(locomotion, surroundings)
            self.decisions.body = body.odometry
        self._delayed = locomotion.heading_delay > 0.0
        self._taken: RobotState | None = None  # last measurement
        self._coasted: float | None = None  # since the last update, until [s]

    def sense(self, measurement: RobotState) -> None:
        """Take the measurement of a control tick, unless it was taken."""
        if measurement is self._taken:
            return
        self._taken, now = measurement, measurement.time
        walk, decisions = self.locomotion, self.decisions
        if self._coasted is not None:
            # Only the last of the poses in between can be asked for.
            decisions.templates.note(
                self._coasted + walk.pose_delay, walk.pose
            )
            self._coasted = None
        decisions.headings.note(now + walk.heading_delay, walk.torso_heading)
        seen = self.senses.see(measurement, walk.step, walk.tilt)
        if self._body is not None:
            seen = self._body.note(measurement, seen)
        self.sighting = seen
        decisions.note_players(self.senses.in_sight)
        walk.note(measurement)

    def look(self, measurement: RobotState) -> Knowledge | None:
        """Return the knowledge for a decision that is due, if one is."""
        self.sense(measurement)
        step = self.locomotion.next_step(measurement.time)
        seen, stands = self.sighting, self.phase is Phase.STANDING
        if step is None or seen is None or (stands and not seen.settled):
            return None
        now, support, side = step
        return self.decisions.knowledge(
            now, seen, (support, side), moving=not stands
        )

    def update(self, measurement: RobotState) -> Array:
        """Return the joint targets of one control tick, in [rad].

        Raises:
            ReachError: If the legs cannot follow the reference.
            StrategyError: If the strategy returns no intent.
        """
        self.sense(measurement)
        walk, now = self.locomotion, measurement.time
        targets = walk.update(measurement, self)
        self.decisions.templates.note(now + walk.pose_delay, walk.pose)
        if walk.phase is not Phase.FALLEN:
            self.senses.aim(targets)
        return targets

    def starts(self, now: float) -> bool:
        """Return whether a standing robot starts; see `.IntentSource`."""
        return self.decisions.starts(now, self.sighting, self.senses.turning)

    def decide(
        self, now: float, support: Pose, side: Foot, *, moving: bool
    ) -> MotionRequest | None:
        """Decide on the next step; see `.IntentSource`.

        None if the opponent is lost.
        """
        turning = self.senses.turning
        if self.sighting is None and not turning:
            return None
        intent = self.decisions.decide(
            now, self.sighting, turning, (support, side), moving=moving
        )
        strategy = self.decisions.strategy
        return MotionRequest(intent, strategy.direction, strategy.saturated)

    @property
    def phase(self) -> Phase:
        """Phase of motion."""
        return self.locomotion.phase

    @property
    def begun(self) -> StepStarted | None:
        """Step that began at the last tick; None if none did."""
        return self.locomotion.begun

    @property
    def joint_targets(self) -> Array:
        """Joint targets of the last tick, in [rad]. Shape (joints,)."""
        return self.locomotion.joint_targets

    @property
    def walk(self) -> ManeuverWalk:
        """Locomotion of a robot that walks by maneuvers."""
        assert isinstance(self.locomotion, ManeuverWalk)
        return self.locomotion

    def coast(self, now: float) -> Array | None:
        """Run a control tick without measurement, in the middle of a step.

        Only for a robot whose sightings need not be followed tick by tick.

        Returns:
            Joint targets, in [rad]; None if this tick needs a measurement,
            and then nothing has changed.

        Raises:
            ReachError: If the legs cannot follow the reference.
        """
        walk, decisions = self.locomotion, self.decisions
        heading = walk.torso_heading if self._delayed else 0.0
        targets = walk.coast(now)
        if targets is not None and self._delayed:
            decisions.headings.note(now + walk.heading_delay, heading)
            decisions.templates.note(now + walk.pose_delay, walk.pose)
        elif targets is not None:
            self._coasted = now
        return targets


def build_walk(
    description: RobotDescription,
    gait: GaitSettings,
    control: ControlSettings,
    *,
    tick: float,
    delay: float = 0.0,
    clearance: "ClearanceSetup | None" = None,
    forward: "ForwardKinematics | None" = None,
) -> ManeuverWalk:
    """Build the walk by maneuvers of one robot.

    The delay is the time from a command to the motion, in [s]; ``forward``
    are the kinematics of the measured body, built if not given.

    Raises:
        ReachError: If the stance or the steps of the gait are out of reach.
    """
    legs = LegKinematics(description, tick=tick)
    loads = None
    if not control.feedback or control.stabiliser.load_share > 0.0:
        loads = LoadFeedforward(legs, zmp_forward=gait.zmp_forward, tick=tick)
    balance = OpenLoop(legs, loads)
    if control.feedback:
        from ..locomotion.zmp.stabiliser import build_stabiliser

        balance = build_stabiliser(
            *(description, gait, control, legs, loads),
            tick=tick,
            delay=delay,
            forward=forward,
        )
    guard = None if clearance is None else clearance.guard(gait, control)
    walk = ManeuverWalk(
        gait, legs, balance, tick=tick, delay=delay, guard=guard
    )
    if max(gait.stride, gait.step_height) > SHORT * gait.com_height:
        check_steps(legs, gait)
    return walk
