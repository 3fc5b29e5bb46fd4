"""Standing a robot with its mind in a world."""

from dataclasses import is_dataclass, replace
from typing import TYPE_CHECKING

from ..arena import Room
from ..control.clearance.map_settings import MapSettings
from ..control.clearance.surroundings import (
    KnownRoom,
    MappedRoom,
    Surroundings,
)
from ..control.clearance.swept_outline import sway_of
from ..control.scheme_builder import ClearanceSetup, build_scheme
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
from .walker import Walker

if TYPE_CHECKING:
    from ..perception.perception import Perception
    from ..sim.sensor_suite import SensorSuite


def watch(
    world: World, name: str, description: RobotDescription, gait: GaitSettings
) -> TrueRobotState:
    """True state of a robot of a world, which walks with a gait."""
    return TrueRobotState(
        world.model,
        world.data,
        f"{name}/{description.torso}",
        com_forward=gait.zmp_forward,
        place=description.place,
    )


def stand_walker(
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
) -> Walker:
    """Stand one robot in a world, and give it a mind.

    Args:
        world: World that has the robot.
        name: Its name there.
        description: Its description.
        frame: Pose of its odometry in the world.
        strategy: From what it knows to what it wants.
        gait: How it walks.
        control: How it controls its walk.
        body: How far its body is from an ideal one.
        seed: Seed of its errors.
        sighting: What it knows of the other before it has seen anything.
        sight: Ideal sensor of the other, if it has one.
        eyes: Cameras and sonars, if it sees with those.
        perception: What turns its images into sightings, likewise.
        truth: Its true state, if somebody watches that already.
        clearance: What it knows of a room, and how clear it keeps.

    Raises:
        ReachError: If it cannot stand as the gait asks.
    """
    tick = world.physics.tick
    scheme = build_scheme(
        fitting(strategy, clearance, gait),
        description,
        gait,
        control,
        tick=tick,
        delay=body.delay_cycles * tick,
        sighting=sighting,
        perception=perception,
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
    return Walker(robot, scheme, frame)


def clearance_in(
    room: Room | None,
    known: MapSettings,
    description: RobotDescription,
    gait: GaitSettings,
    frame: Pose,
    perception: "Perception | None" = None,
) -> ClearanceSetup | None:
    """What a robot knows of the room that it plays in, if anything.

    Args:
        room: The room, if it plays in one.
        known: What it is to know.
        description: The robot.
        gait: How it walks.
        frame: Pose of its odometry in the room.
        perception: What keeps a map of the floor, if the room is seen.
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
    """A strategy that reckons with as much room as the body needs.

    Args:
        strategy: Any; who reckons with a body radius has an attribute of
            that name.
        clearance: How clear the body keeps.
        gait: How it walks: with each step it sways.
    """
    if clearance is None or not is_dataclass(strategy):
        return strategy
    needs = clearance.outline.radius + clearance.margin + sway_of(gait)
    if getattr(strategy, "body_radius", needs) >= needs:
        return strategy
    wider: Strategy = replace(strategy, body_radius=needs)
    return wider
