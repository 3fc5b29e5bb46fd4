"""What the robots' cameras saw, beside the scene of a film."""

from math import atan, cos, degrees, sin
from typing import Any

import numpy as np

from ..core.errors import ConfigurationError, ModelError
from ..core.poses import Array
from ..games.run import Run
from ..perception.images import Pixels
from ..robots.description import load_robot
from ..robots.head import load_head
from ..sim.offscreen_rendering import PLAIN, OffscreenRenderer
from ..sim.room_furnishing import HIDDEN
from .film_captions import chip
from .palette import colours_in
from .scene import RunScene

BELIEVED = (30, 170, 60)  # red, green and blue of where it takes the other
MOST = 2  # pictures beside the scene
WITH_WALLS = PLAIN._replace(groups=HIDDEN + 1)


def room_beside(width: int, height: int) -> int:
    """Columns beside the scene for pictures of four to three, two high."""
    return min(2 * round(height / 3), 2 * (width // 4))


class FilmInsets:
    """Draws what robots see, with the tick of where they take the other.

    As the sensors draw, without shadows: a film shows what a robot had.
    """

    def __init__(
        self, run: Run, stage: RunScene, backend: str, size: tuple[int, int]
    ) -> None:
        """Open the eyes of the robots of a run.

        Args:
            run: The run.
            stage: Its bodies.
            backend: What draws.
            size: Columns and rows of all pictures together, in [pixels].

        Raises:
            ConfigurationError: If no robot of the run has a camera.
        """
        self._run, self._stage = run, stage
        cameras = dict(list(_cameras(run).items())[:MOST])
        if not cameras:
            raise ConfigurationError(
                f"camera split needs a robot with a camera, and run "
                f"{run.name} has none"
            )
        self._width, self._height = size[0], size[1] // len(cameras)
        self._seen = seen = _model_of(run)
        vertical = 2.0 * atan(0.5 * seen.height / seen.focal_y)
        self._cameras: dict[str, int] = {}
        for name, camera in cameras.items():
            number = stage.model.camera(f"{name}/{camera}").id
            self._cameras[name] = number
            stage.model.cam_fovy[number] = degrees(vertical)
        self._screen = OffscreenRenderer(
            stage.model, seen.width, seen.height, backend, WITH_WALLS
        )

    def picture(self, index: int) -> Pixels:
        """Pictures of a sample, one above the other."""
        drawn = [self._one(name, index) for name in self._cameras]
        return np.concatenate(drawn)

    def _one(self, name: str, index: int) -> Pixels:
        """What one robot sees. Shape (height, width, 3)."""
        from PIL import Image, ImageDraw

        stage, number = self._stage, self._cameras[name]
        image = Image.fromarray(self._screen.draw(stage.data, number))
        image = image.resize((self._width, self._height))
        pen = ImageDraw.Draw(image, "RGBA")
        column = self._believed(name, index, number)
        if column is not None:
            x, tall = column * self._width, self._height
            pen.line((x, 0.9 * tall, x, tall), BELIEVED, max(2, tall // 90))
        size = max(9, self._height // 16)
        colour = colours_in("light", self._run.players)[name]
        at = 0.28 * self._width, 1.9 * size
        chip(pen, f"{name} sees", at, colour, size)
        return np.asarray(image)

    def _believed(self, name: str, index: int, number: int) -> float | None:
        """Where a robot takes the other to be, as a share of the columns."""
        track, data = self._run.tracks[name], self._stage.data
        rows, now = track.sight, self._run.times[index]
        if rows is None or not len(rows) or rows[0, 0] > now:
            return None
        row = rows[int(np.searchsorted(rows[:, 0], now, side="right")) - 1]
        bearing, distance = row[1:3].tolist()
        x, y, heading = track.torso[index].tolist()
        place = np.array(
            [
                x + distance * cos(heading + bearing),
                y + distance * sin(heading + bearing),
                float(data.cam_xpos[number, 2]),
            ]
        )
        frame: Array = data.cam_xmat[number].reshape(3, 3)
        right, _, back = (place - data.cam_xpos[number]) @ frame
        if not back < -1e-6:  # a camera of MuJoCo looks along its -z
            return None
        half = 0.5 * self._seen.width / self._seen.focal_x
        column = 0.5 + 0.5 * float(right / -back) / half
        return column if 0.0 <= column <= 1.0 else None

    def close(self) -> None:
        """Let go of the graphics."""
        self._screen.close()


def _cameras(run: Run) -> dict[str, str]:
    """Camera of each robot that has one."""
    found = {}
    for name in run.robots:
        try:
            head = load_head(load_robot(run.settings.robot_of(name).robot))
        except ModelError:
            continue
        found[name] = head.camera
    return found


def _model_of(run: Run) -> Any:
    """The colour camera of the robots of a run."""
    cameras = getattr(run.settings, "cameras", None)
    if cameras is None:
        from ..sim.camera_settings import CameraSettings

        cameras = CameraSettings()
    return cameras.colour.model()
