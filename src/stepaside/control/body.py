"""What stands between control and a body, simulated or real."""

from typing import Protocol

from ..core.poses import Array
from ..perception.measurement import Measurement


class Body(Protocol):
    """A robot that control can move.

    Attributes:
        tick: Time from one control tick to the next, in [s].
    """

    tick: float

    def read(self) -> Measurement:
        """Read the sensors."""

    def write(self, joint_targets: Array) -> None:
        """Send joint targets, in [rad], to the servos. Shape (joints,)."""

    def step(self) -> None:
        """Let time pass until the next control tick."""

    def close(self) -> None:
        """Let go of the body."""
