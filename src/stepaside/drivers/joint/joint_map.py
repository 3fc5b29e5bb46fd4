"""Motors of a robot as values, and the map from described joints."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.errors import ModelError
from ...core.poses import Array
from ...robots.description import RobotDescription


@dataclass(frozen=True, slots=True, eq=False)
class MotorTable:
    """Motors of a robot, in the order of its frames.

    Attributes:
        names: Names of the motors' joints.
        low: Minimum angles, in [rad]. Shape (motors,).
        high: Maximum angles, in [rad]. Shape (motors,).
        speed: Maximum speeds, in [rad/s]. Shape (motors,).
        stall_current: Stall currents, in [A]; inf where unknown.
            Shape (motors,).
        legs: Indices of the motors that carry the robot. Shape (legs,).
        crouch: Angles from which the robot can go limp, in [rad], by
            joint; other joints keep their targets.
        tick: Time from one frame to the next, in [s].
    """

    names: tuple[str, ...]
    low: Array
    high: Array
    speed: Array
    stall_current: Array
    legs: NDArray[np.intp]
    crouch: Mapping[str, float]
    tick: float

    @property
    def count(self) -> int:
        """Number of motors."""
        return len(self.names)


def motors_of(
    description: RobotDescription,
    *,
    tick: float,
    crouch: Mapping[str, float],
) -> MotorTable:
    """Return the motors of a described robot, one for each joint.

    Ranges are the description's working limits, and unlimited for joints
    without one. Stall currents are not described, hence infinite.

    Args:
        description: Description of the robot.
        tick: Time from one frame to the next, in [s].
        crouch: Angles from which the robot can go limp, in [rad], by
            joint; those of its natural stance if it has no lower one.
    """
    names = tuple(description.speed_limits)
    free = (-np.inf, np.inf)
    ranges = [description.working_limits.get(name, free) for name in names]
    return MotorTable(
        names,
        low=np.array([low for low, _ in ranges]),
        high=np.array([high for _, high in ranges]),
        speed=np.array(list(description.speed_limits.values())),
        stall_current=np.full(len(names), np.inf),
        # Legs may share a motor: such a joint has no speed limit.
        legs=np.array(
            [names.index(leg) for leg in description.legs if leg in names]
        ),
        crouch=crouch,
        tick=tick,
    )


class JointMap:
    """Map between the joints of a description and the motors of a robot.

    Axes and signs must be the same; order and number may differ.
    """

    def __init__(self, names: Sequence[str], motors: MotorTable) -> None:
        """Find the motor of each joint.

        Args:
            names: Actuated joints, in the order of the joint targets.
            motors: Motors of the robot.

        Raises:
            ModelError: If a joint has no motor, or is named twice.
        """
        for name in names:
            if name not in motors.names:
                raise ModelError(
                    f"joint {name!r} has no motor; there are "
                    f"{', '.join(motors.names)}"
                )
        if len(set(names)) != len(names):
            raise ModelError(f"joints must differ, got {', '.join(names)}")
        self._indices = np.array([motors.names.index(name) for name in names])

    def from_motors(self, values: Array) -> Array:
        """Pick the description's joints. (motors,) to (joints,)."""
        picked: Array = values[self._indices]
        return picked

    def to_motors(self, values: Array, others: Array) -> Array:
        """Spread values of the description's joints over all motors.

        Args:
            values: Value of each described joint. Shape (joints,).
            others: Values of motors without such a joint. Shape (motors,).

        Returns:
            Value of each motor. Shape (motors,).
        """
        spread = np.array(others, dtype=np.float64)
        spread[self._indices] = values
        return spread
