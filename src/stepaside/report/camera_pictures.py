"""Images of the robots' cameras with the directions of detections."""

from math import degrees, tan

import numpy as np

from ..perception.images import ColourImage, Pixels
from ..perception.pipeline import FrameReport

WIDTH = 240  # of a picture at least, approximately, in [pixels]
FOUND = (30, 190, 70)  # red, green and blue of detections
TRUE = (235, 0, 190)  # of the true direction of the opponent


def camera_picture(report: FrameReport, truth: float | None = None) -> Pixels:
    """Return an enlarged image with a line in every detected direction.

    The true direction of the opponent from the camera's axis, in [rad], is a
    short line at the lower edge. Depth is shown as brightness, missing
    values are black. Shape (height, width, 3).
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
    camera, height = image.camera, len(large)
    marks = [(azimuth, 0, FOUND) for azimuth in report.azimuths]
    if truth is not None:
        marks.append((truth, round(0.88 * height), TRUE))
    half = max(1, large.shape[1] // 240)
    for azimuth, top, colour in marks:
        if abs(degrees(azimuth)) > 80.0:
            continue
        column = 0.5 * camera.width - camera.focal_x * tan(azimuth)
        at = int(scale * column)
        if 0 <= at < large.shape[1]:
            large[top:, max(0, at - half) : at + half + 1] = colour
    return large
