"""How much of a turn is made, by the gyro."""

from math import exp, isfinite, pi

from ..core.poses import wrap_angle

FORGETS = 10.0  # time over which turns count, in [s]: some cycles of a gait
RESTED = 1.0  # standing that tells a bias in spite of noise, in [s]
ENOUGH = 0.3  # turn that tells something, in [rad]
LEAST, MOST = 0.8, 1.25  # share of a turn that is believed


class TurnCalibration:
    """Share of the turn that a robot believes to walk which it makes.

    Feet twist on the floor, and joints give: what odometry made of the
    encoders knows nothing of either. A gyro about the vertical does, once
    its bias is known, which is what it reads while the robot stands.

    Attributes:
        share: Turn made for each turn believed; 1 while nothing is known.
    """

    def __init__(self, tick: float) -> None:
        """Know nothing yet.

        Args:
            tick: Between two readings, in [s].
        """
        self._tick, self._keeps = tick, exp(-tick / FORGETS)
        self._stood, self._read, self._blind = 0, 0.0, 0
        self._made = self._believed = 0.0
        self._heading: float | None = None
        self.share = 1.0

    @property
    def rested(self) -> bool:
        """Whether it stood long enough to know the bias of its gyro.

        Without a gyro there is none to know.
        """
        return (self._stood + self._blind) * self._tick >= RESTED

    def asked(self, heading: float) -> float:
        """What to ask for so that a heading is what is made, in [rad].

        The template turns in proportion to the desired heading (eq. (2)).
        """
        most = max(pi, abs(heading))
        return min(max(heading / self.share, -most), most)

    def note(self, rate: float, heading: float, *, stands: bool) -> None:
        """Take one reading.

        Without a gyro about the vertical nothing is learnt: what is asked
        for stays as it is.

        Args:
            rate: Of the gyro about the vertical, in [rad/s]; NaN without.
            heading: As the robot believes it, unwrapped, in [rad].
            stands: Whether it stands still.
        """
        if not isfinite(rate):
            self._blind += stands
            return
        last, self._heading = self._heading, heading
        if stands:
            self._stood += 1
            self._read += rate
            return
        if last is None or not self._stood:
            return
        bias = self._read / self._stood
        turned = (rate - bias) * self._tick
        self._made = self._keeps * self._made + turned
        step = wrap_angle(heading - last)
        self._believed = self._keeps * self._believed + step
        if abs(self._believed) > ENOUGH:
            share = self._made / self._believed
            self.share = min(max(share, LEAST), MOST)
