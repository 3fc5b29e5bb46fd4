"""Interface of a robot that follows velocity commands."""

from typing import NamedTuple, Protocol

from ...core.poses import Pose
from ...perception.measurement import Sighting


class VelocityCommand(NamedTuple):
    """Velocity command in the robot's frame.

    Attributes:
        forward: Driving velocity, in [m/s], negative backward.
        turn: Turning rate, in [rad/s], positive leftward.
        lateral: Lateral velocity, in [m/s], positive leftward; zero for a
            unicycle.
    """

    forward: float
    turn: float
    lateral: float = 0.0


REST = VelocityCommand(0.0, 0.0)


class VelocityReport(NamedTuple):
    """State of the robot at one instant.

    Attributes:
        time: Time on the robot's clock, in [s].
        pose: Pose of the robot in odometry.
        sighting: Newest sighting of the opponent, timed by the same clock,
            its bearing from the robot's heading then; None without one.
        hindrance: Reason why the robot must not move now; empty if it may.
    """

    time: float
    pose: Pose
    sighting: Sighting | None = None
    hindrance: str = ""


class VelocityBody(Protocol):
    """Connection to a robot that follows velocity commands."""

    def listen(self, patience: float) -> VelocityReport | None:
        """Return the newest report since the last call, or None.

        Args:
            patience: Longest time to wait for a report, in [s].

        Raises:
            SessionLost: If the connection has ended.
        """

    def command(self, velocity: VelocityCommand) -> None:
        """Send a velocity command.

        Raises:
            SessionLost: If the robot cannot be reached.
        """

    def close(self) -> None:
        """Stop the robot if it can be reached, and disconnect."""
