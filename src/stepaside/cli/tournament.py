"""``stepaside tournament``: evaders against pursuers in random rooms."""

from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import click

from ..arena import RoomRecipe
from ..control.clearance.map_settings import MAPS
from ..core.atomic_output import FIGURES, check_folder
from ..core.errors import ConfigurationError, OutputError
from .campaign_reports import CampaignOutcome, run_campaign_work
from .duels import seeds_option
from .effort_estimate import DECISIONS, SIMULATED, announce_effort
from .interruption import exit_interrupted, resume_message
from .options.common_options import (
    figure_option,
    folder_option,
    game_time_option,
    json_option,
    workers_option,
)
from .options.parameter_types import (
    ANGLE,
    ArenaType,
    NameType,
    OutputFile,
)
from .options.setting_options import refuse_options, takes
from .output_files import attempt, writes_files
from .progress import show_progress
from .terminal import echo, print_json


def print_rows(rows: list[dict[str, Any]]) -> None:
    """Print one line per pairing, below an explanation of the columns."""
    if rows:
        echo(
            f"captured: distance <= {rows[0]['capture_distance_m']:.3f} m; "
            "circle: distance [m] on the paper's circle for moving aside, at "
            "the pursuer's gain; touched: contact with an obstacle"
        )
    echo(
        f"{'evader':<12}{'pursuer':<11}{'circle':>7}{'games':>6}"
        f"{'survived':>10}{'95 %':>14}{'captured':>10}{'contact':>9}"
        f"{'touched':>9}{'closest':>9}"
        f"{'of bound':>9}{'floor':>7}{'turning':>9}{'unseen':>8}{'ms':>7}"
    )
    for row in rows:
        low, high = row["survived_low"], row["survived_high"]
        echo(
            f"{row['evader'][-11:]:<12}{row['pursuer'][-10:]:<11}"
            f"{_circle(row['circle_distance_m']):>7}"
            f"{row['games']:>6}{100 * row['survived']:>8.1f} %"
            f"{100 * low:>7.1f}-{100 * high:<6.1f}"
            f"{100 * row['captured']:>8.1f} %"
            f"{_percent(row['contact']):>9}"
            f"{100 * row['touched_obstacle']:>7.1f} %"
            f"{row['mean_closest_m']:>7.3f} m{row['closest_over_bound']:>9.3f}"
            f"{row['floor_used_m2']:>7.2f}{row['turning_rad_s']:>9.3f}"
            f"{100 * row['out_of_view']:>6.1f} %{row['decision_ms']:>7.2f}"
        )


def _circle(distance: float | None) -> str:
    return "-" if distance is None else f"{distance:.3f}"


def _percent(fraction: float | None) -> str:
    return "-" if fraction is None else f"{100 * fraction:.1f} %"


SOLVES = (
    "stepaside: computing the bound table first, once per machine; about "
    "half a minute"
)
RECORDS = "games.jsonl"
SUMMARY = "summary.json"
# Options of rooms that a tournament does not have.
OF_ROOMS = ("doors", "smallest", "largest", "door_width")


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
    help="Strategy of an evader: look-ahead, aside, saturated, alpha, "
    "deflected, optimal or FILE.py:NAME; repeatable.  [default: all]",
)
@click.option(
    "--pursuer",
    "pursuers",
    multiple=True,
    metavar="NAME",
    help="Strategy of a pursuer: pure (the paper's), pure-xRATIO (with RATIO "
    "times the evader's gain), sharp (turns by the whole bearing, up to the "
    "maximum), herding (aims halfway between the evader and the centre of "
    "the room), lead, optimal or FILE.py:NAME; repeatable.  [default: pure]",
)
@click.option(
    "--room",
    type=ArenaType(),
    default="3x3",
    show_default=True,
    help="Width and depth of the room [m], open for a floor without walls, "
    "or a room file.",
)
@takes(RoomRecipe, "recipe", without=OF_ROOMS)
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
    "--alpha",
    type=ANGLE,
    default=pi / 4,
    help="Evasion angle of the evader alpha [rad].  [default: 45deg]",
)
@click.option(
    "--map",
    type=NameType(lambda: MAPS),
    default="given",
    show_default=True,
    help="Map that humanoids have of the room: the true map, a map built "
    "from their depth cameras, or none.",
)
@workers_option()
@folder_option(
    help="Folder of results; an interrupted tournament in it is continued. "
    "None by default."
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
    room: Any,
    recipe: RoomRecipe,
    duration: float,
    seeds: range,
    alpha: float,
    map: str,  # noqa: A002 (the option)
    workers: int | None,
    output: Path | None,
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
    from ..arena import load_room
    from ..strategies.step_game import StepGame
    from ..studies.entrants import EVADERS, evader_of, pursuer_of
    from ..studies.tournament_settings import TournamentSettings

    evaders, pursuers = evaders or tuple(EVADERS), pursuers or ("pure",)
    if "alpha" not in evaders:
        refuse_options({"alpha"}, "--evader alpha")
    if level != "physics":
        refuse_options({"map"}, f"--level physics, got {level}")
    for name in evaders:
        evader_of(name, alpha)
    for name in pursuers:
        pursuer_of(name)
    arena: Any
    if isinstance(room, Path):
        if recipe != RoomRecipe():
            raise ConfigurationError(
                "discs, boxes and polygons cannot be combined with a room "
                f"file, got {recipe.discs}, {recipe.boxes} and "
                f"{recipe.polygons}"
            )
        arena = load_room(room)
    else:
        width, depth = room or (None, None)
        arena = replace(recipe, width=width, depth=depth)
    game = StepGame(duration=duration)
    settings = TournamentSettings(level, arena, game, alpha, map)
    settings.arena(seeds[0])  # raises if the room cannot be generated
    if output is not None:
        check_folder(output, new=False)
    pairings = [(e, p) for p in pursuers for e in evaders]
    number = len(pairings) * len(seeds)
    steps = duration * game.speed / game.stride / DECISIONS
    announce_effort(
        f"{number} games of {duration:g} s, fewer if some are recorded",
        number * (duration / SIMULATED if level == "physics" else steps),
        workers,
    )
    records, ended = _run(settings, pairings, seeds, output, workers)
    result = _result(settings, seeds, records)
    failed = ended.failed
    if output is not None and records and failed is None:
        from ..studies.result_files import write_result

        try:
            result = write_result(output / SUMMARY, result)
        except OutputError as error:
            failed = error
    if figure is not None and records and ended.completed:
        from ..report.tournament_figure import draw_front

        if attempt(lambda: draw_front(result["rows"], figure)):
            result["figure"] = figure
    if paths is not None and records and ended.completed:
        from ..report.tournament_figure import draw_worst

        games = _worst(settings, result["rows"])
        if attempt(lambda: draw_worst(games, paths)):
            result["paths"] = paths
    if as_json:
        print_json(result)
    else:
        print_rows(result["rows"])
    if failed is not None:
        raise failed
    if ended.stopped:
        done = f"{len(records)} of {number} games"
        exit_interrupted(resume_message(done, output and output / RECORDS))


def _run(
    settings: Any,
    pairings: list[tuple[str, str]],
    seeds: range,
    output: Path | None,
    workers: int | None,
) -> tuple[list[dict[str, Any]], CampaignOutcome]:
    """Run all games with a progress bar; return records and outcome."""
    from contextlib import nullcontext

    from ..core.worker_pool import worker_pool
    from ..strategies.bound_cache import is_pursuit_bound_cached
    from ..studies.record_store import RecordStore
    from ..studies.tournament_campaign import CELLS, play_tournament

    if not is_pursuit_bound_cached(CELLS):
        echo(SOLVES, err=True)
    file = None if output is None else RecordStore(output / RECORDS)
    total = len(seeds) * len(pairings)
    # Starting a pool takes longer than a few games.
    alone = workers == 1 or total <= 2 * settings.block
    done: dict[str, dict[str, Any]] = {}
    with (
        show_progress("tournament", total, "games") as bar,
        nullcontext() if alone else worker_pool(workers) as executor,
    ):

        def report(number: int) -> None:
            bar.n = number
            bar.refresh()

        ended = run_campaign_work(
            lambda: play_tournament(
                settings, pairings, seeds, file, executor, report, done
            ),
            None if file is None else file.path,
            lambda: done,
        )
    order = {pairing: number for number, pairing in enumerate(pairings)}
    return sorted(
        done.values(),
        key=lambda r: (order[r["evader"], r["pursuer"]], r["seed"]),
    ), ended


def _result(
    settings: Any, seeds: range, records: list[dict[str, Any]]
) -> dict[str, Any]:
    from ..studies.result_files import header
    from ..studies.tournament_rows import tournament_rows

    modules, libraries = settings.depends
    return {
        **header(settings.entries(), modules=modules, libraries=libraries),
        "seeds": f"{seeds.start}:{seeds.stop}",
        "rows": tournament_rows(records, settings.game),
    }


def _worst(settings: Any, rows: list[dict[str, Any]]) -> list[Any]:
    """Return title, room and trajectory of the worst game of each row."""
    from ..studies.tournament_campaign import play_paths

    games = []
    for row in rows:
        seed = row["worst_seeds"][0]
        room, track = play_paths(
            settings, (row["evader"], row["pursuer"]), seed
        )
        title = f"{row['evader']} against {row['pursuer']}, seed {seed}"
        games.append((f"{title}: {track.outcome}", room, track))
    return games
