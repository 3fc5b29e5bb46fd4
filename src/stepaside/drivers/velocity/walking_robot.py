"""A simulated robot that walks by itself, as its servers see it."""

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


class WalkerState(NamedTuple):
    """What a simulated robot says of itself.

    Attributes:
        time: Simulated, in [s].
        pose: Of its own frame in its odometry.
        velocity: With which it is asked to walk.
        joints: Angles of its joints, in [rad].
        sighting: The other, from its own frame, if that is offered.
        image: Newest of its camera, if it has one.
        feet: Left and right foot where they last stood, in its odometry.
        step: Being made, its time what is left of it; None if it stands.
        steps: Begun so far, but for those that came to rest.
        echoes: Distances that its sonars heard last, in [m], by name.
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


class WalkingRobot(Protocol):
    """A robot that walks by itself, of which servers tell."""

    def state(self) -> WalkerState:
        """What it says of itself now."""

    def look(self, angles: Mapping[str, float]) -> None:
        """Turn the head to angles of its joints, in [rad], by name."""

    def lead_with(self, foot: Foot) -> None:
        """Make the next first step with a foot, if the robot stands."""
