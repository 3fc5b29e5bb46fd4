"""Ideal sensors of other and place: they know the truth and say so."""

from collections import deque
from math import atan2, hypot

import numpy as np

from ..core.poses import Pose, wrap_angle
from ..perception.measurement import Sighting
from .ground_truth import GroundTruth
from .physics_settings import SightSettings


class IdealLineOfSight:
    """Bearing and distance of the other's place from the own, by the truth.

    The bearing counts from the heading of the own torso. It stands in for
    cameras: noise, delay and rate are the only ways in which it is not
    ideal.
    """

    def __init__(
        self,
        own: GroundTruth,
        other: GroundTruth,
        settings: SightSettings,
        generator: np.random.Generator,
    ) -> None:
        """Look from one robot at another."""
        self._own, self._other = own, other
        self._settings = settings
        self._generator = generator
        self._pending: deque[Sighting] = deque()
        self._newest: Sighting | None = None
        self._taken = 0

    def read(self, now: float) -> Sighting | None:
        """Newest sighting that has arrived by ``now``, in [s]."""
        settings = self._settings
        if now * settings.rate >= self._taken - 1e-9 or now == 0.0:
            self._taken = 1 if now == 0.0 else self._taken + 1
            self._pending.append(self._look(now))
        while (
            self._pending
            and self._pending[0].time <= now - settings.delay + 1e-9
        ):
            self._newest = self._pending.popleft()
        return self._newest

    def _look(self, now: float) -> Sighting:
        x, y = self._own.place
        u, v = self._other.place
        bearing = atan2(v - y, u - x) - self._own.heading
        distance = hypot(u - x, v - y)
        settings = self._settings
        if settings.bearing_noise > 0.0:
            bearing += settings.bearing_noise * self._generator.normal()
        if settings.distance_noise > 0.0:
            distance += settings.distance_noise * self._generator.normal()
        return Sighting(now, wrap_angle(bearing), max(distance, 0.0))


class IdealPose:
    """CoM and heading of a robot in its room, by the truth.

    It stands in for whatever tells a robot where it is on a map that it was
    given.
    """

    def __init__(self, own: GroundTruth) -> None:
        """Tell the place of a robot."""
        self._own = own

    def read(self) -> Pose:
        """CoM over the floor, in [m], and heading of the torso, in [rad]."""
        x, y, _ = self._own.com.tolist()
        return Pose(x, y, self._own.heading)
