"""Detections in one image."""

from dataclasses import dataclass

from .colour_detector import ColourDetection
from .depth_detector import DepthScene
from .images import ColourImage, DepthImage


@dataclass(frozen=True, slots=True, eq=False)
class FrameReport:
    """Detections in one image.

    Attributes:
        image: The image.
        azimuths: Directions of the detections from the camera axis, in
            [rad], positive leftward.
        colour: Detection in a colour image, if any.
        depth: Obstacles and shadows in a depth image.
        sought: Whether the opponent was searched for in it.
    """

    image: ColourImage | DepthImage
    azimuths: tuple[float, ...]
    colour: ColourDetection | None = None
    depth: DepthScene | None = None
    sought: bool = True
