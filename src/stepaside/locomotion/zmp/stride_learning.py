"""Footsteps that fall short, learned from the encoders."""

from math import atan2

import numpy as np

from ...core.poses import Array, wrap_angle
from ...planning import Foot, GaitSettings
from ...planning.swing import swing_progress
from ...robots.forward_kinematics import MeasuredPosture
from ...robots.leg_kinematics import BodyReference
from .current_step import CurrentStep

TURNED = 0.08  # most that is learned of a turn, in [rad]


def measured_step(posture: MeasuredPosture, swing: Foot) -> Array:
    """Pose of the foot that swung in the frame of the other one.

    Args:
        posture: Feet by the measured joints.
        swing: Foot that swung.

    Returns:
        Row (x [m], y [m], theta [rad]). Shape (3,).
    """
    own, other = (0, 1) if swing is Foot.LEFT else (1, 0)
    frame = posture.frames[other].T
    x, y, _ = frame @ (posture.feet[own] - posture.feet[other])
    turn = frame @ posture.frames[own]
    return np.array([x, y, atan2(turn[1, 0], turn[0, 0])])


class StrideLearning:
    """Aims a swing foot beyond its landing by what it fell short before.

    Joints with backlash and delay leave a foot a few percent short of where it
    was sent, always to the same side; at the end of a step the encoders know
    by how much. The aim fades in with the swing and out again in the double
    support, where the foot stands and the joints only strain.

    Attributes:
        aim: Of each foot beyond its landing, in the support foot's frame:
            rows (x [m], y [m], theta [rad]).
    """

    def __init__(self, gait: GaitSettings, gain: float, bound: float) -> None:
        """Begin with no aim.

        Args:
            gait: Gait.
            gain: Share that is learned from a step.
            bound: Most that is learned of a way, in [m].
        """
        self._gait, self._gain = gait, gain
        self._bounds = np.array([bound, bound, TURNED])
        self.aim = {Foot.LEFT: np.zeros(3), Foot.RIGHT: np.zeros(3)}

    def learn(self, posture: MeasuredPosture, step: CurrentStep) -> None:
        """Learn from a step at its end.

        Args:
            posture: Feet by the measured joints.
            step: The step.
        """
        planned = np.array(step.support.inverse().compose(step.landing))
        short = planned - measured_step(posture, step.swing)
        short[2] = wrap_angle(float(short[2]))
        aim = self.aim[step.swing] + self._gain * short
        self.aim[step.swing] = np.clip(aim, -self._bounds, self._bounds)

    def aimed(self, body: BodyReference, step: CurrentStep) -> BodyReference:
        """Let the swing foot of a reference head beyond its landing."""
        if not step.walking:
            return body
        share = step.progress
        if step.remaining < 0.0:
            gait = self._gait if step.plan is None else step.plan.gait
            stood = -step.remaining / gait.double_support
            share = 1.0 - float(swing_progress(stood))
        if share <= 0.0:
            return body
        x, y, theta = (share * self.aim[step.swing]).tolist()
        x, y = step.from_support(x, y)
        if step.swing is Foot.LEFT:
            u, v, z, yaw = body.left_foot
            return body._replace(left_foot=(u + x, v + y, z, yaw + theta))
        u, v, z, yaw = body.right_foot
        return body._replace(right_foot=(u + x, v + y, z, yaw + theta))
