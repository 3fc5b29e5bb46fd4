"""Fake body whose joints reach their targets at once."""

import numpy as np

from stepaside.core.poses import Array
from stepaside.perception.measurement import RobotState, Sighting

GRAVITY = np.array([0.0, 0.0, 9.81])


class FakeBody:
    """Stands upright on both feet alike, whatever it is asked for.

    Attributes:
        tick: Control period, in [s].
        time: Time that has passed, in [s].
        joints: Where the joints are, in [rad]. Shape (joints,).
        distance: Of the other, straight ahead, in [m].
    """

    def __init__(self, joints: Array, weight: float, tick: float) -> None:
        """Be a robot of some weight, in [N]."""
        self.tick, self.joints, self.distance = tick, joints, 1.0
        self._ticks = 0
        self._forces = np.full(8, weight / 8)

    @property
    def time(self) -> float:
        """Time that has passed, in [s]."""
        return self._ticks * self.tick

    def read(self) -> RobotState:
        """Encoders are the targets, the IMU rests, both soles press."""
        return RobotState(
            self.time,
            self.joints.copy(),
            np.zeros(3),
            GRAVITY.copy(),
            self._forces.copy(),
            Sighting(self.time, 0.2, self.distance),
        )

    def write(self, joint_targets: Array) -> None:
        """Be there."""
        self.joints = joint_targets.copy()

    def step(self) -> None:
        """Let a tick pass."""
        self._ticks += 1

    def close(self) -> None:
        """Let go."""
