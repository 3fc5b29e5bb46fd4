"""Player that is a simulated robot on learned legs."""

from collections.abc import Sequence
from dataclasses import replace

from ..control.scheme import ControlScheme
from ..control.scheme_builder import ClearanceSetup
from ..control.strategy_runner import StrategyRunner
from ..core.errors import PolicyError
from ..core.poses import Pose
from ..locomotion.control_settings import LegsSettings
from ..locomotion.guard import VelocityGuard
from ..locomotion.policy.policy_legs import PolicyLegs, load_legs, load_policy
from ..locomotion.policy.policy_walk import PolicyWalk
from ..locomotion.surroundings import Surroundings
from ..robots.description import RobotDescription
from ..sim.body_settings import BodySettings
from ..sim.ground_truth import TrueRobotState
from ..sim.physics_settings import PhysicsSettings
from ..sim.simulated_robot import SimulatedRobot
from ..sim.world import World
from ..strategies import Strategy
from .walker import RobotPlayer
from .walker_factory import (
    RobotSensing,
    WalkerSetup,
    place_robot,
    with_body_radius,
)

AT_ONCE = 1.0  # a fall until then is one of the policy, in [s]


class PolicyPlayer(RobotPlayer):
    """Simulated robot that walks by a policy."""

    def __init__(
        self,
        robot: SimulatedRobot,
        scheme: ControlScheme,
        frame: Pose,
        surroundings: Surroundings,
    ) -> None:
        """Combine a robot and its controller.

        Args:
            robot: Simulated robot.
            scheme: Its controller.
            frame: Pose of its odometry in the world.
            surroundings: Known obstacles.
        """
        super().__init__(robot, scheme, frame)
        self._surroundings = surroundings
        robot.world.measures_always = True
        # Exact sightings are read when a decision is due.
        self._sees_rarely = robot.sees_exactly

    def tick(self) -> None:
        """Read the sensors and decide."""
        robot, walk = self.robot, self.scheme.locomotion
        assert isinstance(walk, PolicyWalk)
        sees = not self._sees_rarely or walk.decides(robot.world.time)
        measured = robot.read(sees=sees)
        self._surroundings.note(measured, walk.pose)
        robot.write(self.scheme.update(measured))

    @property
    def has_fallen(self) -> bool:
        """Whether it has fallen.

        Raises:
            PolicyError: If it fell before it could walk.
        """
        now, fallen = self.robot.world.time, self.truth.has_fallen
        if fallen and now <= AT_ONCE:
            raise PolicyError(
                f"legs: {self.name} fell at {now:.2f} s, while it was to "
                "stand: the contract does not fit the network"
            )
        return fallen


def policy_physics(
    physics: PhysicsSettings,
    body: BodySettings,
    walkers: Sequence[tuple[LegsSettings, RobotDescription]],
) -> PhysicsSettings:
    """Return physics settings whose tick is the period of the policies.

    With an ideal body nothing happens between two evaluations of a policy:
    the actuators apply its gains at every time step.

    Args:
        physics: Settings of the physics.
        body: Settings of the body; one with delays or sensor errors keeps
            its tick.
        walkers: Policy and robot of each player.

    Raises:
        PolicyError: If a network cannot run on its robot.
    """
    if body.has_sensor_errors or not body.has_ideal_servos:
        return physics
    periods = {load_policy(*each)[0].period for each in walkers}
    if len(periods) != 1:
        return physics
    steps = periods.pop() / physics.time_step
    if round(steps) < 1 or abs(steps - round(steps)) > 1e-6:
        return physics
    return replace(physics, tick=round(steps) * physics.time_step)


def place_on_legs(
    world: World,
    setup: WalkerSetup,
    legs: PolicyLegs,
    *,
    sensing: RobotSensing | None = None,
    truth: TrueRobotState | None = None,
    clearance: ClearanceSetup | None = None,
) -> SimulatedRobot:
    """Place a robot in a world, driven by the torques of its policy.

    Args:
        world: World that contains the robot.
        setup: Robot with its settings.
        legs: Learned legs of the robot.
        sensing: Its senses; by default it senses no other player.
        truth: True state of the robot, if it exists already.
        clearance: Knowledge of the room, if any.
    """
    contract = legs.contract
    gains = zip(contract.stiffness, contract.damping, strict=True)
    return place_robot(
        world,
        setup,
        legs.standing,
        sensing=sensing,
        truth=truth,
        clearance=clearance,
        gains=dict(zip(contract.joints, gains, strict=True)),
    )


def velocity_guard(
    legs: PolicyLegs, clearance: ClearanceSetup | None
) -> tuple[Surroundings, VelocityGuard | None]:
    """Return known obstacles, and a guard of learned legs against them.

    Args:
        legs: Learned legs of the robot.
        clearance: Knowledge of the room and required clearance, if any.
    """
    if clearance is None:
        return Surroundings(), None
    distance = clearance.outline.radius + clearance.margin
    around = clearance.surroundings
    return around, VelocityGuard(around, legs.velocities, distance)


def place_policy_player(
    world: World,
    setup: WalkerSetup,
    legs: LegsSettings,
    strategy: Strategy,
    *,
    sensing: RobotSensing,
    truth: TrueRobotState,
    clearance: ClearanceSetup | None = None,
) -> PolicyPlayer:
    """Place one robot on learned legs in a world, with its controller.

    Args:
        world: World that contains the robot.
        setup: Robot with its settings; the gait has speed, steering gain and
            decision interval of its template.
        legs: Walking policy.
        strategy: Strategy of the player.
        sensing: Its senses.
        truth: True state of the robot.
        clearance: Knowledge of the room and required clearance.

    Raises:
        PolicyError: If the network cannot run on the robot.
    """
    tick = world.physics.tick
    policy = load_legs(legs, setup.description, tick=tick)
    robot = place_on_legs(
        world,
        setup,
        policy,
        sensing=sensing,
        truth=truth,
        clearance=clearance,
    )
    frame = setup.odometry_in_world
    around, guard = velocity_guard(policy, clearance)
    scheme = ControlScheme(
        StrategyRunner(
            with_body_radius(strategy, clearance, setup.gait),
            setup.gait,
            around,
            velocities=policy.velocities,
            views=sensing.source.views,
        ),
        PolicyWalk(policy, setup.gait, guard),
        sensing.source,
    )
    return PolicyPlayer(robot, scheme, frame, around)
