"""Rules for the ZMP shift that regulates the DCM shift."""

from typing import Protocol

import numpy as np

from ...planning import Foot, GaitSettings
from .control_settings import ControlSettings
from .current_step import CurrentStep, clip_to, zmp_box
from .mpc import IntrinsicallyStableMpc, MpcResult

Vector = tuple[float, float]


class ZmpFeedback(Protocol):
    """Rule for the ZMP shift.

    Attributes:
        mpc: The MPC.
        solved: Result of the MPC at the last tick, if it ran.
    """

    solved: MpcResult | None

    def shift(self, step: CurrentStep, dcm: Vector, zmp: Vector) -> Vector:
        """Return the ZMP shift at the next tick, in odometry, in [m].

        Args:
            step: Step in progress.
            dcm: DCM shift in odometry, in [m].
            zmp: Present ZMP shift in odometry, in [m].
        """


class ProportionalFeedback:
    """Proportional rule: a multiple of the DCM shift, clipped to the sole.

    Attributes:
        solved: None.
    """

    def __init__(
        self, gait: GaitSettings, *, gain: float, edge: float
    ) -> None:
        """Take a gain above 1 and the distance from the edge, in [m]."""
        self.solved: MpcResult | None = None
        self._gain = gain
        self._boxes = {foot: zmp_box(foot, gait, edge) for foot in Foot}

    def shift(self, step: CurrentStep, dcm: Vector, zmp: Vector) -> Vector:
        """Return the ZMP shift; see :class:`ZmpFeedback`."""
        u, v = step.to_support(*dcm)
        wanted = self._gain * u, self._gain * v
        return step.from_support(*clip_to(wanted, self._boxes[step.swing]))


class MpcFeedback:
    """Rule by the intrinsically stable MPC.

    Attributes:
        mpc: The MPC.
        solved: Result of the MPC at the last tick, if it ran.
    """

    def __init__(
        self,
        mpc: IntrinsicallyStableMpc,
        standing: ProportionalFeedback,
        tick: float,
    ) -> None:
        """Use an MPC while walking, and another rule while standing."""
        self.solved: MpcResult | None = None
        self.mpc, self._standing, self._tick = mpc, standing, tick

    def shift(self, step: CurrentStep, dcm: Vector, zmp: Vector) -> Vector:
        """Return the ZMP shift; see :class:`ZmpFeedback`."""
        self.solved = None
        if step.plan is None:
            return self._standing.shift(step, dcm, zmp)
        if dcm == zmp == (0.0, 0.0):
            return zmp  # the plan itself is optimal
        result = self.mpc.solve(
            step.plan,
            step.passed,
            np.array(step.to_support(*dcm)),
            np.array(step.to_support(*zmp)),
        )
        self.solved = result
        vx, vy = step.from_support(*result.velocity)
        return zmp[0] + self._tick * vx, zmp[1] + self._tick * vy


def zmp_feedback(
    settings: ControlSettings, gait: GaitSettings, tick: float
) -> ZmpFeedback:
    """Return the rule of a method.

    Args:
        settings: Method and gains.
        gait: Gait.
        tick: Control period, in [s].

    Raises:
        ConfigurationError: If the method needs a solver that is missing.
    """
    gains = settings.stabiliser
    rule = ProportionalFeedback(gait, gain=gains.feedback, edge=gains.edge)
    if settings.method != "mpc":
        return rule
    mpc = IntrinsicallyStableMpc(gait, settings.mpc, edge=gains.edge)
    return MpcFeedback(mpc, rule, tick)
