"""``stepaside compare``: several runs in one figure."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..core.atomic_output import FIGURES, free_file
from ..report.text_escaping import visible
from .options.common_options import figure_width, json_option
from .output_files import OutputFile, attempt, writes_files
from .tables import print_columns
from .terminal import echo, print_json

if TYPE_CHECKING:
    from ..games.run import Run

DEFAULT = Path("comparison.png")
# Columns by game: header, entry of the summary, and format.
COLUMNS = {
    "duel": (
        ("distance", "distance_m", "{:.3f} m"),
        ("angle", "relative_orientation_deg", "{:.1f}\u00b0"),
        ("closest", "min_distance_m", "{:.3f} m"),
        ("settled", "converged_at_s", "{:.1f} s"),
    ),
    "experiment": (
        ("distance", "distance_m", "{:.3f} m"),
        ("angle", "relative_orientation_deg", "{:.1f}\u00b0"),
        ("closest", "min_distance_m", "{:.3f} m"),
        ("rate", "rate_hz", "{:.1f} Hz"),
    ),
    "game": (
        ("players", "players", "{}"),
        ("closest", "closest_m", "{:.3f} m"),
        ("captured", "captured_at_s", "{:.1f} s"),
        ("path", "mean_path_m", "{:.2f} m"),
    ),
    "play": (
        ("distance", "distance_m", "{:.3f} m"),
        ("radius", "radius_m", "{:.3f} m"),
        ("closest", "closest_m", "{:.3f} m"),
        ("walked", "walking_s", "{:.1f} s"),
    ),
    "walk": (
        ("speed", "speed_m_s", "{:.4f} m/s"),
        ("planned", "speed_ratio", "x {:.3f}"),
        ("turned", "yaw_ratio", "x {:.3f}"),
        ("tilt", "tilt_max_deg", "{:.1f}\u00b0"),
    ),
}


@click.command("compare")
@click.argument(
    "runs",
    nargs=-1,
    required=True,
    type=click.Path(exists=True, file_okay=False, path_type=Path),
)
@click.option(
    "--output",
    type=OutputFile(*FIGURES),
    help="Figure to write; comparison.png by default, or the first of "
    "comparison-2.png, ... that does not exist.",
)
@figure_width
@json_option
@writes_files
def compare(runs: tuple[Path, ...], output: str | None, as_json: bool) -> None:
    """Plot the paths of several run folders, and their values over time.

    For duels, plot distance and angle between headings; for games of several
    players, the distance of the nearest opponents; for walks, tilt and speed;
    for records of `stepaside play`, the measured distance to the opponent.
    """
    from ..games.run_archive import load_run, results_of

    loaded = [load_run(folder) for folder in runs]
    games = sorted({run.game for run in loaded})
    if len(games) > 1:
        raise click.UsageError(
            f"all runs must be of the same game, got {' and '.join(games)}"
        )
    file = free_file(DEFAULT) if output is None else Path(output)
    drawn = attempt(lambda: _draw(loaded, file))
    if as_json:
        print_json(
            {
                "figure": str(file) if drawn else None,
                "runs": {
                    str(f): results_of(r)
                    for f, r in zip(runs, loaded, strict=True)
                },
            }
        )
        return
    _print(loaded)
    if drawn:
        echo(f"\nfigure: {file}")


def _draw(runs: "list[Run]", file: Path) -> None:
    from ..games.run import is_play

    if len(runs) == 1 and is_play(runs[0]):
        from ..report.play_figure import draw_play

        draw_play(runs[0], file)
    elif runs[0].pair is None and not is_play(runs[0]):
        from ..report.walks_figure import draw_walks

        draw_walks(runs, file)
    else:
        from ..report.compare_figure import draw_comparison

        draw_comparison(runs, file)


def _print(runs: "list[Run]") -> None:
    """Print one line per run."""
    columns = COLUMNS[runs[0].game]
    print_columns(
        ("run", "outcome", *(head for head, _, _ in columns)),
        [
            (
                visible(run.name),
                run.outcome.value,
                *(
                    _number(getattr(run.summary, name), text)
                    for _, name, text in columns
                ),
            )
            for run in runs
        ],
        left=(0, 1),
    )


def _number(value: float | None, text: str) -> str:
    return "-" if value is None else text.format(value)
