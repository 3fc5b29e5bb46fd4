"""Ideal sensors of the opponent and of the own pose."""

from collections import deque
from math import atan2, hypot

import numpy as np

from ..core.poses import Pose, wrap_angle
from ..perception.measurement import Sighting
from .ground_truth import GroundTruth
from .physics_settings import SightSettings


class IdealLineOfSight:
    """Sensor of the true bearing and distance of the opponent.

    The bearing is measured from the heading of the own torso, between the
    reference points. The sensor replaces cameras; its settings add noise,
    delay and a rate.
    """

    def __init__(
        self,
        own: GroundTruth,
        opponent: GroundTruth,
        settings: SightSettings,
        generator: np.random.Generator,
    ) -> None:
        """Measure the opponent from a robot."""
        self._own, self._opponent = own, opponent
        self._settings = settings
        self._generator = generator
        self._pending: deque[Sighting] = deque()
        self._latest: Sighting | None = None
        self._count = 0

    @property
    def is_exact(self) -> bool:
        """Whether sightings have no noise, delay or rate.

        Such a sensor may be read at some ticks only.
        """
        return self._settings == SightSettings()

    def read(self, now: float) -> Sighting | None:
        """Return the latest sighting that has arrived at a time, in [s]."""
        settings = self._settings
        if now * settings.rate >= self._count - 1e-9 or now == 0.0:
            self._count = 1 if now == 0.0 else self._count + 1
            self._pending.append(self._measure(now))
        while (
            self._pending
            and self._pending[0].time <= now - settings.delay + 1e-9
        ):
            self._latest = self._pending.popleft()
        return self._latest

    def _measure(self, now: float) -> Sighting:
        x, y = self._own.position_reference_in_world
        u, v = self._opponent.position_reference_in_world
        bearing = atan2(v - y, u - x) - self._own.heading_in_world
        distance = hypot(u - x, v - y)
        settings = self._settings
        if settings.bearing_noise > 0.0:
            bearing += settings.bearing_noise * self._generator.normal()
        if settings.distance_noise > 0.0:
            distance += settings.distance_noise * self._generator.normal()
        return Sighting(now, wrap_angle(bearing), max(distance, 0.0))


class IdealPose:
    """Sensor of the true CoM and heading of a robot in its room.

    It replaces localisation on a given map.
    """

    def __init__(self, own: GroundTruth) -> None:
        """Measure the pose of a robot."""
        self._own = own

    def read(self) -> Pose:
        """Return the CoM on the floor, [m], and the torso heading, [rad]."""
        x, y, _ = self._own.position_com_in_world.tolist()
        return Pose(x, y, self._own.heading_in_world)
