"""``stepaside compare``: several runs on one figure."""

from pathlib import Path

import click

from .declared.common import FILE, json_option
from .options import print_json


@click.command("compare")
@click.argument(
    "runs",
    nargs=-1,
    required=True,
    type=click.Path(exists=True, file_okay=False, path_type=Path),
)
@FILE.option(
    default=Path("comparison.png"),
    show_default=True,
    help="Figure to write.",
)
@json_option
def compare(runs: tuple[Path, ...], output: Path, as_json: bool) -> None:
    """Draw the paths, distances and orientations of several RUNs."""
    from ..games.folder import load_run
    from ..report.compare_figure import draw_comparison

    loaded = [load_run(folder) for folder in runs]
    output.parent.mkdir(parents=True, exist_ok=True)
    draw_comparison(loaded, output)
    if as_json:
        print_json(
            {
                "figure": str(output),
                "runs": {
                    str(f): r.summary.to_json()
                    for f, r in zip(runs, loaded, strict=True)
                },
            }
        )
        return
    head = ("run", "outcome", "distance", "angle", "closest", "since")
    click.echo("{:<28} {:<11} {:>9} {:>7} {:>9} {:>8}".format(*head))
    for run in loaded:
        s = run.summary
        since = s.converged_at_s
        click.echo(
            f"{run.name:<28} {s.outcome:<11} {s.distance_m:>7.3f} m "
            f"{s.relative_orientation_deg:>5.1f}\u00b0 "
            f"{s.min_distance_m:>7.3f} m "
            f"{'-' if since is None else f'{since:.1f} s':>8}"
        )
    click.echo(f"\nfigure: {output}")
