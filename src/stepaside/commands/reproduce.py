"""``stepaside reproduce``: every claim of the paper, measured."""

from pathlib import Path
from typing import Any

import click

from .options import json_option, print_json


@click.command("reproduce")
@click.option(
    "--seed",
    type=click.IntRange(0),
    default=1,
    show_default=True,
    help="Of the duels.",
)
@click.option(
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path("runs/reproduce"),
    show_default=True,
    help="Folder of the page; what it holds already is not measured again.",
)
@json_option
def reproduce(seed: int, output: Path, as_json: bool) -> None:
    """Measure every claim of the paper and write a page about it.

    Takes about two minutes; when stopped, it goes on where it was.
    """
    from tqdm import tqdm

    from ..report.claims_page import write_page
    from ..studies.reproduce import JOBS
    from ..studies.reproduce import reproduce as measure

    with tqdm(total=len(JOBS), desc="claims", disable=None) as bar:

        def report(name: str) -> None:
            bar.set_postfix_str(name)
            bar.update()

        rows = measure(output / "rows", seed, report)
    page = write_page(output, rows, _figures(output, seed))
    if as_json:
        print_json(rows)
        return
    for row in rows:
        click.echo(
            f"  {row['verdict']:<6} {row['section']:<13} {row['claim']}"
        )
    failed = sum(row["verdict"] != "holds" for row in rows)
    click.echo(f"\n{len(rows) - failed} of {len(rows)} hold\npage: {page}")


def _figures(folder: Path, seed: int) -> list[tuple[str, str]]:
    """Draw the manner of Fig. 2, the family of strategies and Fig. 5."""
    from ..report.duel_figure import draw_duel
    from ..report.unicycle_figures import draw_game
    from ..report.unicycle_sweep import draw_sweep
    from ..simulation.duel import run_duel
    from ..simulation.settings import DuelSettings
    from ..simulation.summary import summarise
    from ..studies.unicycle_claims import FIG_2, play

    def duel(file: str) -> None:
        result = run_duel(DuelSettings(seed=seed))
        summary = summarise(result)
        draw_duel(result.arrays, summary, result.settings, Path(file))

    drawings: dict[str, tuple[str, Any]] = {
        "fig2.png": (
            "Unicycles under (1)-(4), in the manner of Fig. 2",
            lambda file: draw_game(play(FIG_2), file),
        ),
        "sweep.png": (
            "The circle over angle and ratios: theory as lines, simulation "
            "as marks",
            lambda file: draw_sweep(FIG_2, file),
        ),
        f"duel-seed{seed}.png": (
            "Two NAOs in physics, in the manner of Fig. 5",
            duel,
        ),
    }
    for name, (_, draw) in drawings.items():
        if not (folder / name).exists():
            draw(str(folder / name))
    return [(caption, name) for name, (caption, _) in drawings.items()]
