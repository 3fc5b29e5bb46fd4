"""Feet that tilt against the torso's tilt."""

from .estimation import BodyState
from .settings import StabiliserSettings

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
