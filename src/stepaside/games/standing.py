"""Standing a robot with its mind in a world."""

from typing import TYPE_CHECKING

from ..control.assembly import build_scheme
from ..control.balance.settings import ControlSettings
from ..planning import GaitSettings
from ..poses import Pose
from ..randomness import named_generator
from ..robots.description import RobotDescription
from ..sensing.measurement import Sighting
from ..strategies import Strategy
from ..world.body_settings import BodySettings
from ..world.robot import SimulatedRobot
from ..world.sight import IdealLineOfSight
from ..world.world import World
from .walker import Walker

if TYPE_CHECKING:
    from ..perception.perception import Perception
    from ..world.eyes import Eyes


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
    eyes: "Eyes | None" = None,
    perception: "Perception | None" = None,
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

    Raises:
        ReachError: If it cannot stand as the gait asks.
    """
    tick = world.physics.tick
    scheme = build_scheme(
        strategy,
        description,
        gait,
        control,
        tick=tick,
        delay=body.delay_cycles * tick,
        sighting=sighting,
        perception=perception,
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
        com_forward=gait.zmp_forward,
    )
    return Walker(robot, scheme, frame)
