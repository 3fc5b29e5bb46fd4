"""What one image was found to show."""

from dataclasses import dataclass

from .colour_detector import ColourDetection
from .depth_detector import DepthScene
from .images import ColourImage, DepthImage


@dataclass(frozen=True, slots=True, eq=False)
class FrameReport:
    """What one image was found to show.

    Attributes:
        image: The image.
        azimuths: Directions in which something was found, from the
            camera's axis, in [rad], positive leftward.
        colour: What a colour image shows.
        depth: What a depth image shows.
        sought: Whether the other was looked for in it.
    """

    image: ColourImage | DepthImage
    azimuths: tuple[float, ...]
    colour: ColourDetection | None = None
    depth: DepthScene | None = None
    sought: bool = True
