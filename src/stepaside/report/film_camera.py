"""Where the camera of a film stands: whole ways in view, or along with them.

What shall be seen are points; how far away a camera has to be for all of them
is closed form, since each lies within the picture from some distance on.
"""

from math import atan2, cos, degrees, hypot, radians, sin, tan
from typing import NamedTuple

import mujoco
import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Array
from ..games.run import Run
from ..sim.obstacle_geoms import HEIGHT as WALLS
from .room_extent import wall_corners

VIEWS = ("fixed", "follow", "top", "eyes", "split")
AZIMUTH, ELEVATION = 60.0, -32.0  # of a camera that stands, in [deg]
MARGIN = 0.86  # of the picture's half sides that points may take
HEIGHT = 0.62  # of what stands where a player is, with its name, in [m]
CENTRED = 4  # times that a view is centred
ASIDE = 0.15  # of what is beside it, in [m]
EYES = 0.2, 0.09  # of the evader, above and before its torso's middle, in [m]
EVERY = 0.1  # between the views from which one that follows is made, in [s]
CALM = 1.5  # standard deviation over which they are averaged, in [s]


class CameraView(NamedTuple):
    """A camera that looks at a point.

    Attributes:
        target: What it looks at, in the world, in [m]. Shape (3,).
        distance: How far away it is, in [m].
        azimuth: Direction in which it looks, in [deg].
        elevation: Negative from above, in [deg].
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
        """Place of the camera, in the world, in [m]. Shape (3,)."""
        place: Array = self.target - self.distance * self.axes[2]
        return place

    def project(self, point: Array, fovy: float) -> tuple[float, float] | None:
        """Place of a point in the picture, in half heights from its middle.

        Args:
            point: In the world, in [m]. Shape (3,).
            fovy: Vertical field of view, in [deg].

        Returns:
            Rightward and upward; None behind the camera.
        """
        right, up, ahead = (self.axes @ (point - self.target)).tolist()
        away = self.distance + ahead
        if away <= 0.05:
            return None
        scale = away * tan(0.5 * radians(fovy))
        return right / scale, up / scale

    def camera(self) -> mujoco.MjvCamera:
        """The same for MuJoCo."""
        camera = mujoco.MjvCamera()
        camera.type = mujoco.mjtCamera.mjCAMERA_FREE
        camera.lookat[:] = self.target
        camera.distance = self.distance
        camera.azimuth, camera.elevation = self.azimuth, self.elevation
        return camera


def framing(
    points: Array, azimuth: float, elevation: float, fovy: float, aspect: float
) -> CameraView:
    """View from which all points are in the picture, from as near as can be.

    Args:
        points: In the world, in [m]. Shape (n, 3).
        azimuth: Direction in which it looks, in [deg].
        elevation: Likewise.
        fovy: Vertical field of view, in [deg].
        aspect: Width over height of the picture.
    """
    target = 0.5 * (points.min(axis=0) + points.max(axis=0))
    view = CameraView(target, 0.0, azimuth, elevation)
    high = MARGIN * tan(0.5 * radians(fovy))
    for _ in range(CENTRED):
        right, up, ahead = view.axes @ (points - view.target).T
        away = np.maximum(np.abs(up) / high, np.abs(right) / (aspect * high))
        distance = float((away - ahead).max())
        # What is near is seen larger: the middle of all is another one.
        seen = np.array([right, up]) / (distance + ahead)
        middle = 0.5 * (seen.min(axis=1) + seen.max(axis=1))
        shift = distance * (middle @ view.axes[:2])
        view = view._replace(target=view.target + shift)
    right, up, ahead = view.axes @ (points - view.target).T
    away = np.maximum(np.abs(up) / high, np.abs(right) / (aspect * high))
    return view._replace(distance=float((away - ahead).max()))


class FilmCamera:
    """Chooses the view of every moment of a film."""

    def __init__(self, run: Run, name: str, fovy: float, aspect: float):
        """Look at a run.

        Args:
            run: The run.
            name: One of ``VIEWS``.
            fovy: Vertical field of view, in [deg].
            aspect: Width over height of the picture.

        Raises:
            ConfigurationError: If nobody is there to be seen through eyes.
        """
        if name == "eyes" and run.pair is None:
            raise ConfigurationError(
                "camera eyes needs a run of two players, got one of "
                f"{len(run.players)}"
            )
        # Beside what the robots see, the scene is followed.
        name = "follow" if name == "split" else name
        self._run, self._name = run, name
        self._fovy, self._aspect = fovy, aspect
        self._whole = self._frame(slice(None), with_circle=True)
        if name == "follow":
            self._times, self._views = self._followed()

    @property
    def reach(self) -> float:
        """How far about what it looks at it sees the floor, in [m]."""
        if self._name == "follow":
            return 1.3 * float(self._views[:, 3].max())
        return (1.6 if self._name == "top" else 1.3) * self._whole.distance

    def view(self, index: int) -> CameraView:
        """View of a sample of the run."""
        if self._name == "follow":
            now = self._run.times[index]
            x, y, z, away = (
                float(np.interp(now, self._times, column))
                for column in self._views.T
            )
            return CameraView(np.array([x, y, z]), away, AZIMUTH, ELEVATION)
        return self._eyes(index) if self._name == "eyes" else self._whole

    def _frame(self, chosen: slice, *, with_circle: bool) -> CameraView:
        """View of the players over some samples."""
        corners = np.array(
            [
                [x, y, z]
                for x in (-ASIDE, ASIDE)
                for y in (-ASIDE, ASIDE)
                for z in (0.0, HEIGHT)
            ]
        )
        tracks = self._run.tracks.values()
        ways = [track.torso[chosen, :2] for track in tracks]
        every = np.concatenate(ways)
        places = np.column_stack([every, np.zeros(len(every))])
        points = (places[:, None] + corners).reshape(-1, 3)
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
            high = np.full(len(corners), WALLS)
            points = np.concatenate([points, np.column_stack([corners, high])])
        azimuth, elevation = (90.0, -89.9) if top else (AZIMUTH, ELEVATION)
        return framing(points, azimuth, elevation, self._fovy, self._aspect)

    def _followed(self) -> tuple[Array, Array]:
        """Times, and rows (target x, y, z, distance), calm and wide enough."""
        times = self._run.times
        gap = float(times[1] - times[0]) if len(times) > 1 else EVERY
        every = max(1, round(EVERY / gap))
        chosen = np.arange(0, len(times), every)
        views = [
            self._frame(slice(i, i + 1), with_circle=False) for i in chosen
        ]
        rows = np.array([[*v.target, v.distance] for v in views])
        half = round(3.0 * CALM / (every * gap))
        # As far as it ever has to be nearby: then nobody is cut.
        padded = np.pad(rows[:, 3], half, mode="edge")
        windows = np.lib.stride_tricks.sliding_window_view(
            padded, 2 * half + 1
        )
        rows[:, 3] = windows.max(axis=1) + 0.15
        kernel = np.exp(-0.5 * np.linspace(-3.0, 3.0, 2 * half + 1) ** 2)
        kernel /= kernel.sum()
        for column in rows.T:
            wide = np.pad(column, half, mode="edge")
            column[:] = np.convolve(wide, kernel, mode="valid")
        return times[chosen], rows

    def _eyes(self, index: int) -> CameraView:
        """From the head of the second player to the first."""
        over, before = EYES
        assert self._run.pair is not None
        first, second = self._run.pair
        pursuer, evader = (t.torso[index, :2] for t in (first, second))
        com = float(second.com[index, 2])
        toward = pursuer - evader
        apart = max(float(hypot(*toward)), 1e-6)
        eye = np.array([*(evader + before * toward / apart), com + over])
        seen = float(first.com[index, 2])
        target = np.array([*pursuer, seen])
        ahead = target - eye
        flat = float(hypot(ahead[0], ahead[1]))
        return CameraView(
            target,
            float(np.linalg.norm(ahead)),
            degrees(atan2(ahead[1], ahead[0])),
            degrees(atan2(ahead[2], flat)),
        )
