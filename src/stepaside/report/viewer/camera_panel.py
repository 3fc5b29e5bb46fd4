"""Images of the robots' cameras with the detected bearings."""

import viser

from ...perception.pipeline import FrameReport
from ..camera_pictures import camera_picture


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

    def show(self, frames: dict[str, FrameReport]) -> None:
        """Show new images.

        Args:
            frames: Newest image of each camera, by its label.
        """
        for label, report in frames.items():
            image = camera_picture(report)
            if label in self._images:
                self._images[label].image = image
                continue
            with self._folder:
                self._images[label] = self._gui.add_image(
                    image, label=label, format="jpeg"
                )
