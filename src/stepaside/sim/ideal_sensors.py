"""Ideal sensors of the opponent and of the own pose."""

from collections import deque
from collections.abc import Sequence
from math import atan2, hypot

import numpy as np

from ..core.player_identity import PlayerIdentity
from ..core.poses import wrap_angle
from ..perception.measurement import Sighting
from .ground_truth import GroundTruth
from .physics_settings import SightSettings

HALF_WIDTH = 0.35  # of a body that hides others, relative to its reach
TALL_ENOUGH = 0.8  # CoM height of a body that hides another, relative to it


class IdealLineOfSight:
    """Sensor of the true bearing and distance between reference points.

    Settings add noise, delay and a rate. Bodies of other players may hide the
    player; then the latest sighting stays.
    """

    def __init__(
        self,
        own: GroundTruth,
        opponent: GroundTruth,
        settings: SightSettings,
        generator: np.random.Generator,
        *,
        identity: PlayerIdentity | None = None,
        between: Sequence[GroundTruth] = (),
    ) -> None:
        self._own, self._opponent = own, opponent
        self._settings = settings
        self._generator = generator
        self._pending: deque[Sighting] = deque()
        self._latest: Sighting | None = None
        self._count = 0
        self._identity, self._between = identity, tuple(between)

    @property
    def is_exact(self) -> bool:
        """Whether it has no noise, delay or rate: any tick may be left out."""
        return self._settings == SightSettings()

    def read(self, now: float) -> Sighting | None:
        """Return the latest sighting that has arrived at a time, in [s]."""
        settings = self._settings
        if now * settings.rate >= self._count - 1e-9 or now == 0.0:
            self._count = 1 if now == 0.0 else self._count + 1
            own, other = self._own, self._opponent
            if not any(hides(body, own, other) for body in self._between):
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
        return Sighting(
            now,
            wrap_angle(bearing),
            max(distance, 0.0),
            identity=self._identity,
        )


def hides(body: GroundTruth, eye: GroundTruth, seen: GroundTruth) -> bool:
    """Return whether a body of about its height hides a player."""
    x, y = eye.position_reference_in_world
    u, v = seen.position_reference_in_world
    p, q = body.position_reference_in_world
    dx, dy = u - x, v - y
    length = hypot(dx, dy)
    if length == 0.0:
        return False
    along = ((p - x) * dx + (q - y) * dy) / length
    across = abs((p - x) * dy - (q - y) * dx) / length
    if not (0.0 < along < length and across < HALF_WIDTH * body.reach):
        return False
    own, other = body.position_com_in_world, seen.position_com_in_world
    return bool(own[2] >= TALL_ENOUGH * other[2])
