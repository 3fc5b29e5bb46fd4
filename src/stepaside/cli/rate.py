"""``stepaside rate``: strategies against a fixed suite."""

from pathlib import Path
from typing import Any

import click

from .campaign_options import CampaignOptions
from .campaign_reports import finish_campaign, run_campaign
from .options.common_options import (
    figure_option,
    game_time_option,
    json_option,
    workers_option,
)
from .options.parameter_types import NameType, OutputFile
from .output_files import attempt, writes_files
from .progress import DECISIONS, announce_effort
from .tables import interval, number, percent, print_columns
from .terminal import echo, print_json

FEW = 200  # games that need no worker processes


def _roles() -> tuple[str, ...]:
    from ..studies.strategy_rating import ROLES

    return ROLES


def print_scores(result: dict[str, Any]) -> None:
    """Print all pairings, and the scores below them."""
    heads = ("strategy", "world", "opponent", "survived", "95 %")
    print_columns(
        (*heads, "closest", "+-", "regret", "ratio"),
        [
            (
                row["strategy"],
                row["world"],
                row["opponent"],
                percent(row["survived"]),
                interval(row["survived_low"], row["survived_high"]),
                number(row["mean_closest_m"], "m"),
                number(row["mean_closest_pm_m"]),
                number(row["mean_regret_m"]),
                number(row["mean_ratio"]),
            )
            for row in result["rows"]
        ],
        left=range(3),
    )
    for row in result["scores"]:
        echo(
            f"{row['strategy']}, {row['role']}: score "
            f"{row['score_m']:.3f} +- {row['score_pm_m']:.3f} m"
        )


@click.command("rate")
@click.argument("strategies", nargs=-1, required=True, metavar="STRATEGY...")
@click.option(
    "--role",
    type=NameType(_roles),
    help="Role of the strategies, where their direction does not tell it.",
)
@click.option(
    "--games",
    type=click.IntRange(1, 10_000),
    default=50,
    show_default=True,
    help="Number of games with each opponent in each world; seeds from 0.",
)
@game_time_option(
    default=60.0,
    show_default=True,
    help="Duration of a game [s], path time.",
)
@workers_option()
@click.option(
    "--output",
    type=OutputFile(".json"),
    help="Write the card: settings, rows and scores (.json).",
)
@figure_option(help="Write a figure of the closest approaches.")
@json_option
@writes_files
def rate(
    strategies: tuple[str, ...],
    role: str | None,
    games: int,
    duration: float,
    workers: int | None,
    output: str | None,
    figure: str | None,
    as_json: bool,
) -> None:
    """Rate strategies against a fixed suite of opponents and worlds.

    STRATEGY is a name, with arguments or without, FILE.py:NAME or FILE.onnx.
    Games are played in steps: on an open floor, there with any headings, in
    rooms of 3 m, and in such rooms with three discs. The regret
    is the best closest approach of any evader on an open floor, from the same
    start against the paper's pursuer, less the closest approach reached;
    contact with an obstacle counts as zero.
    """
    from ..strategies.strategy_game import StepGame
    from ..studies.result_files import header, write_result
    from ..studies.strategy_rating import (
        rating_rows,
        rating_study,
        role_of,
        score_rows,
    )

    rated = [(name, role_of(name, role)) for name in dict.fromkeys(strategies)]
    study = rating_study(rated, games, duration)
    rules, number = StepGame(), len(study.cases)
    announce_effort(
        f"{number} games of {duration:g} s",
        number * duration * rules.speed / rules.stride / DECISIONS,
        workers,
    )
    campaign = CampaignOptions(workers)
    run = run_campaign(study, campaign, "games", few=FEW)
    rows = rating_rows(list(run.records()))
    head = header({"games": games, "duration_s": duration})
    result: dict[str, Any] = {
        **head,
        "rows": rows,
        "scores": score_rows(rows),
    }
    if output is not None and run.completed:
        target = Path(output)
        attempt(lambda: write_result(target, result))
        result["output"] = output
    if figure is not None and run.completed:
        from ..report.rating_figure import draw_rating

        if attempt(lambda: draw_rating(rows, figure)):
            result["figure"] = figure
    if as_json:
        print_json(result)
    else:
        print_scores(result)
    finish_campaign(run, campaign, "games")
