"""How a robot learns where the other is."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

from ..core.poses import Array
from ..locomotion.zmp.current_step import CurrentStep
from ..perception.attitude import AttitudeFilter
from ..perception.measurement import Measurement, Sighting
from ..planning import Foot

if TYPE_CHECKING:
    from ..perception.perception import Perception

StepAt = Callable[[float], CurrentStep]
BELIEF = 0.5  # rate at which the accelerometer is believed, in [1/s]


class SightSource(Protocol):
    """What tells a robot of the other, and moves its head.

    Attributes:
        turning: How the body is to turn on the spot while it looks around,
            before anything is said: 1 to the left, -1 to the right, or 0.
    """

    @property
    def turning(self) -> float:
        """How the body is to turn on the spot: 1 left, -1 right, or 0."""

    def see(
        self,
        measurement: Measurement,
        step: StepAt,
        tilt: tuple[float, float] | None,
    ) -> Sighting | None:
        """Where the other is, as far as is known; None if lost.

        Args:
            measurement: What the sensors give at this tick.
            step: Step being made at a time, in [s].
            tilt: Roll and pitch of the torso, in [rad], if balance
                estimates them.
        """

    def aim(self, targets: Array) -> None:
        """Write where the head turns into joint targets, in [rad]."""


class MeasuredSight:
    """Sightings that come with the measurements; the last one counts.

    Attributes:
        turning: Never.
    """

    turning = 0.0

    def __init__(self, sighting: Sighting | None = None) -> None:
        """Know what is known before anything is seen."""
        self._last = sighting

    def see(
        self,
        measurement: Measurement,
        step: StepAt,
        tilt: tuple[float, float] | None,
    ) -> Sighting | None:
        """Newest sighting."""
        if measurement.sighting is not None:
            self._last = measurement.sighting
        return self._last

    def aim(self, targets: Array) -> None:
        """Leave the head where it is."""


class CameraSight:
    """Sightings from images, seen over the foot that stands.

    Where balance estimates the tilt of the torso, that estimate serves the
    eyes too; else a filter of the same kind does.

    Attributes:
        perception: What sees and looks.
    """

    def __init__(self, perception: "Perception", *, tick: float) -> None:
        """See with a perception, at a control period in [s]."""
        self.perception = perception
        self._attitude = AttitudeFilter(BELIEF, 0.0, calibration=0.0)
        self._tick = tick

    @property
    def turning(self) -> float:
        """How the body is to turn while it looks around: 1, -1 or 0."""
        return self.perception.around.turning

    def see(
        self,
        measurement: Measurement,
        step: StepAt,
        tilt: tuple[float, float] | None,
    ) -> Sighting | None:
        """Where the other is by the images so far."""
        if tilt is None:
            own = self._attitude
            gyro, force = measurement.gyro, measurement.accelerometer
            own.update(gyro, force, (0.0, 0.0), self._tick)
            tilt = own.roll, own.pitch
        made = step(measurement.time)
        left_supports = made.swing is Foot.RIGHT
        return self.perception.see(
            measurement, made.support, left_supports, tilt
        )

    def aim(self, targets: Array) -> None:
        """Turn the head to where the other is, or was."""
        self.perception.aim(targets)
