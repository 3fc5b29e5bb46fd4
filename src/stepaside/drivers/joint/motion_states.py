"""Joint targets and stiffness for each state of the robot."""

import numpy as np

from ...core.poses import Array
from .frames import JointFrame
from .joint_map import JointMap, MotorTable
from .safety_state_machine import RobotState
from .target_limits import (
    StiffnessRamp,
    TargetLimiter,
    derate_stiffness,
    posture_reached,
)

POSTURE_SPEED = 0.5  # of each joint in motions to a posture, in [rad/s]


class JointMotionState:
    """Generator of joint targets and stiffness for the robot's state.

    Attributes:
        targets: Newest joint targets, in [rad]. Shape (motors,).
    """

    def __init__(
        self,
        joints: JointMap,
        stance: Array,
        motors: MotorTable,
        *,
        soft: bool = False,
        at_once: bool = False,
    ) -> None:
        """Start limp.

        Args:
            joints: Map to the order of the description's joints.
            stance: Posture in which control begins, in [rad].
                Shape (joints,).
            motors: Motors of the robot.
            soft: Whether control chooses the gains of the motors: its targets
                may then be far from the angles, and are not limited.
            at_once: Whether stiffness rises and falls within one tick.
        """
        self._joints, self._motors, self._soft = joints, motors, soft
        self._stance_targets = stance
        self._limiter: TargetLimiter | None = None
        self._ramp = (
            StiffnessRamp(motors.tick, motors.tick, motors.tick)
            if at_once
            else StiffnessRamp(motors.tick)
        )
        self.targets: Array = np.zeros(motors.count)

    def reached(self, state: RobotState, measured: Array) -> bool:
        """Return whether the slow motion to a posture is complete.

        Args:
            state: State of the robot; there is such a motion only in
                reaching and resting.
            measured: Joint angles, in [rad]. Shape (motors,).
        """
        if state not in (RobotState.REACHING, RobotState.RESTING):
            return False
        if state is RobotState.REACHING and self._ramp.share < 1.0:
            return False
        return posture_reached(
            self.targets, self._goal(state), measured, self._motors.legs
        )

    def weaken(self, share: float) -> None:
        """Limit the stiffness to a value that the robot reports."""
        self._ramp.limit(share)

    def move(
        self, state: RobotState, frame: JointFrame, wanted: Array
    ) -> tuple[Array, Array]:
        """Return targets and stiffness of one tick.

        Args:
            state: State of the robot.
            frame: Newest sensor frame.
            wanted: Joint targets of control, in [rad]. Shape (joints,).

        Returns:
            Targets, in [rad], and stiffness. Shapes (motors,).
        """
        limiter = self._limiter
        if limiter is None or (
            state is RobotState.LIMP and self._ramp.share == 0
        ):
            # Stiffness rises at the measured angles, so that nothing jumps.
            limiter = self._limiter = TargetLimiter(
                frame.position, self._motors
            )
            self.targets = limiter.target
        if state.moves_by_control:
            goal = self._joints.to_motors(wanted, self.targets)
            self.targets = (
                limiter.follow(goal) if self._soft else limiter.toward(goal)
            )
        elif state is not RobotState.LIMP:
            self.targets = limiter.toward(self._goal(state), POSTURE_SPEED)
        share = self._ramp.toward(0.0 if state is RobotState.LIMP else 1.0)
        stiffness = np.full(self._motors.count, share)
        stiffness = derate_stiffness(
            stiffness, frame.temperature, frame.status
        )
        return self.targets, stiffness

    def fade(self) -> tuple[Array, Array]:
        """Return held targets, and stiffness lower by one tick."""
        return self.targets, np.full(
            self._motors.count, self._ramp.toward(0.0)
        )

    @property
    def is_limp(self) -> bool:
        """Whether the stiffness is zero."""
        return self._ramp.share == 0.0

    def _goal(self, state: RobotState) -> Array:
        goal = self._joints.to_motors(self._stance_targets, self.targets)
        if state is RobotState.RESTING:
            for at, name in enumerate(self._motors.names):
                goal[at] = self._motors.crouch.get(name, goal[at])
        return goal
