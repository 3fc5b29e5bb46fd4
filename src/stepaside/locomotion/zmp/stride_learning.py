"""Learning of the footsteps' shortfall from the encoders."""

from math import atan2

import numpy as np

from ...core.poses import Array, wrap_angle
from ...planning import Foot, GaitSettings
from ...planning.swing import swing_progress
from ...robots.forward_kinematics import MeasuredPosture
from ...robots.leg_kinematics import BodyReference
from .current_step import CurrentStep, moved_swing

MAX_TURN = 0.08  # of the learned correction, in [rad]


def measured_step(posture: MeasuredPosture, swing: Foot) -> Array:
    """Return the pose of the swing foot in the frame of the other foot.

    A row (x [m], y [m], theta [rad]). Shape (3,).
    """
    own, other = (0, 1) if swing is Foot.LEFT else (1, 0)
    frame = posture.axes_feet_in_torso[other].T
    x, y, _ = frame @ (
        posture.positions_feet_in_torso[own]
        - posture.positions_feet_in_torso[other]
    )
    turn = frame @ posture.axes_feet_in_torso[own]
    return np.array([x, y, atan2(turn[1, 0], turn[0, 0])])


class StrideLearning:
    """Correction of the swing foot's target by its previous shortfall.

    With backlash and delay a foot lands a few percent short of its target,
    always to the same side; at the end of a step the encoders show by how
    much. The correction fades in with the swing and out again in the double
    support, where the stance foot cannot move and the joints only strain.

    Attributes:
        aim: Correction of each foot's landing, in the support foot's
            frame: rows (x [m], y [m], theta [rad]).
    """

    def __init__(self, gait: GaitSettings, gain: float, bound: float) -> None:
        """Begin without a correction; the bound is of the position."""
        self._gait, self._gain = gait, gain
        self._bounds = np.array([bound, bound, MAX_TURN])
        self.aim = {Foot.LEFT: np.zeros(3), Foot.RIGHT: np.zeros(3)}

    def learn(self, posture: MeasuredPosture, step: CurrentStep) -> None:
        """Update from the posture at the end of a step."""
        planned = np.array(step.support.inverse().compose(step.landing))
        short = planned - measured_step(posture, step.swing)
        short[2] = wrap_angle(float(short[2]))
        aim = self.aim[step.swing] + self._gain * short
        self.aim[step.swing] = np.clip(aim, -self._bounds, self._bounds)

    def aimed(self, body: BodyReference, step: CurrentStep) -> BodyReference:
        """Return a reference with the corrected target of the swing foot."""
        if not step.walking:
            return body
        share = step.progress
        if step.remaining < 0.0:
            gait = self._gait if step.plan is None else step.plan.gait
            stood = -step.remaining / gait.double_support
            share = 1.0 - swing_progress(stood)
        if share <= 0.0:
            return body
        x, y, theta = (share * self.aim[step.swing]).tolist()
        x, y = step.from_support(x, y)
        return moved_swing(body, step.swing, x, y, theta)
