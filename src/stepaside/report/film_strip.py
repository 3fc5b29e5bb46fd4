"""Figure of a few images of a film, each above its top view."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from matplotlib.lines import Line2D

from ..games.run import Run, is_match
from ..games.run_archive import load_run
from .duel_figure import draw_top
from .figure_sizes import sheet
from .figure_style import THEORY, colours_of, new_figure, save
from .film import FilmSettings, frame_times_of, render_images

FRAMES = 4


def strip_settings(settings: FilmSettings, last: float) -> FilmSettings:
    """Return the settings for ``FRAMES`` images, evenly from begin to end.

    Args:
        settings: Settings of a film of the same time.
        last: End of the run, in [s].
    """
    span = min(last, settings.begin + settings.duration) - settings.begin
    rate = (FRAMES - 1) / span if span > 0.0 else 1.0
    return replace(settings, rate=rate, speed=1.0, slow=False, captions=False)


def write_strip(
    folder: Path,
    file: Path,
    settings: FilmSettings,
    report: Callable[[int, int], None] | None = None,
) -> int:
    """Write the film strip of a run.

    Args:
        folder: Run folder.
        file: Figure to write; its suffix gives the format.
        settings: Settings of a film of the same time.
        report: Called with the numbers of finished and of all images.

    Returns:
        Number of images.

    Raises:
        ConfigurationError: If this machine has no OpenGL, or the film begins
            after the end of the run.
        OutputError: If the file cannot be written.
    """
    run = load_run(folder)
    settings = strip_settings(settings, float(run.times[-1]))
    times = frame_times_of(run, settings)
    images = []
    for image in render_images(folder, settings):
        images.append(image)
        if report is not None:
            report(len(images), len(times))
    rows = 2 if sheet().narrow else 1
    columns = -(-len(images) // rows)
    figure = new_figure(2.75 * columns, 0.5 + 4.6 * rows)
    grid = figure.subplots(2 * rows, columns, squeeze=False)
    for number, (image, time) in enumerate(zip(images, times, strict=True)):
        row, column = divmod(number, columns)
        above, below = grid[2 * row, column], grid[2 * row + 1, column]
        above.imshow(image)
        above.set_title(f"{time:.1f} s")
        above.set_axis_off()
        draw_top(below, run, run.index_at(time))
        below.set_xlabel("x [m]")
        if column == 0:
            below.set_ylabel("y [m]")
    figure.legend(
        *legend_entries(run, settings),
        loc="outside lower center",
        ncols=2 if sheet().narrow else 5,
    )
    save(figure, file)
    return len(images)


def legend_entries(
    run: Run, settings: FilmSettings
) -> tuple[list[Line2D], list[str]]:
    """Return the handles and labels of all lines in the images.

    Args:
        run: The run.
        settings: Settings of the film.
    """
    colours = colours_of(run.players, run.identities)
    the = "" if is_match(run) else "the "  # players of a match have names
    entries = [(f"path of {the}{n}", c, 1.5) for n, c in colours.items()]
    for player, radius in run.safety_areas if settings.layers else ():
        label = f"ring: safety radius of {the}{player}, {radius:.3g} m"
        entries.append((label, colours[player], 3.0))
    if settings.layers and run.circle is not None:
        label = f"ring: theoretical circle, radius {run.circle[2]:.2f} m"
        entries.append((label, THEORY, 3.0))
    if settings.layers and run.pair is not None:
        entries.append(("line of sight", THEORY, 0.8))
    lines = [Line2D([], [], color=colour, lw=w) for _, colour, w in entries]
    return lines, [label for label, _, _ in entries]
