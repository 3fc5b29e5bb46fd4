"""Sensors with rates and latencies, rays from them, and a lidar."""

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Generic, TypeVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array
from ..core.random_streams import named_generator
from ..perception.images import AnyPercept, LidarScan
from ..robots.geom_points import geom_points_in_world
from ..robots.head import Mount
from .camera_settings import LidarSettings
from .world import World

T = TypeVar("T", bound=AnyPercept)


@dataclass(slots=True, eq=False)
class SensorStream(Generic[T]):
    """Sensor with a rate, a latency and losses."""

    take: Callable[[float], T]  # function that returns a percept at a time
    period: float  # period of the exposures [s]
    latency: float  # delay from exposure to arrival [s]
    drop: float  # fraction of lost percepts
    generator: np.random.Generator  # random generator of the losses
    taken: int = 0  # number of exposures
    # times of arrival and percepts that have not arrived
    pending: deque[tuple[float, T]] = field(default_factory=deque)

    @property
    def due(self) -> float:
        """Time of the next exposure or arrival, in [s]."""
        due = self.taken * self.period
        if self.pending:
            due = min(due, self.pending[0][0])
        return due - 1e-9

    def read(self, now: float, exposed: list[T]) -> list[T]:
        """Return what has arrived; take and expose a percept when due."""
        if now >= self.taken * self.period - 1e-9:
            self.taken += 1
            if self.drop == 0.0 or self.generator.random() >= self.drop:
                percept = self.take(now)
                exposed.append(percept)
                self.pending.append((now + self.latency, percept))
        arrived = []
        while self.pending and self.pending[0][0] <= now + 1e-9:
            arrived.append(self.pending.popleft()[1])
        return arrived


class StreamedSensors(Generic[T]):
    """Sensors of one robot, and what they took before its latency."""

    def __init__(self, streams: Sequence[SensorStream[T]]) -> None:
        self._streams, self._due = streams, 0.0
        self.exposed: list[T] = []

    def read(self, now: float) -> tuple[T, ...]:
        """Return the percepts that arrive at a tick."""
        self.exposed.clear()
        if now < self._due:
            return ()
        arrived: list[T] = []
        for stream in self._streams:
            arrived += stream.read(now, self.exposed)
        self._due = min(stream.due for stream in self._streams)
        return tuple(arrived)

    def close(self) -> None:
        """Release graphics, if any."""


def period_of(rate: float, tick: float) -> float:
    """Return the multiple of a tick [s] that is nearest to a rate [1/s]."""
    return max(1, round(1.0 / rate / tick)) * tick


VISIBLE = np.array([1, 1, 1, 0, 0, 0], dtype=np.uint8)  # geom groups
HIDDEN = 5  # geom group that no sensor shows
# MuJoCo drops a plane whose origin is beyond the cutoff: a floor would vanish
# before robots far from the origin of the world.
UNLIMITED = 1e10  # cutoff, in [m]


class RayCaster:
    """Rays from a mount on a body, which they ignore; misses are -1.

    Origin [m], directions and normals are in the world; ``along`` is the depth
    along the mount axis per distance.

    A rangefinder of MuJoCo on a camera gives equal depths only within 1e-7 m,
    as its intrinsics are single precision. It tells no geoms, has no groups
    that it ignores, and cannot look all around.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        body: str,
        mount: Mount,
        rays: Array,
    ) -> None:
        self._model, self._data = model, data
        self._body, self._mount = model.body(body).id, mount
        lengths = np.linalg.norm(rays, axis=1)
        self._rays = rays / lengths[:, None]
        # Greatest slopes of rays of a camera, sideways and up, by which it
        # sees no geom beyond; a lidar looks all around.
        ahead = np.maximum(rays[:, :1], 0.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            self._edges = np.abs(rays[:, 1:] / ahead).max(axis=0)
        self.along = 1.0 / lengths
        self.geoms = np.zeros(len(rays), dtype=np.int32)
        self.distances = np.zeros(len(rays))
        self.normals = np.zeros((len(rays), 3))
        self.directions, self.origin = self._rays, np.zeros(3)

    def cast(self, cutoff: float = UNLIMITED) -> None:
        """Cast all rays up to a distance, in [m]; misses are -1."""
        model, data, body = self._model, self._data, self._body
        axes = data.xmat[body].reshape(3, 3)
        self.origin = data.xpos[body] + axes @ self._mount.position_in_body
        turned = axes @ self._mount.axes_in_body
        self.directions = self._rays @ turned.T
        hidden = self._hidden(turned)
        groups = model.geom_group
        shown = groups[hidden]
        groups[hidden] = HIDDEN
        mujoco.mj_multiRay(
            *(model, data, self.origin, self.directions.reshape(-1)),
            *(VISIBLE, True, body, self.geoms, self.distances),
            *(self.normals.reshape(-1), len(self.directions), cutoff),
        )
        groups[hidden] = shown

    def _hidden(self, turned: Array) -> NDArray[np.intp]:
        """Return the geoms whose bounding spheres no ray can meet."""
        reach = self._model.geom_rbound
        if not np.isfinite(self._edges).all():
            return np.zeros(0, dtype=np.intp)
        offsets = (self._data.geom_xpos - self.origin) @ turned
        aside = np.abs(offsets[:, 1:]) - self._edges * offsets[:, :1]
        beyond = aside > reach[:, None] * np.hypot(1.0, self._edges)
        # A plane has no bounding sphere.
        return np.flatnonzero(beyond.any(axis=1) & (reach > 0.0))

    @property
    def slants(self) -> Array:
        """Cosines of the angles of incidence. Shape (n,)."""
        slants: Array = np.abs(
            np.einsum("ij,ij->i", self.directions, self.normals)
        )
        return slants


RINGS = (0.0, -10.0, -25.0, -40.0)  # elevations, in [deg]
ABOVE = 0.05  # of the lidar over the highest point of the robot, in [m]
STEEPEST = 0.1  # cosine of the incidence below which nothing returns


class Lidar(StreamedSensors[LidarScan]):
    """Lidar that scans all around, with returns in the frame of the torso.

    Returns of the own body are left out, as with a mask on a real robot.
    """

    def __init__(
        self,
        world: World,
        name: str,
        torso: str,
        settings: LidarSettings,
        seed: int,
    ) -> None:
        model, data = world.model, world.data
        self._settings = settings
        self._generator = named_generator(seed, f"lidar/{name}")
        body = model.body(f"{name}/{torso}").id
        roots = model.body_rootid[model.geom_bodyid]
        self._own = roots == model.body_rootid[body]
        mujoco.mj_kinematics(model, data)
        top = max(
            float(geom_points_in_world(model, data, int(i))[:, 2].max())
            for i in np.flatnonzero(self._own)
        )
        height = top - float(data.xpos[body, 2]) + ABOVE
        self._mount = Mount((0.0, 0.0, height))
        around = np.arange(settings.rays) * (2.0 * np.pi / settings.rays)
        self._rays = np.concatenate(
            [_ring(around, np.radians(degrees)) for degrees in RINGS]
        )
        self._caster = RayCaster(
            model, data, f"{name}/{torso}", self._mount, self._rays
        )
        stream = SensorStream(
            self._take,
            period_of(settings.rate, world.physics.tick),
            settings.latency,
            0.0,
            self._generator,
        )
        super().__init__([stream])

    def _take(self, now: float) -> LidarScan:
        """Take a scan."""
        settings, caster = self._settings, self._caster
        caster.cast(settings.far)
        ranges, draw = caster.distances, self._generator
        ranges = ranges + settings.noise * draw.standard_normal(ranges.size)
        returned = draw.random(ranges.size) >= settings.missing
        returned &= (caster.distances > 0.0) & (caster.slants > STEEPEST)
        returned &= (ranges > settings.near) & ~self._own[caster.geoms]
        hits = ranges[returned, None] * self._rays[returned]
        return LidarScan(now, self._mount.position_in_body + hits)


def _ring(around: np.ndarray, elevation: float) -> np.ndarray:
    """Return the unit rays of one elevation, in [rad]. Shape (n, 3)."""
    flat = np.cos(elevation)
    height = np.full_like(around, np.sin(elevation))
    return np.column_stack(
        [flat * np.cos(around), flat * np.sin(around), height]
    )
