"""Joint targets and stiffness for each state of a robot, within limits."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array
from ..perception.measurement import RobotState, RobotStatus
from .joint_robot import Motors
from .safety_states import SafetyState

MARGIN = 0.01  # distance from the ends of each range, in [rad]
WARM, HOT = 70.0, 85.0  # range of the reduction, in [degC]; an assumption
MIN_STIFFNESS = 0.5  # fraction of the stiffness that a hot joint keeps
POSTURE_SPEED = 0.5  # of each joint in motions to a posture, in [rad/s]


class TargetLimiter:
    """Limiter of joint targets to range and speed.

    Attributes:
        target: Newest targets, in [rad]. Shape (motors,).
    """

    def __init__(self, start: Array, motors: Motors, tick: float) -> None:
        """Start at measured angles, so that no joint jumps.

        Args:
            start: Measured angles, in [rad]. Shape (motors,).
            motors: Motors, with their ranges and speeds.
            tick: Time from one target to the next, in [s].
        """
        self.target = np.array(start, dtype=np.float64)
        self._motors, self._tick = motors, tick

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
        reach = limit * self._tick
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


def derate_stiffness(stiffness: Array, status: RobotStatus) -> Array:
    """Reduce the stiffness of hot joints, from 0 to 1. Shape (motors,)."""
    hot = (status.temperature - WARM) / (HOT - WARM)
    factor = np.clip(1.0 - (1.0 - MIN_STIFFNESS) * hot, MIN_STIFFNESS, 1.0)
    factor[status.heat >= 3] = 0.0
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


class JointMotionState:
    """Generator of joint targets and stiffness for the robot's state.

    Attributes:
        targets: Newest joint targets, in [rad]. Shape (motors,).
    """

    def __init__(
        self,
        stance: Array,
        motors: Motors,
        tick: float,
        *,
        crouch: Mapping[str, float],
        soft: bool = False,
        at_once: bool = False,
    ) -> None:
        """Start limp.

        Args:
            stance: Posture in which control begins, in [rad].
                Shape (motors,).
            motors: Motors of the robot.
            tick: Time from one target to the next, in [s].
            crouch: Angles from which the robot can go limp, in [rad], by
                joint.
            soft: Whether control chooses the gains of the motors: its targets
                may then be far from the angles, and are not limited.
            at_once: Whether stiffness rises and falls within one tick.
        """
        self._motors, self._tick, self._soft = motors, tick, soft
        rest = [
            crouch.get(name, angle)
            for name, angle in zip(motors.names, stance, strict=True)
        ]
        self._goals = {
            SafetyState.REACHING: stance,
            SafetyState.READY: stance,
            SafetyState.RESTING: np.array(rest),
        }
        self._limiter: TargetLimiter | None = None
        rise, fall = (tick, tick) if at_once else (1.0, 0.5)
        self._ramp = StiffnessRamp(tick, rise, fall)
        self.targets: Array = np.zeros(len(motors.names))

    def reached(self, state: SafetyState, measured: Array) -> bool:
        """Return whether the slow motion to a posture is complete.

        Args:
            state: State of the robot; there is such a motion only in
                reaching and resting.
            measured: Joint angles, in [rad]. Shape (motors,).
        """
        if state not in (SafetyState.REACHING, SafetyState.RESTING):
            return False
        if state is SafetyState.REACHING and self._ramp.share < 1.0:
            return False
        return posture_reached(
            self.targets, self._goals[state], measured, self._motors.legs
        )

    def weaken(self, share: float) -> None:
        """Limit the stiffness to a value that the robot reports."""
        self._ramp.limit(share)

    def move(
        self, state: SafetyState, report: RobotState, wanted: Array
    ) -> tuple[Array, Array]:
        """Return targets and stiffness of one tick.

        Args:
            state: State of the robot.
            report: Newest report.
            wanted: Joint targets of control, in [rad]. Shape (motors,).

        Returns:
            Targets, in [rad], and stiffness. Shapes (motors,).
        """
        limiter = self._limiter
        if limiter is None or (
            state is SafetyState.LIMP and self._ramp.share == 0
        ):
            # Stiffness rises at the measured angles, so that nothing jumps.
            limiter = self._limiter = TargetLimiter(
                report.joint_positions, self._motors, self._tick
            )
            self.targets = limiter.target
        if state.moves_by_control:
            self.targets = (
                limiter.follow(wanted)
                if self._soft
                else limiter.toward(wanted)
            )
        elif state is not SafetyState.LIMP:
            self.targets = limiter.toward(self._goals[state], POSTURE_SPEED)
        share = self._ramp.toward(0.0 if state is SafetyState.LIMP else 1.0)
        stiffness = np.full(len(self._motors.names), share)
        if report.status is not None:
            stiffness = derate_stiffness(stiffness, report.status)
        return self.targets, stiffness

    def fade(self) -> tuple[Array, Array]:
        """Return held targets, and stiffness lower by one tick."""
        return self.targets, np.full(
            len(self._motors.names), self._ramp.toward(0.0)
        )

    @property
    def is_limp(self) -> bool:
        """Whether the stiffness is zero."""
        return self._ramp.share == 0.0
