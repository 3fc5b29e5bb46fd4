"""How a shift of the ZMP brings a shift of the DCM back."""

from typing import Protocol

import numpy as np

from ...planning import GaitSettings
from .control_settings import ControlSettings
from .current_step import CurrentStep, clip_to, zmp_box
from .mpc import IntrinsicallyStableMpc, MpcResult

Vector = tuple[float, float]


class ZmpFeedback(Protocol):
    """A rule for the shift of the ZMP.

    Attributes:
        solved: Answer of a solver at the last tick, if it was asked.
    """

    solved: MpcResult | None

    def shift(self, step: CurrentStep, dcm: Vector, zmp: Vector) -> Vector:
        """Shift of the ZMP at the next tick.

        Args:
            step: Step being made.
            dcm: Shift of the DCM in odometry, in [m].
            zmp: Shift of the ZMP now, likewise.
        """


class ProportionalFeedback:
    """A multiple of the DCM's shift, as far as the sole allows.

    Attributes:
        solved: None: it has no solver.
    """

    def __init__(
        self, gait: GaitSettings, *, gain: float, edge: float
    ) -> None:
        """Take the gain, above 1, and the distance from the edge, in [m]."""
        self.solved: MpcResult | None = None
        self._gait, self._gain, self._edge = gait, gain, edge

    def shift(self, step: CurrentStep, dcm: Vector, zmp: Vector) -> Vector:
        """Shift of the ZMP; see :class:`ZmpFeedback`."""
        box = zmp_box(step.swing, self._gait, self._edge)
        u, v = step.to_support(*dcm)
        return step.from_support(
            *clip_to((self._gain * u, self._gain * v), box)
        )


class MpcFeedback:
    """The ZMP of the intrinsically stable MPC.

    Attributes:
        solved: Answer of the solver at the last tick, if it was asked.
    """

    def __init__(
        self,
        mpc: IntrinsicallyStableMpc,
        standing: ProportionalFeedback,
        tick: float,
    ) -> None:
        """Ask an MPC while walking, and another rule while standing."""
        self.solved: MpcResult | None = None
        self._mpc, self._standing, self._tick = mpc, standing, tick

    def shift(self, step: CurrentStep, dcm: Vector, zmp: Vector) -> Vector:
        """Shift of the ZMP; see :class:`ZmpFeedback`."""
        self.solved = None
        if step.plan is None:
            return self._standing.shift(step, dcm, zmp)
        if dcm == zmp == (0.0, 0.0):
            return zmp  # the plan itself is the answer
        answer = self._mpc.solve(
            step.plan,
            step.passed,
            np.array(step.to_support(*dcm)),
            np.array(step.to_support(*zmp)),
        )
        self.solved = answer
        vx, vy = step.from_support(*answer.velocity)
        return zmp[0] + self._tick * vx, zmp[1] + self._tick * vy


def zmp_feedback(
    settings: ControlSettings, gait: GaitSettings, tick: float
) -> ZmpFeedback:
    """Rule that a method asks for.

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
