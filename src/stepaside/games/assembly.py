"""Putting a robot together: body, kinematics, estimator and control."""

from dataclasses import replace
from typing import TYPE_CHECKING

from ..control import ControlScheme
from ..control.balance.estimation import StateEstimator
from ..control.balance.settings import ControlSettings
from ..control.balance.stabiliser import Stabiliser
from ..planning import GaitSettings
from ..poses import Pose
from ..randomness import named_generator
from ..robots.description import RobotDescription
from ..robots.forward import ForwardKinematics
from ..robots.kinematics import LegKinematics
from ..sensing.measurement import Sighting
from ..strategies.roles import Role
from ..world.body_settings import BodySettings
from ..world.robot import SimulatedRobot
from ..world.settings import PhysicsSettings
from ..world.world import World

if TYPE_CHECKING:
    from ..perception.perception import Perception


def with_cycle(
    physics: PhysicsSettings, body: BodySettings
) -> PhysicsSettings:
    """Physics with the control period that a body asks for.

    Raises:
        ConfigurationError: If the period is no multiple of the time step.
    """
    return replace(physics, tick=body.cycle) if body.cycle > 0.0 else physics


def assemble(
    world: World,
    name: str,
    description: RobotDescription,
    frame: Pose,
    role: Role,
    *,
    gait: GaitSettings,
    control: ControlSettings,
    body: BodySettings,
    seed: int,
    sighting: Sighting | None = None,
    perception: "Perception | None" = None,
) -> tuple[SimulatedRobot, ControlScheme]:
    """Stand one robot in a world, and give it a mind.

    Args:
        world: World that has the robot.
        name: Its name there.
        description: Its description.
        frame: Pose of its odometry in the world.
        role: What it wants.
        gait: How it walks.
        control: How it controls its walk.
        body: How far its body is from an ideal one.
        seed: Seed of its errors.
        sighting: What it knows of the other before it has seen anything.
        perception: What turns its images into sightings, if it has eyes.
    """
    tick = world.physics.tick
    kinematics = LegKinematics(description, tick=tick)
    stabiliser = None
    if control.feedback:
        forward = ForwardKinematics(description)
        estimator = StateEstimator(
            forward, forward.force_sensors(), gait.eta, tick
        )
        stabiliser = Stabiliser(
            control,
            estimator,
            gait,
            tick=tick,
            delay=body.delay_cycles * tick,
        )
    scheme = ControlScheme(
        role,
        gait,
        kinematics,
        tick=tick,
        sighting=sighting,
        stabiliser=stabiliser,
        perception=perception,
    )
    robot = SimulatedRobot(
        world,
        name,
        description,
        kinematics,
        frame,
        body,
        named_generator(seed, f"sensors/{name}"),
    )
    if control.feedback:
        robot.average_imu()
    return robot, scheme
