"""Cameras of films: fixed on all paths, following, from above.

A camera frames a set of points. The distance from which all of them are in
the image has a closed form, since each point is in it from some distance on.
"""

from itertools import product
from math import cos, radians, sin, tan
from typing import NamedTuple

import mujoco
import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from ..core.poses import Array
from ..games.run import Run
from ..sim.room_furnishing import HEIGHT as WALL_HEIGHT
from .overlays import circle_of, ring
from .scene import wall_corners

AZIMUTH, ELEVATION = 60.0, -32.0  # of the fixed and following view, in [deg]
MARGIN = 0.86  # fraction of the image's half sides that points may take
HEIGHT = 0.62  # of a player with its label, in [m]
CENTERING_STEPS = 4  # iterations that center a view
HALF_WIDTH = 0.15  # of a player, in [m]
PERIOD = 0.1  # between the views that a following camera smooths, in [s]
SMOOTHING = 1.5  # standard deviation of its Gaussian window, in [s]


class CameraView(NamedTuple):
    """Camera that looks at a point."""

    target: Array  # in the world, in [m]. Shape (3,)
    distance: float  # from the camera to the target, in [m]
    azimuth: float = AZIMUTH  # direction in which it looks, in [deg]
    elevation: float = ELEVATION  # negative from above, in [deg]

    @property
    def axes(self) -> Array:
        """Rows: right, up and ahead, in the world. Shape (3, 3)."""
        a, e = radians(self.azimuth), radians(self.elevation)
        ahead = np.array([cos(e) * cos(a), cos(e) * sin(a), sin(e)])
        right = np.array([sin(a), -cos(a), 0.0])
        return np.array([right, np.cross(right, ahead), ahead])

    @property
    def eye(self) -> Array:
        """Position of the camera, in the world, in [m]. Shape (3,)."""
        position: Array = self.target - self.distance * self.axes[2]
        return position

    def project(self, point: Array, fovy: float) -> tuple[float, float] | None:
        """Return the image of a point (3,) in [m], in half heights.

        It is rightward and upward from the center, for a vertical field of
        view in [deg]; None behind the camera.
        """
        right, up, ahead = (self.axes @ (point - self.target)).tolist()
        depth = self.distance + ahead
        if depth <= 0.05:
            return None
        scale = depth * tan(0.5 * radians(fovy))
        return right / scale, up / scale

    def camera(self) -> mujoco.MjvCamera:
        """Return the same view as a camera of MuJoCo."""
        camera = mujoco.MjvCamera()
        camera.type = mujoco.mjtCamera.mjCAMERA_FREE
        camera.lookat[:] = self.target
        camera.distance = self.distance
        camera.azimuth, camera.elevation = self.azimuth, self.elevation
        return camera


def framing(
    points: Array, view: CameraView, fovy: float, aspect: float
) -> CameraView:
    """Return the nearest view that has all points in the image.

    Args:
        points: In the world, in [m]. Shape (n, 3).
        view: View with the direction in which the camera looks.
        fovy: Vertical field of view, in [deg].
        aspect: Width over height of the image.
    """
    slope = MARGIN * tan(0.5 * radians(fovy))
    target = 0.5 * (points.min(axis=0) + points.max(axis=0))
    for step in range(CENTERING_STEPS + 1):
        right, up, ahead = view.axes @ (points - target).T
        depth = np.maximum(abs(up) / slope, abs(right) / (aspect * slope))
        distance = float((depth - ahead).max())
        if step < CENTERING_STEPS:
            # Perspective: the image's center is not that of the box.
            image = np.array([right, up]) / (distance + ahead)
            center = 0.5 * (image.min(axis=1) + image.max(axis=1))
            target = target + distance * (center @ view.axes[:2])
    return view._replace(target=target, distance=distance)


class FilmCamera:
    """Camera of a film, with a view for every sample of the run."""

    def __init__(self, run: Run, name: str, fovy: float, aspect: float):
        """Plan the views of a run.

        Args:
            run: The run.
            name: One of :data:`~stepaside.report.film_settings.VIEWS`.
            fovy: Vertical field of view, in [deg].
            aspect: Width over height of the image.
        """
        self._run, self._name = run, name
        self._lens = fovy, aspect
        self._whole = self._frame(slice(None))
        if name == "follow":
            self._times, self._views = self._smoothed_views()

    @property
    def reach(self) -> float:
        """Radius of the visible floor around the target, in [m]."""
        if self._name == "follow":
            return 1.3 * float(self._views[:, 3].max())
        return (1.6 if self._name == "top" else 1.3) * self._whole.distance

    def view(self, index: int) -> CameraView:
        """Return the view of a sample of the run."""
        if self._name != "follow":
            return self._whole
        now = self._run.times[index]
        *target, distance = (
            float(np.interp(now, self._times, column))
            for column in self._views.T
        )
        return CameraView(np.array(target), distance)

    def _frame(self, chosen: slice) -> CameraView:
        """Return the view of some samples; of all, with circle and walls."""
        sides = (-HALF_WIDTH, HALF_WIDTH)
        corners = np.array([*product(sides, sides, (0.0, HEIGHT))])
        tracks = self._run.tracks.values()
        paths = np.concatenate([track.torso[chosen, :2] for track in tracks])
        on_floor = np.column_stack([paths, np.zeros(len(paths))])
        found = [(on_floor[:, None] + corners).reshape(-1, 3)]
        view = CameraView(np.zeros(3), 0.0)
        if self._name == "top":
            view = view._replace(azimuth=90.0, elevation=-89.9)
            tops = wall_corners(self._run.plan)
            height = np.full(len(tops), WALL_HEIGHT)
            found.append(np.column_stack([tops, height]))
        circle = circle_of(self._run) if chosen == slice(None) else None
        if circle is not None:
            edge = ring(*circle)[:, 0]
            found.append(np.column_stack([edge, np.zeros(len(edge))]))
        return framing(np.concatenate(found), view, *self._lens)

    def _smoothed_views(self) -> tuple[Array, Array]:
        """Return times, and rows (target x, y, z, distance), smoothed."""
        times = self._run.times
        gap = float(times[1] - times[0]) if len(times) > 1 else PERIOD
        every = max(1, round(PERIOD / gap))
        chosen = np.arange(0, len(times), every)
        views = [self._frame(slice(i, i + 1)) for i in chosen]
        rows = np.array([[*v.target, v.distance] for v in views])
        width = SMOOTHING / (every * gap)
        # The largest distance in the window keeps all players in the image.
        window = 2 * round(3.0 * width) + 1
        far = maximum_filter1d(rows[:, 3], window, mode="nearest")
        rows[:, 3] = far + 0.15
        smooth: Array = gaussian_filter1d(
            rows, width, axis=0, mode="nearest", truncate=3.0
        )
        return times[chosen], smooth
