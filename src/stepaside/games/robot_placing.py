"""Simulated robots placed in a world, with sensors and controller."""

from collections.abc import Iterable
from dataclasses import is_dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

from ..control.scheme import (
    ControlScheme,
    VelocityScheme,
    build_scheme,
    build_walk,
)
from ..control.sight_sources import MeasuredSight, SightSource
from ..control.strategy_runner import StrategyRunner
from ..core.poses import Pose
from ..core.random_streams import named_generator
from ..locomotion.control_settings import (
    ControlSettings,
    LegsSettings,
)
from ..locomotion.maneuver_walk import ManeuverWalk
from ..planning import GaitSettings
from ..robots.description import RobotDescription
from ..robots.leg_kinematics import LegKinematics
from ..sim.body_settings import BodySettings
from ..sim.ground_truth import IdealLineOfSight, TrueRobotState
from ..sim.physics_settings import PhysicsSettings
from ..sim.simulated_robot import SimulatedRobot
from ..sim.world import World
from ..strategies import Strategy
from .robot_player import RobotPlayer, VelocityWalker

if TYPE_CHECKING:
    from ..locomotion.guard import ClearanceSetup
    from ..locomotion.policy.policy_legs import (
        InitialPosture,
        PolicyLegs,
        PolicyWalk,
    )
    from ..sim.ranging import Lidar
    from ..sim.sensor_suite import SensorSuite


class RobotSetup(NamedTuple):
    """Robot of a game, before it stands in the world."""

    name: str  # in the world
    description: RobotDescription
    gait: GaitSettings  # or template of learned legs
    control: ControlSettings = ControlSettings()
    legs: LegsSettings = LegsSettings()
    body: BodySettings = BodySettings()
    start: Pose = Pose(0.0, 0.0, 0.0)  # of its odometry in the world
    seed: int = 0  # of sensor errors
    truth: TrueRobotState | None = None  # its true state, if that exists
    source: SightSource | None = None  # of sightings for its controller
    sights: tuple[IdealLineOfSight, ...] = ()  # of each other player
    eyes: "SensorSuite | Lidar | None" = None
    # Knowledge of the room; who knows the room also knows its pose in it.
    clearance: "ClearanceSetup | None" = None

    def true_state_in(self, world: World) -> TrueRobotState:
        """Return the true state of the robot in a world that contains it."""
        return TrueRobotState(
            world.model,
            world.data,
            f"{self.name}/{self.description.torso}",
            com_forward=self.gait.zmp_forward,
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
            own, posture = standing.contract, standing.standing
            pairs = zip(own.stiffness, own.damping, strict=True)
            gains = dict(zip(own.joints, pairs, strict=True))
        known = self.clearance
        return SimulatedRobot(
            world,
            self.name,
            self.description,
            posture,
            self.start,
            self.body,
            generator=named_generator(self.seed, f"sensors/{self.name}"),
            integrates_imu=gains is not None or bool(self.control.feedback),
            sights=self.sights,
            eyes=self.eyes,
            truth=self.truth or self.true_state_in(world),
            knows_pose=known is not None and known.surroundings.needs_pose,
            gains=gains,
        )

    def place_on_legs(
        self, world: World
    ) -> tuple[SimulatedRobot, "PolicyWalk"]:
        """Place it on learned legs, with a guard against obstacles."""
        from ..locomotion.policy.policy_legs import PolicyWalk, load_legs

        legs = load_legs(self.legs, self.description, tick=world.physics.tick)
        known = self.clearance
        guard = known and known.velocity_guard(legs.velocities)
        return self.place(world, legs), PolicyWalk(legs, self.gait, guard)


def robot_with_strategy(
    world: World, setup: RobotSetup, strategy: Strategy
) -> RobotPlayer:
    """Place a robot in a world that contains it, with its controller."""
    strategy, tick = with_body_radius(strategy, setup), world.physics.tick
    if not setup.legs.walks:
        scheme = build_scheme(
            strategy,
            setup.description,
            setup.gait,
            setup.control,
            tick=tick,
            delay=setup.body.delay_cycles * tick,
            senses=setup.source,
            clearance=setup.clearance,
        )
        robot = setup.place(world, scheme.walk.kinematics)
        return RobotPlayer(robot, scheme, setup.start)
    robot, walk = setup.place_on_legs(world)
    source = setup.source or MeasuredSight()
    runner = StrategyRunner(
        strategy,
        setup.gait,
        setup.clearance and setup.clearance.surroundings,
        velocities=walk.velocities,
        views=source.views,
    )
    scheme = ControlScheme(runner, walk, source)
    return RobotPlayer(robot, scheme, setup.start)


def robot_at_velocities(world: World, setup: RobotSetup) -> VelocityWalker:
    """Place a robot that walks at velocities of another process."""
    tick = world.physics.tick
    walk: PolicyWalk | ManeuverWalk
    if setup.legs.walks:
        robot, walk = setup.place_on_legs(world)
    else:
        walk = build_walk(
            setup.description,
            setup.gait,
            setup.control,
            tick=tick,
            delay=setup.body.delay_cycles * tick,
            clearance=setup.clearance,
        )
        robot = setup.place(world, walk.kinematics)
    scheme = VelocityScheme(walk)
    return VelocityWalker(robot, scheme, setup.start, setup.description)


def with_body_radius(strategy: Strategy, setup: RobotSetup) -> Strategy:
    """Return a strategy whose body radius is at least that of the robot.

    One without an attribute ``body_radius`` is returned unchanged.
    """
    known = setup.clearance
    if known is None or not is_dataclass(strategy):
        return strategy
    radius = known.radius(setup.gait)
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
    periods = {load_policy(r.legs, r.description)[0].period for r in robots}
    if len(periods) != 1:
        return physics
    steps = periods.pop() / physics.time_step
    if round(steps) < 1 or abs(steps - round(steps)) > 1e-6:
        return physics
    return replace(physics, tick=round(steps) * physics.time_step)
