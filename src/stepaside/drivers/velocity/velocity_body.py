"""A robot that walks by itself: velocities in, odometry and sight out."""

from typing import NamedTuple, Protocol

from ...core.poses import Pose
from ...perception.measurement import Sighting


class VelocityCommand(NamedTuple):
    """What a unicycle is told.

    Attributes:
        forward: Driving velocity, in [m/s], negative backward.
        turn: Turning rate, in [rad/s], positive leftward.
    """

    forward: float
    turn: float


REST = VelocityCommand(0.0, 0.0)


class VelocityReport(NamedTuple):
    """What such a robot says of itself at one instant.

    Attributes:
        time: The instant on the robot's clock, in [s].
        pose: Where it is by its odometry.
        sighting: The other, seen at a time of the same clock, its bearing
            from the heading of the odometry then; None if nobody was seen.
        hindrance: Why it must not move now, if it says so itself.
    """

    time: float
    pose: Pose
    sighting: Sighting | None = None
    hindrance: str = ""


class VelocityBody(Protocol):
    """A robot at the other end of a line that carries velocities."""

    def listen(self, patience: float) -> VelocityReport | None:
        """Newest report since the last; None if none comes in time.

        Args:
            patience: Longest time to wait for it, in [s].

        Raises:
            SessionLost: If there will be none any more.
        """

    def command(self, velocity: VelocityCommand) -> None:
        """Ask for a velocity.

        Raises:
            SessionLost: If the robot cannot be reached.
        """

    def close(self) -> None:
        """Let the robot stand, as far as it can be reached, and go."""
