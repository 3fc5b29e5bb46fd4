"""Interface between a simulated robot with walking control and servers."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple, Protocol

from ...core.poses import Pose
from ...perception.images import ColourImage
from ...perception.measurement import Sighting
from ...planning import Foot
from .footstep_commands import FootCommand
from .velocity_body import VelocityCommand

STANDING = (Pose(0.0, 0.0, 0.0), Pose(0.0, 0.0, 0.0))


class TorsoInFootprint(NamedTuple):
    """Pose of the torso from the point on the floor that stands for a robot.

    Attributes:
        position: Position of the frame of the torso, in [m].
        angles: Roll, pitch and yaw, in [rad].
    """

    position: tuple[float, float, float]
    angles: tuple[float, float, float]


class WalkerState(NamedTuple):
    """State of a simulated robot at one instant.

    Attributes:
        time: Simulated time, in [s].
        pose: Pose of the robot in its odometry.
        velocity: Commanded velocity.
        joints: Joint angles, in [rad].
        sighting: Ideal sighting of the opponent, if it is offered.
        image: Newest image of the camera, if there is one.
        feet: Last stance poses of the left and right foot, in odometry.
        step: Current step, with the time left until landing; None when
            standing.
        steps: Number of steps begun, without those that end a walk.
        echoes: Newest distances of the sonars, in [m], by name.
        torso: Pose of the torso by encoders and tilt; None if unknown.
    """

    time: float
    pose: Pose
    velocity: VelocityCommand
    joints: Sequence[float]
    sighting: Sighting | None
    image: ColourImage | None = None
    feet: tuple[Pose, Pose] = STANDING
    step: FootCommand | None = None
    steps: int = 0
    echoes: Mapping[str, float | None] = MappingProxyType({})
    torso: TorsoInFootprint | None = None


class WalkingRobot(Protocol):
    """Simulated robot that follows velocity or footstep commands."""

    def state(self) -> WalkerState:
        """Return the state now."""

    def command(self, velocity: VelocityCommand) -> None:
        """Walk at a velocity from now on."""

    def look(self, angles: Mapping[str, float]) -> None:
        """Command the angles of the head joints, in [rad], by name."""

    def lead_with(self, foot: Foot) -> None:
        """Set the foot of the first step of the next walk."""
