"""A few pictures of a film side by side, each over its view from above."""

from collections.abc import Callable
from pathlib import Path

from matplotlib.lines import Line2D

from ..games.run import Run
from ..games.run_archive import load_run
from .duel_figure import draw_top
from .figure_sizes import sheet
from .figure_style import THEORY, colours_of, new_figure, save
from .film import FilmSettings, instants_of, pictures

FRAMES = 4


def spread(shot: FilmSettings, last: float) -> FilmSettings:
    """The same shot with a few pictures, evenly from begin to end.

    Args:
        shot: How a film would be taken.
        last: End of the run, in [s].
    """
    span = min(last, shot.begin + shot.duration) - shot.begin
    rate = (FRAMES - 1) / span if span > 0.0 else 1.0
    return shot._replace(rate=rate, speed=1.0, slow=False, words=False)


def write_strip(
    folder: Path,
    file: Path,
    shot: FilmSettings,
    report: Callable[[int, int], None] | None = None,
) -> int:
    """Write the strip of a run.

    Args:
        folder: Run folder.
        file: Figure, of a format that its suffix tells.
        shot: How a film would be taken, from its begin to its end.
        report: Called with the pictures that are done, and all of them.

    Returns:
        Number of pictures.

    Raises:
        ConfigurationError: If the machine cannot draw, or there is nothing
            to draw.
        OutputError: If it cannot be written.
    """
    run = load_run(folder)
    shot = spread(shot, float(run.times[-1]))
    times = instants_of(run, shot)
    drawn = []
    for picture in pictures(folder, shot):
        drawn.append(picture)
        if report is not None:
            report(len(drawn), len(times))
    lines = 2 if sheet().narrow else 1
    columns = -(-len(drawn) // lines)
    figure = new_figure(2.75 * columns, 0.5 + 4.6 * lines)
    grid = figure.subplots(2 * lines, columns, squeeze=False)
    for number, (picture, time) in enumerate(zip(drawn, times, strict=True)):
        line, column = divmod(number, columns)
        above, below = grid[2 * line, column], grid[2 * line + 1, column]
        above.imshow(picture)
        above.set_title(f"{time:.1f} s")
        above.set_axis_off()
        draw_top(below, run, run.index_at(time))
        below.set_xlabel("x [m]")
        if column == 0:
            below.set_ylabel("y [m]")
    figure.legend(
        *line_names(run, shot),
        loc="outside lower center",
        ncols=2 if sheet().narrow else 5,
    )
    save(figure, file)
    return len(drawn)


def line_names(run: Run, shot: FilmSettings) -> tuple[list[Line2D], list[str]]:
    """Return a sample and the name of every line of the pictures.

    Args:
        run: The run.
        shot: How its film would be taken.
    """
    colours = colours_of(run.players)
    found = [(f"path of the {n}", c, 1.5) for n, c in colours.items()]
    if shot.layers and run.safety is not None:
        who, radius = run.safety
        name = f"ring: safety radius of the {who}, {radius:.3g} m"
        found.append((name, colours[who], 3.0))
    if shot.layers and run.circle is not None:
        name = f"ring: circle of theory, radius {run.circle[2]:.2f} m"
        found.append((name, THEORY, 3.0))
    if shot.layers and run.pair is not None:
        found.append(("line of sight", THEORY, 0.8))
    lines = [Line2D([], [], color=colour, lw=w) for _, colour, w in found]
    return lines, [name for name, _, _ in found]
