"""Construction of a simulated robot with its controller."""

from dataclasses import is_dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

from ..arena import Room
from ..control.clearance.map_settings import MapSettings
from ..control.clearance.surroundings import (
    KnownRoom,
    MappedRoom,
    Surroundings,
)
from ..control.clearance.swept_outline import lateral_sway
from ..control.scheme_builder import ClearanceSetup, build_scheme
from ..control.sight_sources import (
    CameraSight,
    LidarSight,
    MeasuredSight,
    SightOfPlayers,
    SightSource,
)
from ..core.player_identity import PlayerIdentity
from ..core.poses import Pose
from ..core.random_streams import named_generator
from ..locomotion.zmp.control_settings import ControlSettings
from ..perception.lidar_perception import LidarPerception
from ..perception.measurement import Sighting
from ..planning import GaitSettings
from ..robots.description import RobotDescription
from ..robots.leg_kinematics import LegKinematics
from ..sim.body_settings import BodySettings
from ..sim.ground_truth import TrueRobotState
from ..sim.ideal_sensors import IdealLineOfSight
from ..sim.outline_measurement import measure_outline
from ..sim.simulated_robot import SensorSetup, SimulatedRobot
from ..sim.world import World
from ..strategies import Strategy
from .walker import SimulatedPlayer

if TYPE_CHECKING:
    from ..perception.perception import Perception
    from ..sim.lidar import Lidar
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


class PlayerSensing(NamedTuple):
    """Ideal sensing of all other players by one robot.

    Attributes:
        identity: Identity of the robot.
        target: Name of its target; empty for the nearest opponent.
        sights: Ideal sensors, one for each other player.
    """

    identity: PlayerIdentity
    target: str
    sights: tuple[IdealLineOfSight, ...]


class CameraSensing(NamedTuple):
    """Sensing of one robot by cameras or a lidar.

    Attributes:
        eyes: Cameras and sonars, or the lidar.
        perception: Perception of their images, or of its scans.
    """

    eyes: "SensorSuite | Lidar"
    perception: "Perception | LidarPerception"


def place_walker(
    world: World,
    setup: WalkerSetup,
    strategy: Strategy,
    *,
    sighting: Sighting | None = None,
    sight: PlayerSensing | None = None,
    cameras: CameraSensing | None = None,
    truth: TrueRobotState | None = None,
    clearance: ClearanceSetup | None = None,
) -> SimulatedPlayer:
    """Place one robot in a world and build its controller.

    Args:
        world: World that contains the robot.
        setup: The robot.
        strategy: Strategy of the player.
        sighting: Sighting before the first measurement, if known.
        sight: Ideal sensing of all other players, if it senses so.
        cameras: Cameras and perception, with camera sensing.
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
        senses=sight_source(sight, cameras, sighting, tick=tick),
        clearance=clearance,
    )
    robot = place_robot(
        world,
        setup,
        scheme.kinematics,
        sight=sight,
        eyes=None if cameras is None else cameras.eyes,
        truth=truth,
        clearance=clearance,
    )
    return SimulatedPlayer(robot, scheme, setup.odometry_in_world)


def place_robot(
    world: World,
    setup: WalkerSetup,
    kinematics: LegKinematics,
    *,
    sight: PlayerSensing | None = None,
    eyes: "SensorSuite | Lidar | None" = None,
    truth: TrueRobotState | None = None,
    clearance: ClearanceSetup | None = None,
) -> SimulatedRobot:
    """Place one robot without a controller in a world.

    Args:
        world: World that contains the robot.
        setup: The robot.
        kinematics: Kinematics in the standing posture.
        sight: Ideal sensing of all other players, if it senses so.
        eyes: Cameras and sonars, with camera sensing.
        truth: True state of the robot, if it exists already.
        clearance: Knowledge of the room; a robot that knows the room also
            knows its pose in it.
    """
    return SimulatedRobot(
        world,
        setup.name,
        setup.description,
        kinematics,
        setup.odometry_in_world,
        setup.body,
        SensorSetup(
            generator=named_generator(setup.seed, f"sensors/{setup.name}"),
            averages_imu=setup.control.feedback,
            sights=() if sight is None else sight.sights,
            eyes=eyes,
            truth=truth or setup.true_state_in(world),
            knows_pose=clearance is not None
            and isinstance(clearance.surroundings, KnownRoom),
        ),
    )


def sight_source(
    sight: PlayerSensing | None,
    cameras: CameraSensing | None,
    sighting: Sighting | None = None,
    *,
    tick: float,
) -> SightSource:
    """Return the source of sightings for the sensors of a robot.

    Args:
        sight: Ideal sensing of all other players, if it senses so.
        cameras: Cameras and perception, with camera sensing.
        sighting: Sighting before the first measurement, if known.
        tick: Control period, in [s].
    """
    if cameras is not None:
        perception = cameras.perception
        if isinstance(perception, LidarPerception):
            return LidarSight(perception, tick=tick)
        return CameraSight(perception, tick=tick)
    if sight is not None:
        return SightOfPlayers(sight.identity, sight.target)
    return MeasuredSight(sighting)


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
