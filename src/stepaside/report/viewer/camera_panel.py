"""Images of the robots' cameras with the detected bearings."""

from math import degrees, tan
from typing import TYPE_CHECKING

import numpy as np
import viser

from ...perception.images import ColourImage, Pixels

if TYPE_CHECKING:
    from ...perception.pipeline import FrameReport

WIDTH = 240  # of an image on the page, in [pixels]
DETECTION_COLOUR = (40, 200, 90)


def picture(report: "FrameReport") -> Pixels:
    """Return an enlarged image with a line at every detected bearing.

    Args:
        report: Image with its detections.

    Returns:
        Image; depth is shown as brightness. Shape (height, width, 3).
    """
    image = report.image
    if isinstance(image, ColourImage):
        pixels = image.pixels
    else:
        depth = np.clip(image.depths / image.far, 0.0, 1.0)
        grey = np.where(image.depths > 0.0, 255.0 * (1.0 - 0.85 * depth), 0.0)
        pixels = np.repeat(grey.astype(np.uint8)[:, :, None], 3, axis=2)
    scale = max(1, WIDTH // pixels.shape[1])
    large = np.kron(pixels, np.ones((scale, scale, 1), dtype=np.uint8))
    camera = image.camera
    for azimuth in report.azimuths:
        if abs(degrees(azimuth)) > 80.0:
            continue
        column = 0.5 * camera.width - camera.focal_x * tan(azimuth)
        at = int(scale * column)
        if 0 <= at < large.shape[1]:
            large[:, max(0, at - 1) : at + 2] = DETECTION_COLOUR
    return large


class CameraPanel:
    """Panel with the newest image of every camera of a duel."""

    def __init__(self, gui: viser.GuiApi) -> None:
        """Add a folder that is hidden until a duel has cameras."""
        self._gui = gui
        self._folder = gui.add_folder("Cameras", visible=False)
        self._images: dict[str, viser.GuiImageHandle] = {}

    def reset(self, *, visible: bool) -> None:
        """Remove all images.

        Args:
            visible: Whether the next duel has cameras.
        """
        for handle in self._images.values():
            handle.remove()
        self._images.clear()
        self._folder.visible = visible

    def show(self, frames: dict[str, "FrameReport"]) -> None:
        """Show new images.

        Args:
            frames: Newest image of each camera, by its label.
        """
        for label, report in frames.items():
            image = picture(report)
            if label in self._images:
                self._images[label].image = image
                continue
            with self._folder:
                self._images[label] = self._gui.add_image(
                    image, label=label, format="jpeg"
                )
