"""Joint targets and stiffness for each state of the robot."""

import numpy as np

from ...core.poses import Array
from .frame_clock import TICK
from .frames import SensorFrame
from .joint_map import NAMES, JointMap
from .safety import RobotState
from .target_limits import StiffnessRamp, TargetLimiter, derated, legs_reached

SLOWLY = 0.5  # speed of every joint on the way to a posture, in [rad/s]
# Thighs and shanks folded over the feet: the robot can go limp from here.
CROUCH = {
    "HipYawPitch": 0.0,
    "HipRoll": 0.0,
    "HipPitch": -0.92,
    "KneePitch": 2.1,
    "AnklePitch": -1.18,
    "AnkleRoll": 0.0,
}


class JointMotionState:
    """Moves slowly to stance or crouch, or as control says, or not at all.

    Attributes:
        targets: What was last asked for, in [rad]. Shape (25,).
    """

    def __init__(self, joints: JointMap, stance: Array) -> None:
        """Know both postures.

        Args:
            joints: Order of the description's joints.
            stance: Posture in which control begins, in [rad].
                Shape (joints,).
        """
        self._joints = joints
        self._stance_targets = stance
        self._limiter: TargetLimiter | None = None
        self._ramp = StiffnessRamp(TICK)
        self.targets: Array = np.zeros(len(NAMES))

    def reached(self, state: RobotState, measured: Array) -> bool:
        """Whether a slow motion has arrived where it leads.

        Args:
            state: Reaching or resting; in others nothing is reached.
            measured: Joint angles, in [rad]. Shape (25,).
        """
        if state not in (RobotState.REACHING, RobotState.RESTING):
            return False
        if state is RobotState.REACHING and self._ramp.share < 1.0:
            return False
        return legs_reached(self.targets, self._goal(state), measured)

    def weaken(self, share: float) -> None:
        """Never be stiffer than the robot says that it is."""
        self._ramp.share = min(self._ramp.share, share)

    def move(
        self, state: RobotState, frame: SensorFrame, wanted: Array
    ) -> tuple[Array, Array]:
        """Targets and stiffness of one tick.

        Args:
            state: What the robot may do.
            frame: What it says now.
            wanted: What control wants, in [rad]. Shape (joints,).

        Returns:
            Targets, in [rad], and stiffness. Shapes (25,).
        """
        limiter = self._limiter
        if limiter is None or (
            state is RobotState.LIMP and self._ramp.share == 0
        ):
            # Stiffness grows from where the joints are.
            limiter = self._limiter = TargetLimiter(frame.position, TICK)
            self.targets = limiter.target
        if state.moves_by_control:
            goal = self._joints.to_lola(wanted, self.targets)
            self.targets = limiter.toward(goal)
        elif state is not RobotState.LIMP:
            self.targets = limiter.toward(self._goal(state), SLOWLY)
        share = self._ramp.toward(0.0 if state is RobotState.LIMP else 1.0)
        stiffness = np.full(len(NAMES), share)
        stiffness = derated(stiffness, frame.temperature, frame.status)
        return self.targets, stiffness

    def fade(self) -> tuple[Array, Array]:
        """Targets held, stiffness less by one tick. Shapes (25,)."""
        return self.targets, np.full(len(NAMES), self._ramp.toward(0.0))

    @property
    def is_limp(self) -> bool:
        """Whether all stiffness has gone."""
        return self._ramp.share == 0.0

    def _goal(self, state: RobotState) -> Array:
        goal = self._joints.to_lola(self._stance_targets, self.targets)
        if state is RobotState.RESTING:
            for at, name in enumerate(NAMES):
                goal[at] = CROUCH.get(name[1:], goal[at])
        return goal
