"""Sightings by the own sensors of a robot: a lidar or cameras."""

from typing import TYPE_CHECKING

from ..core.poses import Array, Sector
from ..perception.attitude import AttitudeFilter
from ..perception.measurement import RobotState, Sighting
from ..planning import Foot
from .sight_sources import SightSource, StepAt

if TYPE_CHECKING:
    from ..perception.lidar_perception import LidarPerception
    from ..perception.pipeline import Perception
    from ..robots.forward_kinematics import ForwardKinematics

CORRECTION = 0.5  # of the attitude filter by the accelerometer, in [1/s]


class LidarSight(SightSource):
    """Sightings from scans of a lidar, relative to the support foot.

    The pose of a sensor uses the torso tilt that balance estimates; without
    an estimate, an attitude filter of its own.
    """

    perception: "Perception | LidarPerception"

    def __init__(
        self, perception: "Perception | LidarPerception", *, tick: float
    ) -> None:
        """Wrap a perception, at a control period in [s]."""
        self.perception = perception
        self._attitude = AttitudeFilter(CORRECTION, 0.0, calibration=0.0)
        self._tick = tick

    def see(
        self,
        measurement: RobotState,
        step: StepAt,
        tilt: tuple[float, float] | None,
    ) -> Sighting | None:
        """Return the sighting by the images or scans so far."""
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


class CameraSight(LidarSight):
    """Sightings from images, with a head that looks at the opponent."""

    perception: "Perception"

    @property
    def cameras(self) -> "Perception":
        """Perception by cameras."""
        return self.perception

    @property
    def turning(self) -> float:
        """Turn on the spot for a scan: 1 left, -1 right, or 0."""
        return self.perception.head.turning

    @property
    def views(self) -> tuple[Sector, ...]:
        """Range of the head, and views of the cameras on the torso."""
        return self.perception.views

    @property
    def forward(self) -> "ForwardKinematics | None":
        """Kinematics of the body that the camera looks from."""
        body = self.perception.kinematics
        return None if body is None else body.forward

    def aim(self, targets: Array) -> None:
        """Turn the head to the last known position of the opponent."""
        self.perception.aim(targets)
