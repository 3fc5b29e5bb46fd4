"""Construction of a simulated robot with its controller."""

from dataclasses import is_dataclass, replace
from typing import TYPE_CHECKING

from ..arena import Room
from ..control.clearance.map_settings import MapSettings
from ..control.clearance.surroundings import (
    KnownRoom,
    MappedRoom,
    Surroundings,
)
from ..control.clearance.swept_outline import lateral_sway
from ..control.scheme_builder import ClearanceSetup, build_scheme
from ..control.sight_sources import CameraSight, MeasuredSight
from ..core.poses import Pose
from ..core.random_streams import named_generator
from ..locomotion.zmp.control_settings import ControlSettings
from ..perception.measurement import Sighting
from ..planning import GaitSettings
from ..robots.description import RobotDescription
from ..sim.body_settings import BodySettings
from ..sim.ground_truth import TrueRobotState
from ..sim.ideal_sensors import IdealLineOfSight
from ..sim.outline_measurement import measure_outline
from ..sim.simulated_robot import SimulatedRobot
from ..sim.world import World
from ..strategies import Strategy
from .walker import SimulatedPlayer

if TYPE_CHECKING:
    from ..perception.perception import Perception
    from ..sim.sensor_suite import SensorSuite


def watch(
    world: World, name: str, description: RobotDescription, gait: GaitSettings
) -> TrueRobotState:
    """Return the true state of a robot of a world."""
    return TrueRobotState(
        world.model,
        world.data,
        f"{name}/{description.torso}",
        com_forward=gait.zmp_forward,
        place=description.place,
    )


def place_walker(
    world: World,
    name: str,
    description: RobotDescription,
    frame: Pose,
    strategy: Strategy,
    *,
    gait: GaitSettings,
    control: ControlSettings,
    body: BodySettings,
    seed: int,
    sighting: Sighting | None = None,
    sight: IdealLineOfSight | None = None,
    eyes: "SensorSuite | None" = None,
    perception: "Perception | None" = None,
    truth: TrueRobotState | None = None,
    clearance: ClearanceSetup | None = None,
) -> SimulatedPlayer:
    """Place one robot in a world and build its controller.

    Args:
        world: World that contains the robot.
        name: Name of the robot in the world.
        description: Description of the robot.
        frame: Pose of its odometry in the world.
        strategy: Strategy of the player.
        gait: Gait settings.
        control: Control settings.
        body: Deviations of the body from an ideal one.
        seed: Seed of sensor errors.
        sighting: Sighting before the first measurement, if known.
        sight: Ideal sensor of the opponent, with ideal sensing.
        eyes: Cameras and sonars, with camera sensing.
        perception: Perception of their images, with camera sensing.
        truth: True state of the robot, if it exists already.
        clearance: Knowledge of the room and required clearance.

    Raises:
        ReachError: If the legs cannot reach the initial stance of the gait.
    """
    tick = world.physics.tick
    scheme = build_scheme(
        fitting(strategy, clearance, gait),
        description,
        gait,
        control,
        tick=tick,
        delay=body.delay_cycles * tick,
        senses=MeasuredSight(sighting)
        if perception is None
        else CameraSight(perception, tick=tick),
        clearance=clearance,
    )
    robot = SimulatedRobot(
        world,
        name,
        description,
        scheme.kinematics,
        frame,
        body,
        named_generator(seed, f"sensors/{name}"),
        sight=sight,
        eyes=eyes,
        averages_imu=control.feedback,
        truth=truth or watch(world, name, description, gait),
        knows_place=clearance is not None
        and isinstance(clearance.surroundings, KnownRoom),
    )
    return SimulatedPlayer(robot, scheme, frame)


def clearance_in(
    room: Room | None,
    known: MapSettings,
    description: RobotDescription,
    gait: GaitSettings,
    frame: Pose,
    perception: "Perception | None" = None,
) -> ClearanceSetup | None:
    """Return the knowledge that a robot has of its room.

    Args:
        room: Room of the game; None on an open floor.
        known: Settings of the map.
        description: Description of the robot.
        gait: Gait settings.
        frame: Pose of its odometry in the room.
        perception: Perception with a map of the floor, if the robot maps the
            room.

    Returns:
        Surroundings and required clearance; None without knowledge.
    """
    if room is None or known.source == "none":
        return None
    surroundings: Surroundings = KnownRoom(room, frame)
    if known.source == "seen":
        assert perception is not None and perception.floor is not None
        surroundings = MappedRoom(
            perception.floor, unseen_is_free=known.unseen == "free"
        )
    outline = measure_outline(description, gait)
    return ClearanceSetup(surroundings, outline, known.margin)


def fitting(
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
