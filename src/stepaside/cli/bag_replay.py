"""Replay of a ROS 2 bag: motion of players that was recorded elsewhere."""

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from .options.settings_options import refuse_options
from .output_files import attempt
from .run_output import check_run_folder, save_run
from .tables import print_table
from .terminal import print_json

if TYPE_CHECKING:
    from ..games.run import ExperimentRun

ONLY_BAGS = ("frames", "output", "figure")  # options of a bag
NO_BAGS = ("video", "gif", "opens")


class BagOutputs(NamedTuple):
    """Files that are written for a bag.

    Attributes:
        html: File of the offline page.
        figure: File of the figure.
        output: Run folder to create.
    """

    html: str | None
    figure: str | None
    output: Path | None


def is_bag(path: Path) -> bool:
    """Return whether a path is a ROS 2 bag rather than a run folder."""
    return path.is_file() or (path / "metadata.yaml").is_file()


def replay_bag(
    bag: Path, frames: tuple[str, ...], outputs: BagOutputs, *, as_json: bool
) -> None:
    """Measure the motion of players in a bag, and draw it.

    Args:
        bag: Folder or file of the bag.
        frames: Players, as ``NAME=FRAME`` or ``NAME=/TOPIC``.
        outputs: What to write.
        as_json: Whether to print JSON.

    Raises:
        UsageError: If an option is for run folders only.
        ConfigurationError: If the bag cannot be read as an experiment.
    """
    from ..games.experiment import import_experiment
    from ..games.run_archive import results_of

    if not frames:
        raise click.UsageError(
            f"{bag.name} is a bag: give each player as --frame NAME=FRAME"
        )
    refuse_options(NO_BAGS, "a run folder; --output writes one")
    check_run_folder(outputs.output)
    run = import_experiment(bag, frames)
    saved = save_run(outputs.output, run)
    if outputs.figure is not None:
        from ..report.duel_figure import draw_duel

        figure = Path(outputs.figure)
        attempt(lambda: draw_duel(run, figure))
    if outputs.html is not None:
        from ..report.replay_page import write_page

        page = Path(outputs.html)
        attempt(lambda: write_page(run, page))
    summary = results_of(run) | saved.entries
    if as_json:
        print_json(summary)
    else:
        _print(run)
        saved.print_paths(f"{run.game}.png")
    saved.raise_failure()


def _print(run: "ExperimentRun") -> None:
    summary = run.summary
    rows: list[tuple[str, Any]] = [
        (
            "recording",
            f"{summary.source}: {run.duration:.2f} s, "
            f"{summary.rate_hz:.1f} samples per second",
        ),
        ("start distance", f"{summary.start_distance_m:.3f} m"),
    ]
    for name, player in summary.measured.items():
        radius = player.radius_m
        text = "-" if radius is None else f"{radius:.3f} m"
        rows.append((f"{name} radius", text))
        rows.append((f"{name} mean speed", f"{player.mean_speed_m_s:.3f} m/s"))
    rows += [
        ("distance", f"{summary.distance_m:.3f} m"),
        (
            "angle between headings",
            f"{summary.relative_orientation_deg:.3f} deg",
        ),
        (
            "closest approach",
            f"{summary.min_distance_m:.3f} m at "
            f"{summary.min_distance_at_s:.2f} s",
        ),
    ]
    rows += [("note", note) for note in summary.notes]
    print_table(rows)
