"""Film strip of the robots' camera images, with sighting errors."""

from string import ascii_letters as LETTERS
from typing import Any

import numpy as np

from ..core.errors import AnyPath
from ..core.poses import wrap_angles
from ..games.run import Run
from .camera_pictures import camera_picture
from .figure_style import THEORY, colours_of, legend_above, panels, save
from .plan_view import draw_snapshots

IMAGES = 6  # in a row


def draw_sight(run: Run, path: AnyPath) -> None:
    """Write the film strip of a game with cameras.

    Args:
        run: The game.
        path: File to write; its suffix gives the format.
    """
    strips = {
        f"{name}'s {kind}\ncamera": stills[:IMAGES]
        for name, kinds in run.stills.items()
        for kind, stills in kinds.items()
        if stills
    }
    first = next(iter(strips.values()), [])
    count = max([1, *map(len, strips.values())])
    lines = len(strips) + 1
    rows = [LETTERS[count * i : count * (i + 1)] for i in range(lines)]
    title = f"{run.title}: detections green, true direction magenta"
    figure, axes = panels(
        [*rows, "1" * count, "2" * count],
        2.3 * count,
        [1.4] * lines + [1.2, 1.2],
        title=title,
        gaps=(0.35, 0.6),
    )
    for row, (label, stills) in zip(rows, strips.items(), strict=False):
        for letter in row[len(stills) :]:
            axes[letter].set_visible(False)
        for letter, still in zip(row, stills, strict=False):
            shown = axes[letter]
            shown.imshow(camera_picture(still.report, still.azimuth))
            shown.set(xticks=[], yticks=[])
            shown.set_title(f"{still.report.image.time:.1f} s")
            shown.grid(visible=False)
        axes[row[0]].set_ylabel(label)
    times = np.array([still.report.image.time for still in first])
    above = [axes[letter] for letter in rows[-1]]
    for unused in above[len(times) :]:
        unused.set_visible(False)
    draw_snapshots(above[: len(times)], run, times)
    _draw_errors(axes["1"], axes["2"], run)
    save(figure, path)


def _draw_errors(upper: Any, lower: Any, run: Run) -> None:
    """Draw the errors of bearing and distance over time."""
    for name, colour in colours_of(run).items():
        rows = run.tracks[name].sight
        if rows is not None:
            bearing = np.degrees(wrap_angles(rows[:, 1] - rows[:, 3]))
            distance = rows[:, 2] - rows[:, 4]
            look = {"color": colour, "lw": 0.7, "label": name}
            upper.plot(rows[:, 0], bearing, **look)
            lower.plot(rows[:, 0], distance, **look)
    for axes, label, limit in (
        (upper, "bearing\nerror [deg]", 8.0),
        (lower, "distance\nerror [m]", 0.2),
    ):
        axes.axhline(0.0, color=THEORY, lw=0.6)
        axes.set(xlabel="time [s]", ylabel=label, ylim=(-limit, limit))
    legend_above(upper, "", 4)
