"""Interface between a simulated robot with walking control and its server."""

from collections.abc import Sequence
from typing import NamedTuple, Protocol

from ..core.poses import Pose
from ..perception.images import ColourImage
from ..perception.measurement import Sighting
from ..strategies.velocity_set import BodyVelocity


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
        torso: Pose of the torso by encoders and tilt; None if unknown.
    """

    time: float
    pose: Pose
    velocity: BodyVelocity
    joints: Sequence[float]
    sighting: Sighting | None
    image: ColourImage | None = None
    torso: TorsoInFootprint | None = None


class WalkingRobot(Protocol):
    """Simulated robot that follows velocity commands."""

    def state(self) -> WalkerState:
        """Return the state now."""

    def command(self, velocity: BodyVelocity) -> None:
        """Walk at a velocity from now on."""
