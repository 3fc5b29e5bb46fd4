"""Joint angles that the servos leave off, by backlash or by load."""

from collections import deque

import numpy as np

from ...poses import Array


class JointCorrection:
    """Integrates what the joints miss of their targets, within a bound.

    A joint with backlash rests on one side of it until its load turns round,
    and a servo gives way to a load; both leave an angle that lasts long
    enough to be measured and asked for on top.
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
        """Begin with nothing to correct.

        Args:
            gain: Of the integral, in [1/s].
            bound: Greatest correction, in [rad].
            leak: Rate at which it is forgotten, in [1/s].
            tick: Control period, in [s].
            delay: Time from a request to the motion, in [s].
        """
        self._gain, self._bound = gain * tick, bound
        self._keep = 1.0 - leak * tick
        # The servo ramps to a target in one tick more.
        self._wanted: deque[Array] = deque(maxlen=round(delay / tick) + 2)
        self._correction: Array | float = 0.0

    def update(self, measured: Array, targets: Array) -> Array:
        """Correct the targets of one tick.

        Args:
            measured: Encoders, in [rad]. Shape (joints,).
            targets: What is wanted, in [rad]. Shape (joints,).
        """
        if len(self._wanted) == self._wanted.maxlen:
            missed = self._wanted[0] - measured
            self._correction = np.clip(
                self._keep * self._correction + self._gain * missed,
                -self._bound,
                self._bound,
            )
        self._wanted.append(targets)
        corrected: Array = targets + self._correction
        return corrected
