"""What joints may be asked for: range, rate, and torque when hot."""

from collections.abc import Sequence

import numpy as np

from ...core.poses import Array
from .joint_map import HIGH, LEGS, LOW, SPEED

MARGIN = 0.01  # kept from the ends of each range, in [rad]
WARM, HOT = 70.0, 85.0  # torque is cut between these, in [degC]; assumed
LEAST = 0.5  # share of the torque that a hot joint keeps


class TargetLimiter:
    """Keeps joint targets within range, and changes within speed.

    Attributes:
        target: What was last asked for, in [rad]. Shape (25,).
    """

    def __init__(self, start: Array, tick: float) -> None:
        """Begin at measured angles, so that nothing leaps.

        Args:
            start: Measured angles, in [rad]. Shape (25,).
            tick: Time from one target to the next, in [s].
        """
        self.target = np.array(start, dtype=np.float64)
        self._tick = tick

    def toward(self, wanted: Array, speed: float | None = None) -> Array:
        """Move the targets toward what is wanted, no faster than allowed.

        A joint that was found outside its range comes back into it.

        Args:
            wanted: Targets, in [rad]; what is not finite is not followed.
            speed: Limit of every joint, in [rad/s]; that of each motor by
                default.

        Returns:
            New targets, in [rad]. Shape (25,).
        """
        goal = np.where(np.isfinite(wanted), wanted, self.target)
        goal = np.clip(goal, LOW + MARGIN, HIGH - MARGIN)
        reach = SPEED if speed is None else np.minimum(SPEED, speed)
        step = np.clip(
            goal - self.target, -reach * self._tick, reach * self._tick
        )
        self.target = self.target + step
        return self.target


def derated(
    stiffness: Array, temperature: Array, status: Sequence[int]
) -> Array:
    """Cut the stiffness of hot joints.

    Args:
        stiffness: Wanted shares of the torque. Shape (25,).
        temperature: Of the motors, in [degC]. Shape (25,).
        status: Of the motors, as LoLA reports it.

    Returns:
        Shares that spare the motors. Shape (25,).
    """
    cut = (temperature - WARM) / (HOT - WARM) * (1.0 - LEAST)
    share = np.clip(1.0 - cut, LEAST, 1.0)
    share[np.array(status) >= 3] = 0.0
    return stiffness * share


class StiffnessRamp:
    """Stiffness that grows and fades instead of snapping.

    Attributes:
        share: Share of the full torque now, from 0 to 1.
    """

    def __init__(self, tick: float, rise: float = 1.0, fall: float = 0.5):
        """Begin limp.

        Args:
            tick: Time from one value to the next, in [s].
            rise: Time from limp to stiff, in [s].
            fall: Time from stiff to limp, in [s].
        """
        self.share = 0.0
        self._up, self._down = tick / rise, tick / fall

    def toward(self, wanted: float) -> float:
        """Move toward a share, and return where it is now."""
        change = min(max(wanted - self.share, -self._down), self._up)
        self.share = min(max(self.share + change, 0.0), 1.0)
        return self.share


def legs_reached(targets: Array, goal: Array, measured: Array) -> bool:
    """Whether a slow motion has arrived, targets first, then the legs."""
    arrived = bool(np.all(np.abs(targets - goal) < 2.0 * MARGIN))
    off = np.abs(measured[LEGS] - goal[LEGS])
    return arrived and bool(np.all(off < 0.2))
