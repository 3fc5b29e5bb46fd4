"""Construction of a simulated robot with its controller."""

from dataclasses import is_dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

from ..arena import Room
from ..control.scheme_builder import ClearanceSetup, build_scheme
from ..control.sight_sources import SightSource
from ..core.poses import Pose
from ..core.random_streams import named_generator
from ..locomotion.control_settings import ControlSettings, MapSettings
from ..locomotion.surroundings import (
    KnownRoom,
    MappedRoom,
    Surroundings,
)
from ..locomotion.swept_outline import lateral_sway
from ..planning import GaitSettings
from ..robots.description import RobotDescription
from ..robots.leg_kinematics import LegKinematics
from ..sim.body_errors import JointGains
from ..sim.body_settings import BodySettings
from ..sim.ground_truth import IdealLineOfSight, TrueRobotState
from ..sim.outline_measurement import measure_outline
from ..sim.simulated_robot import SensorSetup, SimulatedRobot
from ..sim.world import World
from ..strategies import Strategy
from .walker import SimulatedPlayer

if TYPE_CHECKING:
    from ..locomotion.policy.policy_legs import InitialPosture
    from ..perception.pipeline import Perception
    from ..sim.ranging import Lidar
    from ..sim.sensor_suite import SensorSuite


class WalkerSetup(NamedTuple):
    """Robot of a game before it stands in the world.

    Attributes:
        name: Name of the robot in the world.
        description: Description of the robot.
        gait: Gait settings.
        control: Control settings.
        body: Deviations of the body from an ideal one.
        odometry_in_world: Initial pose of its odometry in the world.
        seed: Seed of sensor errors.
    """

    name: str
    description: RobotDescription
    gait: GaitSettings
    control: ControlSettings
    body: BodySettings
    odometry_in_world: Pose
    seed: int

    def true_state_in(self, world: World) -> TrueRobotState:
        """Return the true state of the robot in a world that contains it."""
        return TrueRobotState(
            world.model,
            world.data,
            f"{self.name}/{self.description.torso}",
            com_forward=self.gait.zmp_forward,
            place=self.description.place,
        )


class RobotSensing(NamedTuple):
    """Senses of one robot for other players.

    Attributes:
        source: Source of sightings for its controller.
        sights: Ideal sensors, one for each other player.
        eyes: Cameras, or the lidar.
    """

    source: SightSource
    sights: tuple[IdealLineOfSight, ...] = ()
    eyes: "SensorSuite | Lidar | None" = None


def place_walker(
    world: World,
    setup: WalkerSetup,
    strategy: Strategy,
    *,
    sensing: RobotSensing | None = None,
    truth: TrueRobotState | None = None,
    clearance: ClearanceSetup | None = None,
) -> SimulatedPlayer:
    """Place one robot in a world and build its controller.

    Args:
        world: World that contains the robot.
        setup: The robot.
        strategy: Strategy of the player.
        sensing: Its senses; by default it senses no other player.
        truth: True state of the robot, if it exists already.
        clearance: Knowledge of the room and required clearance.

    Raises:
        ReachError: If the legs cannot reach the initial stance of the gait.
    """
    tick = world.physics.tick
    scheme = build_scheme(
        with_body_radius(strategy, clearance, setup.gait),
        setup.description,
        setup.gait,
        setup.control,
        tick=tick,
        delay=setup.body.delay_cycles * tick,
        senses=None if sensing is None else sensing.source,
        clearance=clearance,
    )
    robot = place_robot(
        world,
        setup,
        scheme.kinematics,
        sensing=sensing,
        truth=truth,
        clearance=clearance,
    )
    return SimulatedPlayer(robot, scheme, setup.odometry_in_world)


def place_robot(
    world: World,
    setup: WalkerSetup,
    standing: "LegKinematics | InitialPosture",
    *,
    sensing: RobotSensing | None = None,
    truth: TrueRobotState | None = None,
    clearance: ClearanceSetup | None = None,
    gains: JointGains | None = None,
) -> SimulatedRobot:
    """Place one robot without a controller in a world.

    Args:
        world: World that contains the robot.
        setup: The robot.
        standing: Kinematics in the standing posture, or the posture.
        sensing: Its senses; by default it senses no other player.
        truth: True state of the robot, if it exists already.
        clearance: Knowledge of the room; a robot that knows the room also
            knows its pose in it.
        gains: Gains of a robot that is driven by joint torques.
    """
    return SimulatedRobot(
        world,
        setup.name,
        setup.description,
        standing,
        setup.odometry_in_world,
        setup.body,
        SensorSetup(
            generator=named_generator(setup.seed, f"sensors/{setup.name}"),
            integrates_imu=gains is not None or bool(setup.control.feedback),
            sights=() if sensing is None else sensing.sights,
            eyes=None if sensing is None else sensing.eyes,
            truth=truth or setup.true_state_in(world),
            knows_pose=clearance is not None
            and isinstance(clearance.surroundings, KnownRoom),
        ),
        gains=gains,
    )


def clearance_in(
    room: Room | None,
    known: MapSettings,
    setup: WalkerSetup,
    perception: "Perception | None" = None,
) -> ClearanceSetup | None:
    """Return the knowledge that a robot has of its room.

    Args:
        room: Room of the game; None on an open floor.
        known: Settings of the map.
        setup: The robot; the room is in the world.
        perception: Perception with a map of the floor, if the robot maps the
            room.

    Returns:
        Surroundings and required clearance; None without knowledge.
    """
    if room is None or known.source == "none":
        return None
    surroundings: Surroundings = KnownRoom(room, setup.odometry_in_world)
    if known.source == "seen":
        assert perception is not None and perception.floor is not None
        surroundings = MappedRoom(
            perception.floor, unknown_is_free=known.unseen == "free"
        )
    outline = measure_outline(setup.description, setup.gait)
    return ClearanceSetup(surroundings, outline, known.margin)


def with_body_radius(
    strategy: Strategy, clearance: ClearanceSetup | None, gait: GaitSettings
) -> Strategy:
    """Return a strategy whose body radius is at least that of the robot.

    Args:
        strategy: Strategy; one without an attribute ``body_radius`` is
            returned unchanged.
        clearance: Outline and required clearance of the robot.
        gait: Gait settings, which determine the sway of a step.
    """
    if clearance is None or not is_dataclass(strategy):
        return strategy
    radius = clearance.outline.radius + clearance.margin + lateral_sway(gait)
    if getattr(strategy, "body_radius", radius) >= radius:
        return strategy
    enlarged: Strategy = replace(strategy, body_radius=radius)
    return enlarged
