"""Joint angles that the servos leave off, by backlash or by load."""

from collections import deque

import numpy as np

from ...core.poses import Array
from .control_settings import StabiliserSettings
from .state_estimator import BodyState

Tilt = tuple[float, float]


class Ankles:
    """Tilts the feet that bear weight, which turns the body over them."""

    def __init__(self, gains: StabiliserSettings, tick: float) -> None:
        """Begin with level feet, for a clock with a given tick, in [s]."""
        self._gains, self._tick = gains, tick
        self._meant = 0.0
        self._blend = min(1.0, gains.ankle_bandwidth * tick)
        self._tilts = (0.0, 0.0, 0.0, 0.0)

    def tilts(self, state: BodyState, meant: float = 0.0) -> tuple[Tilt, Tilt]:
        """Tilts to ask for at one tick.

        Args:
            state: Of the body.
            meant: Roll of the torso that was asked for, in [rad].

        Returns:
            Roll and pitch of the left foot and of the right one, in [rad].
        """
        gains, blend = self._gains, self._blend
        tilt = state.tilt[0] - meant
        rate = state.rate[0] - (meant - self._meant) / self._tick
        self._meant = meant
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
