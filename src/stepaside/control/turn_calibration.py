"""Calibration of the turning rate by the gyro."""

from math import exp, isfinite, pi

from ..core.poses import wrap_angle

TIME_CONSTANT = 10.0  # of the averages, in [s]: some gait cycles
BIAS_TIME = 1.0  # of standing to average the gyro bias, in [s]
MIN_TURN = 0.3  # averaged turn that allows an estimate, in [rad]
MIN_RATIO, MAX_RATIO = 0.8, 1.25  # plausible turn ratios


class TurnCalibration:
    """Estimator of the ratio of actual turns to turns in odometry.

    Feet twist on the floor and joints comply, which odometry from encoders
    does not contain. A gyro about the vertical measures the turn, once its
    bias is known from standing.
    """

    def __init__(self, tick: float) -> None:
        self._tick, self._decay = tick, exp(-tick / TIME_CONSTANT)
        self._standing_ticks, self._bias_sum, self._missing_ticks = 0, 0.0, 0
        self._actual = self._odometric = 0.0
        self._heading: float | None = None
        self.share = 1.0

    @property
    def ready(self) -> bool:
        """Whether the robot has stood long enough to estimate the gyro bias.

        Ticks without a gyro reading count, too.
        """
        return (
            self._standing_ticks + self._missing_ticks
        ) * self._tick >= BIAS_TIME

    def compensate(self, heading: float) -> float:
        """Return the desired heading that yields a heading, in [rad].

        The template turns in proportion to the desired heading (eq. (2)).
        """
        most = max(pi, abs(heading))
        return min(max(heading / self.share, -most), most)

    def note(self, rate: float, heading: float, *, stands: bool) -> None:
        """Update with one reading.

        Without a gyro about the vertical the ratio stays as it is.

        ``heading``: Heading in odometry, unwrapped, in [rad].
        """
        if not isfinite(rate):
            self._missing_ticks += stands
            return
        last, self._heading = self._heading, heading
        if stands:
            self._standing_ticks += 1
            self._bias_sum += rate
            return
        if last is None or not self._standing_ticks:
            return
        bias = self._bias_sum / self._standing_ticks
        turned = (rate - bias) * self._tick
        self._actual = self._decay * self._actual + turned
        step = wrap_angle(heading - last)
        self._odometric = self._decay * self._odometric + step
        if abs(self._odometric) > MIN_TURN:
            ratio = self._actual / self._odometric
            self.share = min(max(ratio, MIN_RATIO), MAX_RATIO)
