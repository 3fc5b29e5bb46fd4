"""Simulated robots placed in a world, with sensors and controller."""

from collections.abc import Iterable
from dataclasses import is_dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

from ..control.scheme import ControlScheme, VelocityScheme, build_walk
from ..control.sight_sources import MeasuredSight, SightSource
from ..control.strategy_runner import StrategyRunner
from ..core.poses import Pose
from ..core.random_streams import named_generator
from ..locomotion.maneuver_walk import ManeuverWalk
from ..robots.description import RobotDescription
from ..robots.leg_kinematics import LegKinematics
from ..sim.body_settings import BodySettings
from ..sim.ground_truth import IdealLineOfSight, TrueRobotState
from ..sim.physics_settings import PhysicsSettings
from ..sim.simulated_robot import SimulatedRobot
from ..sim.world import World
from ..strategies import Strategy
from .player_settings import PlayerSettings
from .players import RobotPlayer, VelocityWalker

if TYPE_CHECKING:
    from ..locomotion.guard import ClearanceSetup
    from ..locomotion.policy.policy_legs import (
        InitialPosture,
        PolicyLegs,
        PolicyWalk,
    )
    from ..sim.ranging import Lidar
    from ..sim.sensor_suite import SensorSuite


ORIGIN = Pose(0.0, 0.0, 0.0)


class RobotSetup(NamedTuple):
    """Robot of a game, before it stands in the world."""

    own: PlayerSettings  # with the pose of its odometry, by default the origin
    description: RobotDescription
    body: BodySettings = BodySettings()
    seed: int = 0  # of sensor errors
    truth: TrueRobotState | None = None  # its true state, if that exists
    source: SightSource | None = None  # of sightings for its controller
    sights: tuple[IdealLineOfSight, ...] = ()  # of each other player
    eyes: "SensorSuite | Lidar | None" = None
    # Knowledge of the room; who knows the room also knows its pose in it.
    clearance: "ClearanceSetup | None" = None

    @property
    def start(self) -> Pose:
        """Pose of its odometry in the world."""
        return self.own.pose or ORIGIN

    def true_state_in(self, world: World) -> TrueRobotState:
        """Return the true state of the robot in a world that contains it."""
        return TrueRobotState(
            world.model,
            world.data,
            f"{self.own.name}/{self.description.torso}",
            com_forward=self.own.gait.zmp_forward,
            place=self.description.place,
        )

    def place(
        self, world: World, standing: "LegKinematics | PolicyLegs"
    ) -> SimulatedRobot:
        """Place it in the posture of kinematics, or on learned legs.

        Learned legs drive it by the torques of their policy.
        """
        gains = None
        posture: LegKinematics | InitialPosture
        if isinstance(standing, LegKinematics):
            posture = standing
        else:
            contract, posture = standing.contract, standing.standing
            pairs = zip(contract.stiffness, contract.damping, strict=True)
            gains = dict(zip(contract.joints, pairs, strict=True))
        known, own = self.clearance, self.own
        return SimulatedRobot(
            world,
            own.name,
            self.description,
            posture,
            self.start,
            self.body,
            generator=named_generator(self.seed, f"sensors/{own.name}"),
            integrates_imu=gains is not None or bool(own.control.feedback),
            sights=self.sights,
            eyes=self.eyes,
            truth=self.truth or self.true_state_in(world),
            knows_pose=known is not None and known.surroundings.needs_pose,
            gains=gains,
        )


def place_robot(
    world: World, setup: RobotSetup, strategy: Strategy | None
) -> RobotPlayer:
    """Place a robot in a world that contains it, with its controller.

    Without a strategy it walks at velocities of another process.
    """
    own, known, tick = setup.own, setup.clearance, world.physics.tick
    source = setup.source or MeasuredSight()
    walk: ManeuverWalk | PolicyWalk
    if own.legs.walks:
        from ..locomotion.policy import policy_legs as learned

        legs = learned.load_legs(own.legs, setup.description, tick=tick)
        guard = known and known.velocity_guard(legs.velocities)
        walk = learned.PolicyWalk(legs, own.gait, guard)
        robot = setup.place(world, legs)
    else:
        walk = build_walk(
            *(setup.description, own.gait, own.control),
            tick=tick,
            delay=setup.body.delay_cycles * tick,
            clearance=known,
            forward=source.forward,
        )
        robot = setup.place(world, walk.kinematics)
    if strategy is None:
        scheme = VelocityScheme(walk)
        return VelocityWalker(robot, scheme, setup.start, setup.description)
    runner = StrategyRunner(
        with_body_radius(strategy, setup),
        own.gait,
        known and known.surroundings,
        velocities=None if walk.maneuvers else walk.velocities,
        views=source.views,
    )
    return RobotPlayer(robot, ControlScheme(runner, walk, source), setup.start)


def with_body_radius(strategy: Strategy, setup: RobotSetup) -> Strategy:
    """Return a strategy whose body radius is at least that of the robot.

    One without an attribute ``body_radius`` is returned unchanged.
    """
    known = setup.clearance
    if known is None or not is_dataclass(strategy):
        return strategy
    radius = known.radius(setup.own.gait)
    if getattr(strategy, "body_radius", radius) >= radius:
        return strategy
    enlarged: Strategy = replace(strategy, body_radius=radius)
    return enlarged


def policy_physics(
    physics: PhysicsSettings, body: BodySettings, robots: Iterable[RobotSetup]
) -> PhysicsSettings:
    """Return physics settings whose tick is the period of the policies.

    With an ideal body nothing happens between two evaluations of a policy:
    the actuators apply its gains at every time step. One with delays or
    sensor errors keeps its tick.
    """
    from ..locomotion.policy.policy_legs import load_policy

    if body.has_sensor_errors or not body.has_ideal_servos:
        return physics
    periods = {
        load_policy(r.own.legs, r.description)[0].period for r in robots
    }
    if len(periods) != 1:
        return physics
    steps = periods.pop() / physics.time_step
    if round(steps) < 1 or abs(steps - round(steps)) > 1e-6:
        return physics
    return replace(physics, tick=round(steps) * physics.time_step)
