"""``stepaside compare``: several runs on one figure."""

from pathlib import Path

import click

from ..outputs import FIGURES, free_file
from ..report.inert import visible
from .declared.common import FILE, json_option
from .options import print_json
from .outputs import OutputFile, attempt, writes_files
from .terminal import echo

DEFAULT = Path("comparison.png")


@click.command("compare")
@click.argument(
    "runs",
    nargs=-1,
    required=True,
    type=click.Path(exists=True, file_okay=False, path_type=Path),
)
@FILE.option(
    type=OutputFile(*FIGURES),
    help="Figure to write; comparison.png by default, or comparison-2.png "
    "and so on if there is one.",
)
@json_option
@writes_files
def compare(runs: tuple[Path, ...], output: str | None, as_json: bool) -> None:
    """Draw the paths, distances and orientations of several RUNs."""
    from ..games.folder import load_run
    from ..report.compare_figure import draw_comparison

    loaded = [load_run(folder) for folder in runs]
    file = free_file(DEFAULT) if output is None else Path(output)
    drawn = attempt(lambda: draw_comparison(loaded, file))
    if as_json:
        print_json(
            {
                "figure": str(file) if drawn else None,
                "runs": {
                    str(f): r.summary.to_json()
                    for f, r in zip(runs, loaded, strict=True)
                },
            }
        )
        return
    head = ("run", "outcome", "distance", "angle", "closest", "since")
    echo("{:<28} {:<11} {:>9} {:>7} {:>9} {:>8}".format(*head))
    for run in loaded:
        s = run.summary
        since = s.converged_at_s
        echo(
            f"{visible(run.name):<28} {s.outcome:<11} {s.distance_m:>7.3f} m "
            f"{s.relative_orientation_deg:>5.1f}\u00b0 "
            f"{s.min_distance_m:>7.3f} m "
            f"{'-' if since is None else f'{since:.1f} s':>8}"
        )
    if drawn:
        echo(f"\nfigure: {file}")
