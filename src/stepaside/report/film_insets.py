"""Images of the robots' cameras beside the scene of a film."""

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
from .film_captions import draw_label
from .palette import colours_in
from .scene import RunScene

ESTIMATE_COLOUR = (30, 170, 60)  # red, green and blue of the estimated bearing
MAX_INSETS = 2
WITH_WALLS = PLAIN._replace(groups=HIDDEN + 1)


def inset_width(width: int, height: int) -> int:
    """Return the width of two stacked insets of 4 to 3, in [pixels].

    Args:
        width: Of the whole image, in [pixels].
        height: Of the whole image, in [pixels].
    """
    return min(2 * round(height / 3), 2 * (width // 4))


class FilmInsets:
    """Images of the robots' cameras with the estimated bearing as a tick.

    They are rendered like the sensors' images, without shadows.
    """

    def __init__(
        self, run: Run, scene: RunScene, backend: str, size: tuple[int, int]
    ) -> None:
        """Set up the cameras of the robots of a run.

        Args:
            run: The run.
            scene: Scene of the run.
            backend: Rendering backend.
            size: Width and height of all insets together, in [pixels].

        Raises:
            ConfigurationError: If no robot of the run has a camera.
        """
        self._run = run
        self._scene = scene
        cameras = dict(list(_cameras(run).items())[:MAX_INSETS])
        if not cameras:
            raise ConfigurationError(
                f"camera split needs a robot with a camera, and run "
                f"{run.name} has none"
            )
        self._width, self._height = size[0], size[1] // len(cameras)
        self._model = model = _camera_model_of(run)
        vertical = 2.0 * atan(0.5 * model.height / model.focal_y)
        self._cameras: dict[str, int] = {}
        for name, camera in cameras.items():
            number = scene.model.camera(f"{name}/{camera}").id
            self._cameras[name] = number
            scene.model.cam_fovy[number] = degrees(vertical)
        self._renderer = OffscreenRenderer(
            scene.model, model.width, model.height, backend, WITH_WALLS
        )

    def picture(self, index: int) -> Pixels:
        """Return the insets of a sample, stacked. Shape (height, width, 3)."""
        insets = [self._inset(name, index) for name in self._cameras]
        return np.concatenate(insets)

    def _inset(self, name: str, index: int) -> Pixels:
        """Return the image of one robot's camera. Shape (height, width, 3)."""
        from PIL import Image, ImageDraw

        number = self._cameras[name]
        image = Image.fromarray(
            self._renderer.draw(self._scene.data, number)
        ).resize((self._width, self._height))
        pen = ImageDraw.Draw(image, "RGBA")
        column = self._estimated_column(name, index, number)
        if column is not None:
            x, bottom = column * self._width, self._height
            width = max(2, bottom // 90)
            pen.line((x, 0.9 * bottom, x, bottom), ESTIMATE_COLOUR, width)
        size = max(9, self._height // 16)
        colour = colours_in("light", self._run.players, self._run.identities)[
            name
        ]
        at = 0.28 * self._width, 1.9 * size
        draw_label(pen, f"{name}'s camera", at, colour, size)
        return np.asarray(image)

    def _estimated_column(
        self, name: str, index: int, number: int
    ) -> float | None:
        """Return the column of the opponent's estimated position, 0 to 1.

        None if there is no estimate yet or it is outside the image.
        """
        track, data = self._run.tracks[name], self._scene.data
        rows, now = track.sight, self._run.times[index]
        if rows is None or not len(rows) or rows[0, 0] > now:
            return None
        row = rows[int(np.searchsorted(rows[:, 0], now, side="right")) - 1]
        bearing, distance = row[1:3].tolist()
        x, y, heading = track.torso[index].tolist()
        position = np.array(
            [
                x + distance * cos(heading + bearing),
                y + distance * sin(heading + bearing),
                float(data.cam_xpos[number, 2]),
            ]
        )
        rotation: Array = data.cam_xmat[number].reshape(3, 3)
        right, _, back = (position - data.cam_xpos[number]) @ rotation
        if not back < -1e-6:  # a camera of MuJoCo looks along its -z
            return None
        half = 0.5 * self._model.width / self._model.focal_x
        column = 0.5 + 0.5 * float(right / -back) / half
        return column if 0.0 <= column <= 1.0 else None

    def close(self) -> None:
        """Release the graphics."""
        self._renderer.close()


def _cameras(run: Run) -> dict[str, str]:
    """Return the name of the camera of each robot that has one."""
    found = {}
    for name in run.robots:
        try:
            head = load_head(load_robot(run.settings.robot_of(name).robot))
        except ModelError:
            continue
        found[name] = head.camera
    return found


def _camera_model_of(run: Run) -> Any:
    """Return the model of the robots' colour camera."""
    cameras = getattr(run.settings, "cameras", None)
    if cameras is None:
        from ..sim.camera_settings import CameraSettings

        cameras = CameraSettings()
    return cameras.colour.model()
