"""Interface between control and a body, simulated or real."""

from typing import Protocol

from ..core.poses import Array
from ..perception.measurement import RobotState


class Body(Protocol):
    """Interface to the joints and sensors of one robot.

    Attributes:
        tick: Control period, in [s].
    """

    tick: float

    def read(self) -> RobotState:
        """Read the sensors."""

    def write(self, joint_targets: Array) -> None:
        """Send joint targets, in [rad], to the servos. Shape (joints,)."""

    def step(self) -> None:
        """Advance to the next control tick."""

    def close(self) -> None:
        """Release the body and its connection."""
