"""True state of players, and ideal sensors of it."""

from collections import deque
from collections.abc import Sequence
from math import atan2, cos, hypot, radians, sin
from typing import NamedTuple

import mujoco
import numpy as np

from ..core.player_identity import PlayerIdentity
from ..core.poses import Array, Pose, wrap_angle
from ..perception.measurement import Sighting
from ..robots.description_types import ReferencePoint
from .physics_settings import SightSettings

FALLEN = cos(radians(45.0))  # upward component of the torso's axis


class FloorTruth:
    """True state of a player that physics does not move."""

    has_fallen = False

    def __init__(self, pose: Pose, *, reach: float, height: float) -> None:
        self.pose, self.reach, self._height = pose, reach, height

    @property
    def position_com_in_world(self) -> Array:
        """Position at the height of the CoM, in [m]. Shape (3,)."""
        return np.array([*self.pose[:2], self._height], np.float64)

    @property
    def position_torso_in_world(self) -> tuple[float, float]:
        """Position, in [m]."""
        return self.pose[:2]

    position_reference_in_world = position_torso_in_world

    @property
    def heading_in_world(self) -> float:
        """Heading, in [rad]."""
        return self.pose.theta


class TrueRobotState:
    """True state of one robot in its world; arrays are views.

    The reference point is midway between the feet of a standing robot, and
    moves with the CoM of a walking one. Around the torso, ``reach`` [m]
    contains the whole robot.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        torso: str,
        *,
        com_forward: float = 0.0,
        place: ReferencePoint | None = None,
    ) -> None:
        self._com_forward = com_forward
        place = place or ReferencePoint()
        self._hips_forward, self.reach = place.forward, place.reach
        root = model.body(torso).id
        self.origin_torso_in_world: Array = data.xpos[root]
        self.axes_torso_in_world: Array = data.xmat[root]
        self.position_com_in_world: Array = data.subtree_com[root]

    @property
    def position_torso_in_world(self) -> tuple[float, float]:
        """Point midway between the hips, in [m]."""
        origin, axes = self.origin_torso_in_world, self.axes_torso_in_world
        ahead = self._hips_forward
        return (
            origin.item(0) + ahead * axes.item(0),
            origin.item(1) + ahead * axes.item(3),
        )

    @property
    def position_reference_in_world(self) -> tuple[float, float]:
        """Reference point, in [m]."""
        x, y, _ = self.position_com_in_world.tolist()
        heading, ahead = self.heading_in_world, self._com_forward
        return x - ahead * cos(heading), y - ahead * sin(heading)

    @property
    def heading_in_world(self) -> float:
        """Heading of the torso, in [rad]."""
        axes = self.axes_torso_in_world
        return atan2(axes.item(3), axes.item(0))

    def places(self, com: Array, origin: Array, axes: Array) -> list[Array]:
        """Return reference points and torsos, with headings, of samples.

        They are samples of the three arrays. Shapes (n, 3).
        """
        heading = np.arctan2(axes[:, 3], axes[:, 0])
        ahead = np.stack([np.cos(heading), np.sin(heading)], axis=1)
        points = (
            com[:, :2] - self._com_forward * ahead,
            origin[:, :2] + self._hips_forward * axes[:, [0, 3]],
        )
        return [np.column_stack([point, heading]) for point in points]

    @property
    def has_fallen(self) -> bool:
        """Whether the torso leans by more than 45 degrees."""
        return self.axes_torso_in_world.item(8) < FALLEN


GroundTruth = FloorTruth | TrueRobotState
"""True state of a player: a robot, a person or a template."""


def torsos_apart(one: GroundTruth, other: GroundTruth) -> float:
    """Return the horizontal distance between two torsos, in [m]."""
    (x, y) = one.position_torso_in_world
    (u, v) = other.position_torso_in_world
    return hypot(u - x, v - y)


class TrueStance(NamedTuple):
    """Torso, feet and velocity of a robot in its world."""

    velocity: tuple[float, float]  # CoM velocity (x, y) [m/s]
    tilt: tuple[float, float]  # roll and pitch of the torso [rad]
    left_sole: Pose
    right_sole: Pose


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
