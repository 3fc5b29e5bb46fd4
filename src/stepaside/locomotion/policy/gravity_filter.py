"""Direction of gravity of a robot that walks by a policy."""

from ...core.poses import Array
from ...perception.attitude import CALIBRATION, AttitudeFilter

# Gain of the accelerometer until then, in [1/s]. It also reads the knocks of a
# robot that comes to stand: at 6 a K1 falls in its first steps, at 3 not.
FIRST = 3.0
# Gain afterwards, in [1/s]: some gait cycles. In walks at random commands on
# six networks the error is 0.5 to 0.6 deg rms, at 0.5 it is 0.8 to 1.1 deg.
# With sensors of the hardware body it is less at 0.25 than at 0.15 and 0.5.
CORRECTION = 0.25
BIAS_CORRECTION = 0.0125  # of the gyro, in [1/s^2]: damped beyond critical


class GravityFilter(AttitudeFilter):
    """Attitude filter of a robot that sways while it stands.

    Standing does not calibrate its gyro: at first the accelerometer counts
    more. The known acceleration is that of a turning velocity. What a torso
    that leans shows about its axis near the vertical is the sway of its walk.
    """

    def __init__(self, velocity: Array, duration: float) -> None:
        """Begin upright.

        ``velocity``: Velocity of the torso in its level frame, in [m/s]; read
        at each update. Shape (3,).
        """
        super().__init__(FIRST, 0.0, calibration=0.0)
        self._velocity, self._duration, self._time = velocity, duration, 0.0

    @property
    def knows(self) -> bool:
        """Whether the robot has stood long enough for the direction."""
        return self._time >= CALIBRATION - 1e-9

    @property
    def tilt(self) -> tuple[float, float]:
        """Roll and pitch of the torso, in [rad]."""
        return self.roll, self.pitch

    def take(self, gyro: Array, specific_force: Array) -> None:
        """Update the direction with one reading; see :meth:`update`."""
        if self.knows:
            self.gains = CORRECTION, BIAS_CORRECTION
        self._time += self._duration
        turn = self.turning.item(0)
        ahead, left = self._velocity[:2].tolist()
        known = -left * turn, ahead * turn
        self.update(gyro, specific_force, known, self._duration)

    def adopt(self, tilt: tuple[float, float]) -> None:
        """Replace the direction by the estimate of the robot itself.

        It is known at once then.
        """
        self.lean(*tilt)
        self._time = CALIBRATION
