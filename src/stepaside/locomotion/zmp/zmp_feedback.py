"""Rule for the ZMP shift that regulates the DCM shift."""

import numpy as np

from ...planning import Foot, GaitSettings
from .control_settings import ControlSettings
from .current_step import CurrentStep, clip_to, zmp_box
from .mpc import IntrinsicallyStableMpc, MpcResult

Vector = tuple[float, float]


class ZmpFeedback:
    """Rule for the ZMP shift of a method.

    It is a multiple of the DCM shift, clipped to the sole; with the MPC, the
    rule of a standing robot only.

    Attributes:
        mpc: The MPC, if the method uses it.
        solved: Result of the MPC at the last tick, if it ran.
    """

    def __init__(
        self, settings: ControlSettings, gait: GaitSettings, tick: float
    ) -> None:
        """Prepare the rule.

        Raises:
            ConfigurationError: If the method needs a solver that is missing.
        """
        gains = settings.stabiliser
        self._gain, self._tick = gains.feedback, tick
        self._boxes = {foot: zmp_box(foot, gait, gains.edge) for foot in Foot}
        self.solved: MpcResult | None = None
        self.mpc: IntrinsicallyStableMpc | None = None
        if settings.method == "mpc":
            edge = gains.edge
            self.mpc = IntrinsicallyStableMpc(gait, settings.mpc, edge=edge)

    def shift(self, step: CurrentStep, dcm: Vector, zmp: Vector) -> Vector:
        """Return the ZMP shift at the next tick, in odometry, in [m].

        Args:
            step: Step in progress.
            dcm: DCM shift in odometry, in [m].
            zmp: Present ZMP shift in odometry, in [m].
        """
        self.solved = None
        if self.mpc is None or step.plan is None:
            u, v = step.to_support(*dcm)
            wanted = self._gain * u, self._gain * v
            return step.from_support(*clip_to(wanted, self._boxes[step.swing]))
        if dcm == zmp == (0.0, 0.0):
            return zmp  # the plan itself is optimal
        self.solved = self.mpc.solve(
            step.plan,
            step.passed,
            np.array(step.to_support(*dcm)),
            np.array(step.to_support(*zmp)),
        )
        vx, vy = step.from_support(*self.solved.velocity)
        return zmp[0] + self._tick * vx, zmp[1] + self._tick * vy
