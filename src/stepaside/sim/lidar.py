"""Simulated lidar above the head of a robot."""

import mujoco
import numpy as np

from ..core.random_streams import named_generator
from ..perception.images import LidarScan
from ..robots.geom_points import geom_points_in_world
from ..robots.head import Mount
from .camera_settings import LidarSettings
from .ray_casting import RayCaster
from .sensor_stream import SensorStream, StreamedSensors, period_of
from .world import World

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
        self._mount = Mount(np.array([0.0, 0.0, height]), np.eye(3))
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
