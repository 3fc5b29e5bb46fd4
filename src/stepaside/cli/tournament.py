"""``stepaside tournament``: evaders against pursuers in random rooms."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..arena import Room, RoomRecipe, load_room
from ..control.clearance.map_settings import MAPS
from ..core.atomic_output import FIGURES
from ..core.errors import ConfigurationError
from .campaign_options import CampaignOptions, campaign_options
from .campaign_reports import finish_campaign, run_campaign
from .duels import seeds_option
from .options.common_options import (
    figure_option,
    game_time_option,
    json_option,
)
from .options.parameter_types import (
    ArenaType,
    NameType,
    NumberType,
    OutputFile,
)
from .options.settings_options import refuse_options, takes
from .output_files import attempt, writes_files
from .progress import DECISIONS, SIMULATED, announce_effort
from .tables import interval, number, percent, print_columns
from .terminal import echo, print_json

if TYPE_CHECKING:
    from ..studies.study import StudyRun
    from ..studies.tournament_campaign import Game


def print_rows(rows: list[dict[str, Any]]) -> None:
    """Print one line per pairing, below an explanation of the columns."""
    if rows:
        echo(
            f"captured: distance <= {rows[0]['capture_distance_m']:.3f} m; "
            "circle: distance [m] on the paper's circle for moving aside, at "
            "the pursuer's gain; touched: contact with an obstacle"
        )
    heads = "evader pursuer circle games survived 95_% captured contact "
    heads += "touched closest of_bound floor turning unseen ms"
    print_columns(
        [head.replace("_", " ") for head in heads.split()],
        [_cells(row) for row in rows],
        left=(0, 1),
    )


def _cells(row: dict[str, Any]) -> list[str]:
    """Return the cells of a pairing."""
    return [
        row["evader"],
        row["pursuer"],
        number(row["circle_distance_m"]),
        str(row["games"]),
        percent(row["survived"]),
        interval(row["survived_low"], row["survived_high"]),
        percent(row["captured"]),
        percent(row["contact"]),
        percent(row["touched_obstacle"]),
        number(row["mean_closest_m"], "m"),
        number(row["closest_over_bound"]),
        number(row["floor_used_m2"], digits=2),
        number(row["turning_rad_s"]),
        percent(row["out_of_view"]),
        number(row["decision_ms"], digits=2),
    ]


SOLVES = (
    "stepaside: computing the bound table first, once per machine; about "
    "half a minute"
)
SUMMARY = "summary.json"
FEW = 20  # games of unicycles that need no worker processes
# Options of random rooms.
OF_ROOMS = {f"--{name}": name for name in ("discs", "boxes", "polygons")}


def _levels() -> tuple[str, ...]:
    from ..studies.tournament_settings import LEVELS

    return LEVELS


@click.command("tournament")
@click.option(
    "--level",
    type=NameType(_levels),
    default="steps",
    show_default=True,
    help="Level of simulation: footsteps, unicycles (eight decisions per "
    "step), or humanoids in physics.",
)
@click.option(
    "--evader",
    "evaders",
    multiple=True,
    metavar="NAME",
    help="Strategy of an evader: a name, with arguments like "
    "evasion(angle=45deg), FILE.py:NAME or FILE.onnx; repeatable.  "
    "[default: robust, look-ahead, optimal, and evasion of the paper, always "
    "triggered: aside, saturated and at 45deg]",
)
@click.option(
    "--pursuer",
    "pursuers",
    multiple=True,
    metavar="NAME",
    help="Strategy of a pursuer, likewise, like pursuit(gain=2), sharp or "
    "herding; repeatable.  [default: pursuit]",
)
@click.option(
    "--pursuer-speed",
    type=NumberType("1"),
    default=1.0,
    show_default=True,
    help="Speed of the pursuers over that of the evaders; not in physics.",
)
@click.option(
    "--room",
    type=ArenaType(),
    default="3x3",
    show_default=True,
    help="Width and depth of the room [m], open for a floor without walls, "
    "or a room file.",
)
@takes(RoomRecipe, "recipe", OF_ROOMS)
@game_time_option(
    default=180.0,
    show_default=True,
    help="Duration of a game [s]: path time (0.4 s per step) for footsteps "
    "and unicycles, simulated time for physics.",
)
@seeds_option(
    default="0:100",
    help="Range of seeds, one room each; END is excluded.",
)
@click.option(
    "--map",
    type=NameType(lambda: MAPS),
    default="given",
    show_default=True,
    help="Map that humanoids have of the room: the true map, a map built "
    "from their depth cameras, or none.",
)
@campaign_options(
    "Folder of results; an interrupted tournament in it is continued. None "
    "by default."
)
@figure_option(
    help="Write a figure of closest approach against floor area used."
)
@click.option(
    "--paths",
    type=OutputFile(*FIGURES),
    help="Write a figure with the worst game of each pairing (.png, .svg or "
    ".pdf).",
)
@json_option
@writes_files
def tournament(
    level: str,
    evaders: tuple[str, ...],
    pursuers: tuple[str, ...],
    pursuer_speed: float,
    room: Any,
    recipe: RoomRecipe,
    duration: float,
    seeds: range,
    map: str,  # noqa: A002 (the option)
    campaign: CampaignOptions,
    figure: str | None,
    paths: str | None,
    as_json: bool,
) -> None:
    """Run every evader against every pursuer in random rooms.

    Rules: a step of 0.04 m turns by at most 0.25 rad. The pursuer walks
    through obstacles. The evader is captured at a distance of 0.35 m, and
    touches an obstacle closer than 0.20 m to its centre. In physics,
    humanoids have ideal bodies; capture (the same distance) and contact of
    bodies are both reported. A survival rate holds only against the pursuer
    of its row. To continue an interrupted tournament, run it again with the
    same folder.
    """
    from ..strategies import load_strategy
    from ..strategies.strategy_game import StepGame
    from ..studies.tournament_settings import TournamentSettings
    from ..studies.tournament_strategies import EVADERS

    evaders, pursuers = evaders or EVADERS, pursuers or ("pursuit",)
    if level == "physics":
        refuse_options({"pursuer_speed"}, f"--level steps, got {level}")
    else:
        refuse_options({"map"}, f"--level physics, got {level}")
    for name in (*evaders, *pursuers):
        load_strategy(name)
    arena = _arena(room, recipe)
    game = StepGame(duration=duration, pursuer_speed_ratio=pursuer_speed)
    settings = TournamentSettings(level, arena, game, map)
    settings.arena(seeds[0])  # raises if the room cannot be generated
    pairings = [(e, p) for p in pursuers for e in evaders]
    number = campaign.share(len(pairings) * len(seeds))
    steps = duration * game.speed / game.stride / DECISIONS
    announce_effort(
        f"{number} games of {duration:g} s, fewer if some are recorded",
        number * (duration / SIMULATED if level == "physics" else steps),
        campaign.workers,
    )
    run = _run(settings, pairings, seeds, campaign)
    result = _result(settings, seeds, list(run.records()))
    output = campaign.output
    if output is not None and run.finished and campaign.is_whole:
        from ..studies.result_files import write_result

        summary = output / SUMMARY
        attempt(lambda: result.update(write_result(summary, result)))
    if figure is not None and run.completed:
        from ..report.tournament_figure import draw_front

        if attempt(lambda: draw_front(result["rows"], figure)):
            result["figure"] = figure
    if paths is not None and run.completed:
        from ..report.tournament_figure import draw_worst

        games = _worst(settings, result["rows"])
        if attempt(lambda: draw_worst(games, paths)):
            result["paths"] = paths
    if as_json:
        print_json(result)
    else:
        print_rows(result["rows"])
    finish_campaign(run, campaign, "games")


def _arena(
    room: Path | tuple[float, float] | None, recipe: RoomRecipe
) -> Room | RoomRecipe:
    """Return the room of a file, or how rooms of a size are generated."""
    if isinstance(room, Path):
        if recipe != RoomRecipe():
            raise ConfigurationError(
                "discs, boxes and polygons cannot be combined with a room "
                f"file, got {recipe.discs}, {recipe.boxes} and "
                f"{recipe.polygons}"
            )
        return load_room(room)
    width, depth = room or (None, None)
    return replace(recipe, width=width, depth=depth)


def _run(
    settings: Any,
    pairings: list[tuple[str, str]],
    seeds: range,
    campaign: CampaignOptions,
) -> "StudyRun[Game]":
    """Run all games with a progress bar."""
    from ..strategies.table_cache import is_pursuit_bound_cached
    from ..studies.tournament_campaign import tournament_study
    from ..studies.tournament_record import CELLS

    if not is_pursuit_bound_cached(CELLS):
        echo(SOLVES, err=True)
    study = tournament_study(settings, pairings, seeds)
    few = 0 if settings.level == "physics" else FEW
    return run_campaign(study, campaign, "games", few=few)


def _result(
    settings: Any, seeds: range, records: list[dict[str, Any]]
) -> dict[str, Any]:
    from ..studies.result_files import header
    from ..studies.tournament_rows import tournament_rows

    return {
        **header(settings.entries()),
        "seeds": f"{seeds.start}:{seeds.stop}",
        "rows": tournament_rows(records, settings.game),
    }


def _worst(settings: Any, rows: list[dict[str, Any]]) -> list[Any]:
    """Return title, room and trajectory of the worst game of each row."""
    from ..studies.tournament_record import play_paths

    games = []
    for row in rows:
        seed = row["worst_seeds"][0]
        room, track = play_paths(
            settings, (row["evader"], row["pursuer"]), seed
        )
        title = f"{row['evader']} against {row['pursuer']}, seed {seed}"
        games.append((f"{title}: {track.outcome}", room, track))
    return games
