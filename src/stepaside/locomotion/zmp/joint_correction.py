"""Correction of ankle tilts and of steady joint errors."""

from collections import deque

import numpy as np

from ...core.compilation import bound, compiled
from ...core.poses import Array
from .control_settings import StabiliserSettings
from .state_estimator import BodyState

Tilt = tuple[float, float]


@compiled
def correct(
    measured: Array,
    past: Array,
    correction: Array,
    gain: float,
    keep: float,
    most: float,
) -> None:
    """Integrate the joint errors of one tick."""
    for i in range(measured.shape[0]):
        error = (past[i] - measured[i]) * gain
        error += keep * correction[i]
        correction[i] = max(min(error, most), -most)


class Ankles:
    """Ankle feedback: tilts the loaded feet to rotate the body upright."""

    def __init__(self, gains: StabiliserSettings, tick: float) -> None:
        """Begin with level feet, for a control period in [s]."""
        self._gains, self._tick = gains, tick
        self._reference_roll = 0.0
        self._blend = min(1.0, gains.ankle_bandwidth * tick)
        self._tilts = (0.0, 0.0, 0.0, 0.0)

    def tilts(
        self, state: BodyState, reference_roll: float = 0.0
    ) -> tuple[Tilt, Tilt]:
        """Return roll and pitch of the left and the right foot, in [rad]."""
        gains, blend = self._gains, self._blend
        tilt = state.tilt[0] - reference_roll
        rate = (
            state.rate[0]
            - (reference_roll - self._reference_roll) / self._tick
        )
        self._reference_roll = reference_roll
        roll = gains.ankle * tilt + gains.ankle_rate * rate
        pitch = gains.ankle * state.tilt[1] + gains.ankle_rate * state.rate[1]
        left = min(1.0, 2.0 * state.left_share)
        right = min(1.0, 2.0 - 2.0 * state.left_share)
        a, b, c, d = self._tilts
        self._tilts = (
            a + blend * (left * roll - a),
            b + blend * (left * pitch - b),
            c + blend * (right * roll - c),
            d + blend * (right * pitch - d),
        )
        return self._tilts[:2], self._tilts[2:]


class JointCorrection:
    """Bounded, leaky integral of the joint errors.

    A joint with backlash rests on one side until its load reverses, and a
    servo deflects under load; both errors last long enough to be measured
    and added to the targets.
    """

    def __init__(
        self,
        gain: float,
        bound: float,
        leak: float,
        *,
        tick: float,
        delay: float,
    ) -> None:
        """Begin without a correction.

        Args:
            gain: Gain of the integral, in [1/s].
            bound: Largest correction, in [rad].
            leak: Decay rate of the correction, in [1/s].
            tick: Control period, in [s].
            delay: Time from a command to the motion, in [s].
        """
        self._gain, self._bound = gain * tick, bound
        self._keep = 1.0 - leak * tick
        # The servo ramps to a target over one more tick.
        self._targets: deque[Array] = deque(maxlen=round(delay / tick) + 2)
        self._correction: Array | None = None
        self._bind(1)  # compiles

    def update(self, measured: Array, targets: Array) -> Array:
        """Return the corrected targets of one tick, in [rad]."""
        if self._correction is None:
            self._correction = self._bind(len(targets))
        if len(self._targets) == self._targets.maxlen:
            self._measured[:], self._past[:] = measured, self._targets[0]
            self._correct()
        self._targets.append(targets)
        corrected: Array = targets + self._correction
        return corrected

    def _bind(self, count: int) -> Array:
        """Prepare the integral for a number of joints; return it."""
        self._measured, self._past, correction = np.zeros((3, count))
        self._correct = bound(
            *(correct, self._measured, self._past, correction),
            *(self._gain, self._keep, self._bound),
        )
        return correction
