"""Simulated robots with their own walk, commanded by velocities."""

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from ..control import ControlScheme
from ..control.scheme_builder import ClearanceSetup, build_scheme
from ..control.sight_sources import MeasuredSight
from ..control.turn_calibration import TurnCalibration
from ..control.velocity_walk import limit_velocity, strategy_at_velocity
from ..core.poses import Array, Pose, wrap_angle
from ..drivers.velocity.footstep_commands import FootCommand
from ..drivers.velocity.velocity_body import REST, VelocityCommand
from ..drivers.velocity.walking_robot import WalkerState
from ..locomotion.walk_snapshots import Phase
from ..perception.images import ColourImage, SonarEcho
from ..perception.measurement import Measurement, Sighting
from ..planning import Direction, Foot
from ..sim.ground_truth import TrueRobotState
from ..sim.ideal_sensors import IdealLineOfSight
from ..sim.simulated_robot import SimulatedRobot
from ..sim.world import World
from ..strategies import StandStill
from .walker import SimulatedPlayer
from .walker_factory import WalkerSetup, place_robot

if TYPE_CHECKING:
    from ..sim.sensor_suite import SensorSuite

HEAD_SPEED = 3.0  # of a head commanded by a client, in [rad/s]
# Placeholder that lets the walk start: commands do not depend on sightings.
PLACEHOLDER = Sighting(0.0, 0.0, 1.0)


class VelocityWalker(SimulatedPlayer):
    """Simulated robot that walks at commanded velocities.

    At every tick its scheme adopts the strategy that follows the command.
    """

    def __init__(
        self, robot: SimulatedRobot, scheme: ControlScheme, frame: Pose
    ) -> None:
        """Combine a robot and its controller.

        Args:
            robot: The robot.
            scheme: Controller that does not calibrate turns: they are
                calibrated here, against the commanded turns.
            frame: Pose of its odometry in the world.
        """
        super().__init__(robot, scheme, frame)
        self._walking_direction: Direction | None = None
        self._velocity = REST
        self._measurement: Measurement | None = None
        self._head: dict[int, float] = {}
        self._head_targets: Array | None = None
        self._image: ColourImage | None = None
        self._echoes: dict[str, float | None] = {}
        self._ticks = -1
        self._steps = 0
        self._updated = False
        self._turns = TurnCalibration(robot.world.physics.tick)

    def command(self, velocity: VelocityCommand) -> None:
        """Walk at a velocity from the next tick on."""
        self._velocity = velocity

    def tick(self) -> None:
        """Walk at the commanded velocity."""
        scheme = self.scheme
        if scheme.phase is Phase.STANDING:
            self._walking_direction = None
        measurement = self._read()
        forward, turn = limit_velocity(*self._velocity[:2], scheme.gait)
        strategy = strategy_at_velocity(
            forward,
            turn / self._turns.share,
            scheme.gait,
            under_way=self._walking_direction,
        )
        scheme.decisions.adopt(strategy)
        targets = scheme.update(measurement)
        if self._head:
            targets = self._with_head(targets)
        self.robot.write(targets)
        self._updated = True
        self._turns.note(
            float(measurement.gyro[2]),
            scheme.decisions.templates.at(measurement.time).theta,
            stands=scheme.phase is Phase.STANDING,
        )
        begun = scheme.begun
        if begun is not None and begun.planning_time is not None:
            self._steps += 1
        if self._walking_direction is None and scheme.phase is Phase.WALKING:
            self._walking_direction = strategy.direction

    def state(self) -> WalkerState:
        """Return the state that the robot reports to its client."""
        measurement = self._read()
        now, scheme = measurement.time, self.scheme
        walk = scheme.state
        velocity = limit_velocity(*self._velocity[:2], scheme.gait)
        return WalkerState(
            now,
            scheme.decisions.templates.at(now),
            VelocityCommand(*velocity),
            measurement.joint_positions.tolist(),
            self._sighting(measurement),
            self._image,
            (walk.left_foot, walk.right_foot),
            self._present_step(now),
            self._steps,
            self._echoes.copy(),
        )

    def lead_with(self, foot: Foot) -> None:
        """Make the first step with a foot, if the robot stands."""
        self.scheme.locomotion.lead_with(foot)

    def _present_step(self, now: float) -> FootCommand | None:
        """Return the step in progress, with its remaining time."""
        walk = self.scheme.state
        plan = walk.plan
        if plan is None:
            return None
        ends = walk.plan_started + plan.schedule.first_step_duration
        landing = Pose(*plan.placements[2].tolist())
        return FootCommand(plan.first_foot, landing, max(0.0, ends - now))

    def look(self, angles: Mapping[str, float]) -> None:
        """Turn the head.

        Args:
            angles: Target angles of head joints by name, in [rad].

        Raises:
            ValueError: If the robot has no such joint.
        """
        kinematics = self.scheme.kinematics
        for name, angle in angles.items():
            self._head[kinematics.joint_names.index(name)] = angle

    def _with_head(self, targets: Array) -> Array:
        """Return joint targets with the head moved at limited speed."""
        if self._head_targets is None:
            self._head_targets = targets.copy()
        changed = targets.copy()
        limit = HEAD_SPEED * self.robot.world.physics.tick
        for joint, angle in self._head.items():
            error = angle - float(self._head_targets[joint])
            self._head_targets[joint] += min(max(error, -limit), limit)
            changed[joint] = self._head_targets[joint]
        return changed

    def _read(self) -> Measurement:
        """Return the measurement of this tick; noise is drawn once."""
        ticks = self.robot.world.ticks
        if self._measurement is None or ticks != self._ticks:
            self._measurement, self._ticks = self.robot.read(), ticks
            for percept in self._measurement.percepts:
                if isinstance(percept, ColourImage):
                    self._image = percept
                elif isinstance(percept, SonarEcho):
                    self._echoes[percept.sonar] = percept.distance
        return self._measurement

    def _sighting(self, measurement: Measurement) -> Sighting | None:
        """Return the sighting with its bearing relative to the template."""
        sighting, decisions = measurement.sighting, self.scheme.decisions
        if sighting is None:
            return None
        torso_heading = (
            decisions.headings.at(sighting.time)
            if self._updated
            else self.scheme.kinematics.torso_heading
        )
        template_heading = decisions.templates.at(sighting.time).theta
        bearing = wrap_angle(
            torso_heading + sighting.bearing - template_heading
        )
        return Sighting(sighting.time, bearing, sighting.distance)


def place_velocity_walker(
    world: World,
    setup: WalkerSetup,
    *,
    truth: TrueRobotState,
    sight: IdealLineOfSight | None = None,
    eyes: "SensorSuite | None" = None,
    clearance: ClearanceSetup | None = None,
) -> VelocityWalker:
    """Place a robot that walks at commanded velocities in a world.

    Args:
        world: World that contains the robot.
        setup: The robot.
        truth: True state of the robot.
        sight: Ideal sensor of the opponent, reported to the client.
        eyes: Cameras and sonars, reported to the client.
        clearance: Knowledge of the room and required clearance.

    Raises:
        ReachError: If the legs cannot reach the initial stance of the gait.
    """
    tick = world.physics.tick
    scheme = build_scheme(
        StandStill(),
        setup.description,
        setup.gait,
        replace(setup.control, learn_turns=False),
        tick=tick,
        delay=setup.body.delay_cycles * tick,
        senses=MeasuredSight(PLACEHOLDER),
        clearance=clearance,
    )
    robot = place_robot(
        world,
        setup,
        scheme.kinematics,
        sight=sight,
        eyes=eyes,
        truth=truth,
        clearance=clearance,
    )
    return VelocityWalker(robot, scheme, setup.odometry_in_world)
