"""Words in a film: who is who, and what goes on."""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ..core.poses import Array
from ..games.run import Run
from ..perception.images import Pixels
from .film_camera import HEIGHT, CameraView
from .palette import PALETTES, colours_in
from .text_escaping import visible

SMALLEST = 240  # height of a picture from which on words can be read
SHARE = 1.0 / 30.0  # of letters in the height of a picture
DAY = PALETTES["light"]
# Direction of a ring's name from its middle: to the right of the picture.
BESIDE = 0.87, -0.5


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
    pace: float,
) -> Pixels:
    """Write names over the players, and time, distance and words below.

    Args:
        picture: Of a moment. Shape (height, width, 3).
        run: The run.
        index: Sample that is shown.
        view: From where.
        fovy: Vertical field of view, in [deg].
        pace: Time of the run per time of the film.

    Returns:
        Picture with the words; as it was if it is too small for any.
    """
    from PIL import Image, ImageDraw

    height, width = picture.shape[:2]
    if height < SMALLEST:
        return picture
    size = round(SHARE * height)
    image = Image.fromarray(picture)
    pen = ImageDraw.Draw(image, "RGBA")
    for name, colour in colours_in("light", run.players).items():
        place = run.tracks[name].torso[index, :2]
        high = max(HEIGHT, 1.9 * float(run.tracks[name].com[index, 2]))
        seen = view.project(np.array([*place, high]), fovy)
        if seen is not None:
            at = 0.5 * width + 0.5 * height * seen[0]
            over = 0.5 * height * (1.0 - seen[1])
            chip(pen, name, (at, over), colour, size)
    for text, point, colour in rings_of(run, index):
        seen = view.project(point, fovy)
        if seen is not None:
            at = 0.5 * width + 0.5 * height * seen[0]
            over = 0.5 * height * (1.0 - seen[1]) + 0.6 * size
            chip(pen, text, (at, over), colour, round(0.9 * size))
    said = visible(run.words(index))
    told = f"{run.times[index]:.1f} s"
    if run.distance is not None:
        told += f"   {run.distance[index]:.2f} m apart"
    told += f"   {pace:.3g} x real time" if abs(pace - 1.0) > 1e-3 else ""
    band = round(1.9 * size)
    pen.rectangle((0, height - band, width, height), (251, 251, 249, 215))
    middle = height - band / 2
    pen.text((size, middle), told, DAY.ink, _font(size), "lm")
    wide = pen.textlength(told, _font(size)) + 3 * size
    room = width - wide - size
    while said and pen.textlength(said, _font(size)) > room:
        said = said[:-2].rstrip(" .") + "\u2026" if len(said) > 3 else ""
    pen.text((width - size, middle), said, DAY.ink, _font(size), "rm")
    return np.asarray(image)


def rings_of(run: Run, index: int) -> list[tuple[str, Array, str]]:
    """Return the name, the place of the name and the colour of each ring.

    Args:
        run: The run.
        index: Sample that is shown.
    """
    found = []
    if run.safety is not None:
        who, radius = run.safety
        x, y = run.tracks[who].torso[index, :2].tolist()
        colour = colours_in("light", run.players)[who]
        place = np.array([x + radius * BESIDE[0], y + radius * BESIDE[1], 0.0])
        found.append((f"safety area {radius:.2g} m", place, colour))
    if run.circle is not None:
        x, y, radius = run.circle
        place = np.array([x - radius * BESIDE[0], y - radius * BESIDE[1], 0.0])
        found.append((f"circle of theory {radius:.2g} m", place, DAY.theory))
    return found


def title_of(picture: Pixels, text: str) -> Pixels:
    """Write a title into the upper left corner.

    Args:
        picture: Shape (height, width, 3).
        text: Of anybody.
    """
    from PIL import Image, ImageDraw

    height = picture.shape[0]
    text = visible(text)
    if height < SMALLEST or not text:
        return picture
    size = round(SHARE * height)
    image = Image.fromarray(picture)
    pen = ImageDraw.Draw(image, "RGBA")
    wide = pen.textlength(text, _font(size))
    box = (0.6 * size, 0.6 * size, 1.8 * size + wide, 2.4 * size)
    pen.rounded_rectangle(box, 0.4 * size, (251, 251, 249, 215))
    pen.text((1.2 * size, 1.5 * size), text, DAY.ink, _font(size), "lm")
    return np.asarray(image)


def chip(
    pen: Any, text: str, at: tuple[float, float], colour: str, size: int
) -> None:
    """Write a word on a chip that stands on a place of the picture."""
    small = _font(round(0.85 * size))
    half = 0.5 * pen.textlength(text, small) + 0.45 * size
    x, y = at
    box = (x - half, y - 1.35 * size, x + half, y)
    pen.rounded_rectangle(box, 0.6 * size, (251, 251, 249, 225))
    pen.text((x, y - 0.68 * size), text, colour, small, "mm")
