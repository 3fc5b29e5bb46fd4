"""Text in films and pages: labels, time, distance and state."""

from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ..core.errors import visible
from ..core.poses import Array
from ..games.game import Outcome
from ..games.run import Run
from ..perception.images import Pixels
from .palette import PALETTES

MIN_HEIGHT = 240  # of an image with legible text, in [pixels]
FONT_SIZE = 1.0 / 30.0  # fraction of the height of an image
LIGHT = PALETTES["light"]


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
    labels: Iterable[tuple[str, Array, str]],
    project: Callable[[Array], tuple[float, float] | None],
    speed: float,
) -> Pixels:
    """Write labels at their places; time, distance and state below.

    Labels are text, position in the world in [m], and colour; ``project``
    returns the image of a point, in half heights from the center. An image
    that is too small for text is returned unchanged.
    """
    from PIL import Image, ImageDraw

    height, width = picture.shape[:2]
    if height < MIN_HEIGHT:
        return picture
    size = round(FONT_SIZE * height)
    image = Image.fromarray(picture)
    pen = ImageDraw.Draw(image, "RGBA")
    for text, point, colour in labels:
        projected = project(point)
        if projected is not None:
            x = 0.5 * width + 0.5 * height * projected[0]
            y = 0.5 * height * (1.0 - projected[1])
            draw_label(pen, text, (x, y), colour, size)
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


def describe_state(run: Run, index: int) -> str:
    """Describe the state of a game at a sample."""
    time, summary = float(run.times[index]), run.summary
    complete = run.outcome in (Outcome.COMPLETED, Outcome.INTERRUPTED)
    if index >= len(run.times) - 1 and not complete:
        return run.message
    if summary.play is not None:
        past = [c for c in summary.play.changes if c.time_s <= time + 1e-9]
        words = [f"{c.state} ({c.reason})" for c in past[-1:]]
        return "".join(words) or "no state recorded yet"
    pushed = [
        name
        for name, track in run.tracks.items()
        if track.pushes is not None
        and any(0.0 <= time - begun < 1.0 for begun in track.pushes[:, 0])
    ]
    if pushed:
        return f"push of {' and '.join(pushed)}"
    if run.game == "walk":
        landings = run.walker.landings
        single = run.settings.gait.single_support
        walks = landings is not None and any(landings[:1, 0] - single <= time)
        return "the robot walks" if walks else "the robot stands"
    if run.game == "duel":
        triggered, converged = summary.triggered_at_s, summary.converged_at_s
        if triggered is None or time < triggered:
            return "the evader stands"
        if time < triggered + 1.0:
            return "the evader is triggered"
        if converged is None or time < converged:
            return "the evader is evading"
        return f"{' and '.join(run.players)} are on the circle"
    if not run.opponents:
        return f"{' and '.join(run.players)} in motion"
    at = {
        name: track.unicycle[index, :2] for name, track in run.tracks.items()
    }
    apart = [(np.hypot(*(at[a] - at[b])), a, b) for a, b in run.opponents]
    least, one, other = min(apart)
    return f"nearest: {one} and {other}, {least:.2f} m"
