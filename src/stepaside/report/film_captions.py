"""Text in films: names of players and rings, time, distance and state."""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ..core.poses import Array
from ..games.run import Run
from ..games.run_captions import describe_state
from ..perception.images import Pixels
from .film_camera import HEIGHT, CameraView
from .palette import PALETTES, colours_in
from .text_escaping import visible

MIN_HEIGHT = 240  # of an image with legible text, in [pixels]
FONT_SIZE = 1.0 / 30.0  # fraction of the height of an image
LIGHT = PALETTES["light"]
# Direction of a ring's label from its center: to the right of the image.
LABEL_DIRECTION = 0.87, -0.5


@cache
def _font(size: int) -> Any:
    from matplotlib import get_data_path
    from PIL import ImageFont

    fonts = Path(get_data_path()) / "fonts" / "ttf"
    return ImageFont.truetype(str(fonts / "DejaVuSans.ttf"), size)


def caption(
    picture: Pixels,
    run: Run,
    index: int,
    *,
    view: CameraView,
    fovy: float,
    speed: float,
) -> Pixels:
    """Write names above players and rings; time, distance and state below.

    Args:
        picture: Image of a sample. Shape (height, width, 3).
        run: The run.
        index: Sample that is shown.
        view: Camera.
        fovy: Vertical field of view, in [deg].
        speed: Time of the run per time of the film.

    Returns:
        Image with text; unchanged if it is too small for text.
    """
    from PIL import Image, ImageDraw

    height, width = picture.shape[:2]
    if height < MIN_HEIGHT:
        return picture
    size = round(FONT_SIZE * height)
    image = Image.fromarray(picture)
    pen = ImageDraw.Draw(image, "RGBA")
    for name, colour in colours_in(
        "light", run.players, run.identities
    ).items():
        position = run.tracks[name].torso[index, :2]
        top = max(HEIGHT, 1.9 * float(run.tracks[name].com[index, 2]))
        projected = view.project(np.array([*position, top]), fovy)
        if projected is not None:
            x = 0.5 * width + 0.5 * height * projected[0]
            y = 0.5 * height * (1.0 - projected[1])
            draw_label(pen, name, (x, y), colour, size)
    for text, point, colour in ring_labels(run, index):
        projected = view.project(point, fovy)
        if projected is not None:
            x = 0.5 * width + 0.5 * height * projected[0]
            y = 0.5 * height * (1.0 - projected[1]) + 0.6 * size
            draw_label(pen, text, (x, y), colour, round(0.9 * size))
    values = f"{run.times[index]:.1f} s"
    if run.pair is not None:
        least = "least distance" if len(run.opponents) > 1 else "distance"
        values += f"   {least} {run.distance[index]:.2f} m"
    if abs(speed - 1.0) > 1e-3:
        values += f"   {speed:.3g} x real time"
    band = round(1.9 * size)
    pen.rectangle((0, height - band, width, height), (251, 251, 249, 215))
    baseline = height - band / 2
    pen.text((size, baseline), values, LIGHT.ink, _font(size), "lm")
    left = pen.textlength(values, _font(size)) + 3 * size
    available = width - left - size
    state = visible(describe_state(run, index))
    while state and pen.textlength(state, _font(size)) > available:
        state = state[:-2].rstrip(" .") + "\u2026" if len(state) > 3 else ""
    pen.text((width - size, baseline), state, LIGHT.ink, _font(size), "rm")
    return np.asarray(image)


def ring_labels(run: Run, index: int) -> list[tuple[str, Array, str]]:
    """Return text, position in the world and colour of each ring's label.

    Args:
        run: The run.
        index: Sample that is shown.
    """
    labels = []
    dx, dy = LABEL_DIRECTION
    for player, radius in run.safety_areas:
        x, y = run.tracks[player].torso[index, :2].tolist()
        colour = colours_in("light", run.players, run.identities)[player]
        position = np.array([x + radius * dx, y + radius * dy, 0.0])
        labels.append((f"safety radius {radius:.2g} m", position, colour))
    circle = run.circle
    if circle is not None:
        x, y, radius = circle
        position = np.array([x - radius * dx, y - radius * dy, 0.0])
        text = f"theoretical circle, radius {radius:.2g} m"
        labels.append((text, position, LIGHT.theory))
    return labels


def draw_label(
    pen: Any, text: str, at: tuple[float, float], colour: str, size: int
) -> None:
    """Write a label in a rounded box above a point of an image.

    A label that would be cut at the left or right edge is moved inwards.
    """
    small = _font(round(0.85 * size))
    half = 0.5 * pen.textlength(text, small) + 0.45 * size
    (x, y), (width, _) = at, pen.im.size
    if 0.0 <= x <= width:
        x = min(max(x, half), width - half)
    box = (x - half, y - 1.35 * size, x + half, y)
    pen.rounded_rectangle(box, 0.6 * size, (251, 251, 249, 225))
    pen.text((x, y - 0.68 * size), text, colour, small, "mm")
