"""A simulated robot that walks by itself, as its servers see it."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple, Protocol

from ...poses import Pose
from ...sensing.images import ColourImage
from ...sensing.measurement import Sighting
from .body import Velocity


class WalkerState(NamedTuple):
    """What a simulated robot says of itself.

    Attributes:
        time: Simulated, in [s].
        pose: Of its own frame in its odometry.
        velocity: With which it is asked to walk.
        joints: Angles of its joints, in [rad].
        sighting: The other, from its own frame, if that is offered.
        image: Newest of its camera, if it has one.
    """

    time: float
    pose: Pose
    velocity: Velocity
    joints: Sequence[float]
    sighting: Sighting | None
    image: ColourImage | None = None


class WalkingRobot(Protocol):
    """A robot that walks by itself, of which servers tell."""

    def state(self) -> WalkerState:
        """What it says of itself now."""

    def look(self, angles: Mapping[str, float]) -> None:
        """Turn the head to angles of its joints, in [rad], by name."""
