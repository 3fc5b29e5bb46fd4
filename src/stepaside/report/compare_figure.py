"""Several runs on one figure."""

from collections.abc import Sequence
from pathlib import Path

from ..games.circle import cycle_mean
from ..games.run import Run
from .inert import for_figure
from .style import EVADER, PURSUER, THEORY, plt, save

LINES = ("-", "--", ":", "-.")
RUNS = ("#222222", "#0f7b6c", "#b5651d", "#6a3d9a")


def draw_comparison(runs: Sequence[Run], file: Path) -> None:
    """Draw paths, and distance and orientation over gait cycles.

    Args:
        runs: The runs; each has its own kind of line.
        file: Picture to write.
    """
    figure, axes = plt.subplot_mosaic(
        [["path", "distance"], ["path", "angle"]], figsize=(9.5, 4.8)
    )
    for number, run in enumerate(runs):
        line = LINES[number % len(LINES)]
        cycle = 2.0 * run.settings.gait.step_duration
        shade = 1.0 - 0.6 * (number // len(LINES)) / max(1, len(runs))
        for name, colour in (("pursuer", PURSUER), ("evader", EVADER)):
            place = run.tracks[name].torso
            axes["path"].plot(
                place[:, 0],
                place[:, 1],
                color=colour,
                linestyle=line,
                alpha=shade,
                linewidth=1.1,
            )
        for key, values in (
            ("distance", run.distance),
            ("angle", run.orientation),
        ):
            axes[key].plot(
                run.times,
                cycle_mean(values, run.times, cycle),
                color=RUNS[number % len(RUNS)],
                linestyle=line,
                alpha=shade,
                linewidth=1.1,
                label=for_figure(run.name),
            )
    theory = runs[0].theory
    if theory is not None:
        for key, level in (("distance", theory[1]), ("angle", theory[2])):
            axes[key].axhline(
                level, color=THEORY, linewidth=0.8, label="theory"
            )
    axes["path"].set_aspect("equal")
    axes["path"].set_title("torsos: pursuer red, evader blue")
    axes["path"].set_xlabel("x [m]")
    axes["path"].set_ylabel("y [m]")
    axes["distance"].set_ylabel("distance [m]")
    axes["angle"].set_ylabel("between headings [deg]")
    axes["angle"].set_xlabel("time [s]")
    axes["distance"].legend(fontsize=7)
    save(figure, file)
