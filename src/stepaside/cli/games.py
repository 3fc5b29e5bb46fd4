"""``stepaside games``: many games of a game file; teams against teams."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .campaign_options import CampaignOptions, campaign_options
from .campaign_reports import finish_campaign, run_campaign
from .duels import seeds_option
from .game import level_option
from .options.common_options import game_time_option, json_option
from .output_files import attempt, writes_files
from .progress import SIMULATED, announce_effort
from .tables import interval, number, print_columns
from .terminal import echo, print_json

if TYPE_CHECKING:
    from ..games.game_settings import GameSettings

SUMMARY = "summary.json"


@click.command("games")
@click.argument(
    "file", type=click.Path(exists=True, dir_okay=False, path_type=Path)
)
@seeds_option(default="0:20")
@click.option(
    "--pursuer",
    "pursuers",
    multiple=True,
    metavar="NAME",
    help="Strategy of all pursuers; repeatable.  [default: those of FILE]",
)
@click.option(
    "--evader",
    "evaders",
    multiple=True,
    metavar="NAME",
    help="Strategy of all evaders; repeatable.  [default: those of FILE]",
)
@game_time_option()
@level_option
@campaign_options(
    "Folder of results; an interrupted campaign in it is continued. "
    "runs/games by default, none with --json."
)
@json_option
@writes_files
def games(
    file: Path,
    seeds: range,
    pursuers: tuple[str, ...],
    evaders: tuple[str, ...],
    campaign: CampaignOptions,
    as_json: bool,
    **changes: Any,
) -> None:
    """Play the game of FILE with many seeds, and with teams of strategies.

    Every team of pursuers plays against every team of evaders. Prints how
    many games ended in capture, contact and a fall, the closest approach of
    opponents, and for robots among people success, collisions, time and
    intrusions, with 95 % intervals. To continue an interrupted campaign, run
    it again with the same folder.
    """
    from ..games.game_file import load_game
    from ..strategies.registry import check_strategy_name
    from ..studies.game_campaign import game_study
    from ..studies.result_files import write_result

    given = {k: v for k, v in changes.items() if v is not None}
    settings = load_game(file, **given)
    for name in pursuers:
        check_strategy_name(name, "pursuer")
    for name in evaders:
        check_strategy_name(name, "evader")
    if not as_json:
        campaign = campaign.with_default(Path("runs") / "games")
    study = game_study(settings, pursuers or ("",), evaders or ("",), seeds)
    number, seconds = campaign.share(len(study.cases)), settings.duration
    if settings.level == "physics":
        share = 0.5 * max(len(settings.robots), 1) * seconds / SIMULATED
        what = f"{number} games of {seconds:g} s, fewer if some are recorded"
        announce_effort(what, number * share, campaign.workers)
    run = run_campaign(study, campaign, "games", few=1)
    result = _result(settings, seeds, list(run.records()))
    if campaign.output is not None and run.finished and campaign.is_whole:
        summary = campaign.output / SUMMARY
        attempt(lambda: result.update(write_result(summary, result)))
    if as_json:
        print_json(result)
    else:
        print_rows(result["rows"])
        echo(f"\nresults: {campaign.output}")
    finish_campaign(run, campaign, "games")


def _result(
    settings: "GameSettings", seeds: range, records: list[dict[str, Any]]
) -> dict[str, Any]:
    from ..games.configuration_file import json_settings
    from ..studies.game_campaign import game_rows
    from ..studies.result_files import header

    entries = json_settings(settings)
    del entries["seed"]  # the result has an entry for all seeds
    return {
        **header(entries),
        "seeds": f"{seeds.start}:{seeds.stop}",
        "rows": game_rows(records),
    }


def print_rows(rows: list[dict[str, Any]]) -> None:
    """Print one line for each pairing of teams, and for each robot.

    Args:
        rows: Rows of :func:`stepaside.studies.game_campaign.game_rows`.
    """
    heads = ("pursuers", "evaders", "games", "captured", "contact", "fell")
    print_columns(
        (*heads, "mean", "closest"),
        [
            (
                row["pursuers"] or "of the file",
                row["evaders"] or "of the file",
                str(row["games"]),
                _share(row["captured"]),
                _share(row["contact"]),
                _share(row["fell"]),
                number(row["mean_closest_m"], "m"),
                number(row["least_closest_m"], "m"),
            )
            for row in rows
        ],
        left=(0, 1),
    )
    for row in rows:
        for robot in row["crowd"]:
            time = robot["mean_time_s"]
            echo(
                f"\n{robot['name']} among {robot['people']} people: success "
                f"{_share(robot['success'])}, collided "
                f"{_share(robot['collided'])}, mean time to the goal "
                f"{number(time, 's', 1)}, "
                f"{100 * robot['share_below_0_45']:.1f} % of the time below "
                f"0.45 m, {100 * robot['share_below_1_2']:.1f} % below 1.2 m"
            )


def _share(count: dict[str, float]) -> str:
    """Return a number of games with its 95 % interval."""
    return f"{count['number']} ({interval(count['low'], count['high'], 0)})"
