"""What the robots' cameras see, with what they found in it."""

from math import degrees, tan
from typing import TYPE_CHECKING

import numpy as np
import viser

from ...perception.images import ColourImage, Pixels

if TYPE_CHECKING:
    from ...perception.frame_report import FrameReport

WIDTH = 240  # of a picture on the page, in [pixels]
FOUND = (40, 200, 90)


def picture(report: "FrameReport") -> Pixels:
    """Picture of one image, with a line at every bearing found in it."""
    image = report.image
    if isinstance(image, ColourImage):
        pixels = image.pixels
    else:
        shade = np.clip(image.depths / image.far, 0.0, 1.0)
        grey = np.where(image.depths > 0.0, 255.0 * (1.0 - 0.85 * shade), 0.0)
        pixels = np.repeat(grey.astype(np.uint8)[:, :, None], 3, axis=2)
    grow = max(1, WIDTH // pixels.shape[1])
    large = np.kron(pixels, np.ones((grow, grow, 1), dtype=np.uint8))
    camera = image.camera
    for azimuth in report.azimuths:
        if abs(degrees(azimuth)) > 80.0:
            continue
        column = 0.5 * camera.width - camera.focal_x * tan(azimuth)
        at = int(grow * column)
        if 0 <= at < large.shape[1]:
            large[:, max(0, at - 1) : at + 2] = FOUND
    return large


class CameraPanel:
    """Pictures of the last images of every camera of a duel."""

    def __init__(self, gui: viser.GuiApi) -> None:
        """Add a folder, which is empty while nobody has cameras."""
        self._gui = gui
        self._folder = gui.add_folder("Cameras", visible=False)
        self._shown: dict[str, viser.GuiImageHandle] = {}

    def forget(self, *, visible: bool) -> None:
        """Empty the folder for another duel, with cameras or without."""
        for handle in self._shown.values():
            handle.remove()
        self._shown.clear()
        self._folder.visible = visible

    def show(self, frames: dict[str, "FrameReport"]) -> None:
        """Show what came since the last time.

        Args:
            frames: Newest image of each camera, by its label.
        """
        for label, report in frames.items():
            drawn = picture(report)
            if label in self._shown:
                self._shown[label].image = drawn
                continue
            with self._folder:
                self._shown[label] = self._gui.add_image(
                    drawn, label=label, format="jpeg"
                )
