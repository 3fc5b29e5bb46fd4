"""Cameras of films: fixed on all paths, following, from above.

A camera frames a set of points. The distance from which all of them are in
the image has a closed form, since each point is in it from some distance on.
"""

from math import cos, radians, sin, tan
from typing import NamedTuple

import mujoco
import numpy as np

from ..core.poses import Array
from ..games.run import Run
from ..sim.room_furnishing import HEIGHT as WALL_HEIGHT
from .scene import wall_corners

AZIMUTH, ELEVATION = 60.0, -32.0  # of the fixed and following view, in [deg]
MARGIN = 0.86  # fraction of the image's half sides that points may take
HEIGHT = 0.62  # of a player with its label, in [m]
CENTERING_STEPS = 4  # iterations that center a view
HALF_WIDTH = 0.15  # of a player, in [m]
PERIOD = 0.1  # between the views that a following camera smooths, in [s]
SMOOTHING = 1.5  # standard deviation of its Gaussian window, in [s]


class CameraView(NamedTuple):
    """Camera that looks at a point.

    Attributes:
        target: Point that it looks at, in the world, in [m]. Shape (3,).
        distance: From the camera to the target, in [m].
        azimuth: Direction in which it looks, in [deg].
        elevation: Elevation of that direction, in [deg]; negative from above.
    """

    target: Array
    distance: float
    azimuth: float
    elevation: float

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
        """Return the image of a point, in half heights from the center.

        Args:
            point: In the world, in [m]. Shape (3,).
            fovy: Vertical field of view, in [deg].

        Returns:
            Rightward and upward; None behind the camera.
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
    points: Array, azimuth: float, elevation: float, fovy: float, aspect: float
) -> CameraView:
    """Return the nearest view that has all points in the image.

    Args:
        points: In the world, in [m]. Shape (n, 3).
        azimuth: Direction in which the camera looks, in [deg].
        elevation: Elevation of that direction, in [deg].
        fovy: Vertical field of view, in [deg].
        aspect: Width over height of the image.
    """
    target = 0.5 * (points.min(axis=0) + points.max(axis=0))
    view = CameraView(target, 0.0, azimuth, elevation)
    slope = MARGIN * tan(0.5 * radians(fovy))
    for _ in range(CENTERING_STEPS):
        right, up, ahead = view.axes @ (points - view.target).T
        depth = _least_depth(right, up, slope, aspect)
        distance = float((depth - ahead).max())
        # Perspective: the center of the image is not the center of the box.
        image = np.array([right, up]) / (distance + ahead)
        center = 0.5 * (image.min(axis=1) + image.max(axis=1))
        shift = distance * (center @ view.axes[:2])
        view = view._replace(target=view.target + shift)
    right, up, ahead = view.axes @ (points - view.target).T
    depth = _least_depth(right, up, slope, aspect)
    return view._replace(distance=float((depth - ahead).max()))


def _least_depth(
    right: Array, up: Array, slope: float, aspect: float
) -> Array:
    """Return the depths from which on points are in the image, in [m]."""
    depth: Array = np.maximum(
        np.abs(up) / slope, np.abs(right) / (aspect * slope)
    )
    return depth


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
        self._fovy, self._aspect = fovy, aspect
        self._whole = self._frame(slice(None), with_circle=True)
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
        if self._name == "follow":
            now = self._run.times[index]
            x, y, z, distance = (
                float(np.interp(now, self._times, column))
                for column in self._views.T
            )
            target = np.array([x, y, z])
            return CameraView(target, distance, AZIMUTH, ELEVATION)
        return self._whole

    def _frame(self, chosen: slice, *, with_circle: bool) -> CameraView:
        """Return the view that frames the players over some samples."""
        corners = np.array(
            [
                [x, y, z]
                for x in (-HALF_WIDTH, HALF_WIDTH)
                for y in (-HALF_WIDTH, HALF_WIDTH)
                for z in (0.0, HEIGHT)
            ]
        )
        tracks = self._run.tracks.values()
        paths = np.concatenate([track.torso[chosen, :2] for track in tracks])
        on_floor = np.column_stack([paths, np.zeros(len(paths))])
        points = (on_floor[:, None] + corners).reshape(-1, 3)
        if with_circle and self._run.circle is not None:
            x, y, radius = self._run.circle
            angle = np.linspace(0.0, 2.0 * np.pi, 37)
            ring = [x + radius * np.cos(angle), y + radius * np.sin(angle)]
            points = np.concatenate(
                [points, np.column_stack([*ring, np.zeros(37)])]
            )
        top = self._name == "top"
        if top and with_circle:
            corners = wall_corners(self._run.plan)
            height = np.full(len(corners), WALL_HEIGHT)
            tops = np.column_stack([corners, height])
            points = np.concatenate([points, tops])
        azimuth, elevation = (90.0, -89.9) if top else (AZIMUTH, ELEVATION)
        return framing(points, azimuth, elevation, self._fovy, self._aspect)

    def _smoothed_views(self) -> tuple[Array, Array]:
        """Return times, and rows (target x, y, z, distance), smoothed."""
        times = self._run.times
        gap = float(times[1] - times[0]) if len(times) > 1 else PERIOD
        every = max(1, round(PERIOD / gap))
        chosen = np.arange(0, len(times), every)
        views = [
            self._frame(slice(i, i + 1), with_circle=False) for i in chosen
        ]
        rows = np.array([[*v.target, v.distance] for v in views])
        half = round(3.0 * SMOOTHING / (every * gap))
        # The largest distance in the window keeps all players in the image.
        padded = np.pad(rows[:, 3], half, mode="edge")
        windows = np.lib.stride_tricks.sliding_window_view(
            padded, 2 * half + 1
        )
        rows[:, 3] = windows.max(axis=1) + 0.15
        kernel = np.exp(-0.5 * np.linspace(-3.0, 3.0, 2 * half + 1) ** 2)
        kernel /= kernel.sum()
        for column in rows.T:
            padded = np.pad(column, half, mode="edge")
            column[:] = np.convolve(padded, kernel, mode="valid")
        return times[chosen], rows
