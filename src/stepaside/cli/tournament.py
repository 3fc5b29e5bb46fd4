"""``stepaside tournament``: evaders against pursuers, in rooms by seed."""

from math import pi
from pathlib import Path
from typing import Any

import click

from ..core.atomic_output import check_folder
from ..core.errors import ConfigurationError, OutputError
from .campaign_reports import CampaignOutcome, gather
from .duels import SEEDS
from .effort_estimate import DECISIONS, SIMULATED, tell_effort
from .interruption import kept_in, leave_stopped
from .options.arena_options import BOXES, DISCS, POLYGONS, ArenaType
from .options.common_options import (
    FIGURE,
    FOLDER,
    GAME_TIME,
    WORKERS,
    json_option,
)
from .options.declaration import OptionDeclaration
from .options.room_options import MAP
from .options.value_kinds import NameType, OutputFile
from .output_files import attempt, writes_files
from .progress import show_progress
from .terminal import echo
from .value_types import ANGLE, print_json


def print_rows(rows: list[dict[str, Any]]) -> None:
    """Print a line for each pairing, under what capture and circle mean."""
    if rows:
        echo(
            f"captured: distance <= {rows[0]['capture_distance_m']:.3f} m; "
            "circle: distance [m] on the circle of the paper, moving aside, "
            "at the pursuer's gain; touched: an obstacle"
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


def _percent(share: float | None) -> str:
    return "-" if share is None else f"{100 * share:.1f} %"


SOLVES = (
    "stepaside: solves the table of the bound first, once on this machine; "
    "about half a minute"
)
RECORDS, SUMMARY = "games.jsonl", "summary.json"
PATHS = OptionDeclaration(
    "--paths",
    "Draw the worst game of each pairing (.png, .svg or .pdf).",
    kind=OutputFile(".png", ".svg", ".pdf"),
)


def _levels() -> tuple[str, ...]:
    from ..studies.tournament_settings import LEVELS

    return LEVELS


@click.command("tournament")
@click.option(
    "--level",
    type=NameType(_levels),
    default="steps",
    show_default=True,
    help="Steps of the gait, unicycles, which decide eight times a step, or "
    "humanoids in physics.",
)
@click.option(
    "--evader",
    "evaders",
    multiple=True,
    metavar="NAME",
    help="look-ahead, aside, saturated, alpha, deflected, optimal or "
    "FILE.py:NAME; may be given more than once.  [default: all]",
)
@click.option(
    "--pursuer",
    "pursuers",
    multiple=True,
    metavar="NAME",
    help="pure (the paper's), pure-xRATIO (RATIO times the evader's gain), "
    "sharp (turns by the bearing, up to the largest turn), herding (aims half "
    "way between the evader and the room's centre), lead, optimal or "
    "FILE.py:NAME; likewise.  [default: pure]",
)
@click.option(
    "--room",
    type=ArenaType(),
    default="3x3",
    show_default=True,
    help="Size of the room [m], open for a floor without walls, or a file.",
)
@DISCS.option(default=0, show_default=True)
@BOXES.option(default=0, show_default=True)
@POLYGONS.option(default=0, show_default=True)
@GAME_TIME.option(
    default=180.0,
    show_default=True,
    help="Length of a game {unit}: in path time, of which a step takes 0.4, "
    "or in physics as it passes.",
)
@SEEDS.option(
    default="0:100",
    show_default=True,
    help="One room each; the end is not among them.",
)
@click.option(
    "--alpha",
    type=ANGLE,
    default=pi / 4,
    help="Strategy angle [rad] of the evader alpha.  [default: 45deg]",
)
@MAP.option(
    default="given",
    show_default=True,
    help="What humanoids know of the room: all, what their depth cameras "
    "have seen, or nothing.",
)
@WORKERS.option()
@FOLDER.option(
    help="Folder of results, which goes on with what it holds; none by "
    "default."
)
@FIGURE.option(help="Draw closest approach against the floor that was used.")
@PATHS.option()
@json_option
@writes_files
def tournament(
    level: str,
    evaders: tuple[str, ...],
    pursuers: tuple[str, ...],
    room: Any,
    discs: int,
    boxes: int,
    polygons: int,
    duration: float,
    seeds: range,
    alpha: float,
    map__source: str,
    workers: int | None,
    output: Path | None,
    figure: str | None,
    paths: str | None,
    as_json: bool,
) -> None:
    """Let evaders play pursuers in rooms by seed, and tabulate.

    The rules: a step of 4 cm turns by at most 0.25 rad; the pursuer walks
    through obstacles; the evader is captured at a distance of 0.35 m, and
    touches an obstacle that its centre comes nearer to than 0.20 m. In
    physics humanoids with ideal bodies play: capture is the same distance,
    contact is bodies that touch, and both are reported. A share of games
    survived holds against the pursuer of its row only. A tournament that was
    stopped goes on where it was with the same folder.
    """
    from ..arena import RoomRecipe, load_room
    from ..strategies.step_game import StepGame
    from ..studies.entrants import EVADERS, evader_of, pursuer_of
    from ..studies.tournament_settings import TournamentSettings

    evaders, pursuers = evaders or tuple(EVADERS), pursuers or ("pure",)
    for name in evaders:
        evader_of(name, alpha)
    for name in pursuers:
        pursuer_of(name)
    arena: Any
    if isinstance(room, Path):
        if discs or boxes or polygons:
            raise ConfigurationError(
                "discs, boxes and polygons must not be asked for in a room "
                f"from a file, got {discs}, {boxes} and {polygons}"
            )
        arena = load_room(room)
    else:
        width, depth = room or (None, None)
        arena = RoomRecipe(width, depth, discs, boxes, polygons)
    game = StepGame(duration=duration)
    settings = TournamentSettings(level, arena, game, alpha, map__source)
    settings.arena(seeds[0])  # whether there is such a room
    if output is not None:
        check_folder(output, new=False)
    pairings = [(e, p) for p in pursuers for e in evaders]
    number = len(pairings) * len(seeds)
    steps = duration * game.speed / game.stride / DECISIONS
    tell_effort(
        f"{number} games of {duration:g} s, less those that are recorded",
        number * (duration / SIMULATED if level == "physics" else steps),
        workers,
    )
    records, ended = _play(settings, pairings, seeds, output, workers)
    result = _answer(settings, seeds, records)
    failed = ended.failed
    if output is not None and records and failed is None:
        from ..studies.result_files import write_result

        try:
            result = write_result(output / SUMMARY, result)
        except OutputError as error:
            failed = error
    if figure is not None and records and ended.whole:
        from ..report.tournament_figure import draw_front

        if attempt(lambda: draw_front(result["rows"], figure)):
            result["figure"] = figure
    if paths is not None and records and ended.whole:
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
        leave_stopped(kept_in(done, output and output / RECORDS))


def _play(
    settings: Any,
    pairings: list[tuple[str, str]],
    seeds: range,
    output: Path | None,
    workers: int | None,
) -> tuple[list[dict[str, Any]], CampaignOutcome]:
    """Play with a progress bar, and say how it ended."""
    from contextlib import nullcontext

    from ..core.worker_pool import worker_pool
    from ..strategies.bound_cache import has_pursuit_bound
    from ..studies.record_store import RecordStore
    from ..studies.tournament_campaign import CELLS, play_tournament

    if not has_pursuit_bound(CELLS):
        echo(SOLVES, err=True)
    file = None if output is None else RecordStore(output / RECORDS)
    total = len(seeds) * len(pairings)
    # A pool takes longer to begin than a few games.
    alone = workers == 1 or total <= 2 * settings.block
    done: dict[str, dict[str, Any]] = {}
    with (
        show_progress("tournament", total, "games") as bar,
        nullcontext() if alone else worker_pool(workers) as executor,
    ):

        def report(number: int) -> None:
            bar.n = number
            bar.refresh()

        ended = gather(
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


def _answer(
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
    """The worst game of each row: its title, room and track."""
    from ..studies.tournament_campaign import play_ways

    games = []
    for row in rows:
        seed = row["worst_seeds"][0]
        room, track = play_ways(
            settings, (row["evader"], row["pursuer"]), seed
        )
        title = f"{row['evader']} by {row['pursuer']}, seed {seed}"
        games.append((f"{title}: {track.outcome}", room, track))
    return games
