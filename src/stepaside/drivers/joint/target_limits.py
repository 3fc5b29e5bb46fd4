"""Limits of joint targets and stiffness: range, speed, temperature."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...core.poses import Array
from .joint_map import MotorTable

MARGIN = 0.01  # distance from the ends of each range, in [rad]
WARM, HOT = 70.0, 85.0  # range of the reduction, in [degC]; an assumption
MIN_STIFFNESS = 0.5  # fraction of the stiffness that a hot joint keeps


class TargetLimiter:
    """Limiter of joint targets to range and speed.

    Attributes:
        target: Newest targets, in [rad]. Shape (motors,).
    """

    def __init__(self, start: Array, motors: MotorTable) -> None:
        """Start at measured angles, so that no joint jumps.

        Args:
            start: Measured angles, in [rad]. Shape (motors,).
            motors: Motors, with their ranges and speeds.
        """
        self.target = np.array(start, dtype=np.float64)
        self._motors = motors

    def toward(self, wanted: Array, speed: float | None = None) -> Array:
        """Move the targets toward wanted ones within the speed limits.

        A joint that was measured outside its range returns into it.

        Args:
            wanted: Wanted targets, in [rad]; NaN and inf are ignored.
            speed: Additional speed limit of all joints, in [rad/s]; only
                that of each motor by default.

        Returns:
            New targets, in [rad]. Shape (motors,).
        """
        goal = np.where(np.isfinite(wanted), wanted, self.target)
        motors = self._motors
        goal = np.clip(goal, motors.low + MARGIN, motors.high - MARGIN)
        limit = (
            motors.speed if speed is None else np.minimum(motors.speed, speed)
        )
        reach = limit * motors.tick
        step = np.clip(goal - self.target, -reach, reach)
        self.target = self.target + step
        return self.target

    def follow(self, wanted: Array) -> Array:
        """Set the targets without limits, for soft joints.

        Args:
            wanted: Wanted targets, in [rad]; NaN and inf are ignored.

        Returns:
            New targets, in [rad]. Shape (motors,).
        """
        self.target = np.where(np.isfinite(wanted), wanted, self.target)
        return self.target


def derate_stiffness(
    stiffness: Array, temperature: Array, status: Sequence[int]
) -> Array:
    """Reduce the stiffness of hot joints.

    Args:
        stiffness: Wanted stiffness, from 0 to 1. Shape (motors,).
        temperature: Motor temperatures, in [degC]. Shape (motors,).
        status: Status of the motors, 3 if critical.

    Returns:
        Reduced stiffness. Shape (motors,).
    """
    cut = (temperature - WARM) / (HOT - WARM) * (1.0 - MIN_STIFFNESS)
    factor = np.clip(1.0 - cut, MIN_STIFFNESS, 1.0)
    factor[np.array(status) >= 3] = 0.0
    return stiffness * factor


class StiffnessRamp:
    """Rate limiter of stiffness.

    Attributes:
        share: Stiffness now, from 0 to 1.
    """

    def __init__(self, tick: float, rise: float = 1.0, fall: float = 0.5):
        """Start limp.

        Args:
            tick: Time from one value to the next, in [s].
            rise: Time from limp to stiff, in [s].
            fall: Time from stiff to limp, in [s].
        """
        self.share = 0.0
        self._up, self._down = tick / rise, tick / fall

    def toward(self, wanted: float) -> float:
        """Move toward a stiffness, and return the present one."""
        change = min(max(wanted - self.share, -self._down), self._up)
        self.share = min(max(self.share + change, 0.0), 1.0)
        return self.share

    def limit(self, share: float) -> None:
        """Limit the stiffness now, from 0 to 1; it may rise again."""
        self.share = min(self.share, share)


def posture_reached(
    targets: Array, goal: Array, measured: Array, legs: NDArray[np.intp]
) -> bool:
    """Return whether targets and leg joints have reached a posture."""
    arrived = bool(np.all(np.abs(targets - goal) < 2.0 * MARGIN))
    off = np.abs(measured[legs] - goal[legs])
    return arrived and bool(np.all(off < 0.2))
