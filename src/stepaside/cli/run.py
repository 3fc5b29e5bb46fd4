"""``stepaside run``: a game file, a walk, unicycles or a room."""

import json
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..arena import Room, RoomRecipe
from ..core.entries import to_entries
from ..core.errors import PlanError
from ..games.game_settings import GameSettings
from ..games.game_settings import walk as make_walk
from ..report.result_labels import CIRCLES, label_of
from ..theory.unicycle.unicycle_settings import UnicycleSettings
from .main import LazyGroup
from .options import (
    EXISTING_FILE,
    figure_option,
    file_argument,
    folder_option,
    output_file,
    seed_option,
)
from .run_output import finish_run, play_with_bar, run_folder
from .settings import refuse_settings, takes_settings
from .tables import (
    format_value,
    plain,
    print_table,
    result_rows,
    table_rows,
)
from .terminal import json_option, print_json

if TYPE_CHECKING:
    from ..theory.unicycle import RelativeStart

COMMANDS = {
    "game": "Play the game of FILE; the word may be left out.",
    "walk": "Simulate the walk of one humanoid and measure it.",
    "unicycles": "Simulate one game of two unicycles (Sec. II).",
    "room": "Generate a random room, or inspect a room file.",
}


@click.group("run", cls=LazyGroup, lazy=COMMANDS, module="run", default="game")
def run(**_: Any) -> None:
    """Play a game FILE, or run a walk, unicycles or a room.

    `stepaside run FILE` plays the game of the players that FILE lists.
    """


NAMED_OF_GAME = ("seed", "duration", "level")


@click.command("game")
@takes_settings(
    NAMED_OF_GAME,
    GameSettings,
    config=click.argument("config", metavar="FILE", type=EXISTING_FILE),
)
@folder_option()
@json_option
def game(settings: GameSettings, output: Path | None, as_json: bool) -> None:
    """Play the game of the players that FILE lists.

    FILE is TOML with a table [[players]] for each player: a robot, its
    template unicycle, a person, or a recorded player (docs/games.md). Prints
    the closest approach of each pair, and writes a run folder, which
    `stepaside show` shows.
    """
    from ..games.recorded_game import run_game

    folder = run_folder(output, as_json, f"game-seed{settings.seed}")
    run = play_with_bar(settings, run_game)
    finish_run(run, folder, as_json)


NAMED_OF_WALK = ("seed", "duration", "robot", "gait", "body", "pushes")


@click.command("walk")
@takes_settings(NAMED_OF_WALK, make_walk())
@click.option(
    "--bearing",
    metavar="ANGLE",
    help="Desired heading in the frame of the support foot, like 10deg; "
    "straight ahead by default.",
)
@click.option("--backward", is_flag=True, help="Walk backward.")
@folder_option(help="Run folder; the run is not saved by default.")
@json_option
def walk(
    settings: GameSettings,
    bearing: str | None,
    backward: bool,
    output: Path | None,
    as_json: bool,
) -> None:
    """Simulate the walk of one humanoid and measure it.

    Speed, turning, slip, tracking error and estimation error are measured
    after the first three seconds, in the frame of the support foot.
    """
    from ..games.recorded_game import run_game

    if bearing or backward:
        way = f"walk{'-backward' * backward}(bearing={bearing or 0})"
        settings = settings.changed(walker={"strategy": way})
    folder = run_folder(output, as_json, None)
    run = play_with_bar(settings, run_game)
    finish_run(run, folder, as_json)


NAMED_OF_UNICYCLES = (
    *("speed", "gain", "angle", "law", "distance"),
    *("aim", "bearing", "duration"),
)
COMPARED = (
    "radius_pursuer_m",
    "radius_evader_m",
    "distance_m",
    "turning_rate_rad_s",
    "headings_apart_rad",
    "motions_apart_rad",
)


@click.command("unicycles")
@takes_settings(NAMED_OF_UNICYCLES, UnicycleSettings)
@figure_option()
@json_option
def unicycles(
    settings: UnicycleSettings, figure: Path | None, as_json: bool
) -> None:
    """Simulate one game of two unicycles and compare it with theory."""
    from ..theory.unicycle.certificate import certify
    from ..theory.unicycle.circles import circle_of

    game, start = settings.game, settings.start
    run, measured = _simulate(settings, start)
    result: dict[str, Any] = {
        "start": asdict(start),
        "capture_distance_m": settings.capture,
        "game": to_entries(game),
        **measured,
        "certified_m": None,
    }
    # It is for equal players that do not move straight back.
    with suppress(PlanError):
        result["certified_m"] = certify(game, start)
    theory = plain(circle_of(game))
    named = ("exists", *COMPARED, "time_constant_s")
    result["theory"] = {name: theory[name] for name in named}
    print_json(result) if as_json else _print_unicycles(result)
    if figure is not None:
        from ..report.unicycle_figures import draw_game

        draw_game(run, str(figure))


def _simulate(
    settings: UnicycleSettings, start: "RelativeStart"
) -> tuple[Any, dict[str, Any]]:
    """Simulate the laws of the paper and measure the paths."""
    from ..theory.unicycle.simulation import measure, simulate

    run = simulate(
        settings.game,
        start,
        settings.time,
        capture_distance=settings.capture,
    )
    result: dict[str, Any] = {
        "captured": run.captured,
        "end_time_s": run.end_time,
        "closest_distance_m": run.closest_distance,
        "closest_time_s": run.closest_time,
        "switch_times_s": list(run.switches),
    }
    if not run.captured:
        result |= plain(measure(run))
        rate = result["turning_rate_rad_s"]
        result["turning_rate_rad_s"] = abs(rate or 0.0)
        result["circle"] = run.circle and {
            "direction": run.circle.direction,
            "distance_m": run.circle.distance_m,
            "stable": run.circle.stable,
        }
    return run, result


def _print_unicycles(result: dict[str, Any]) -> None:
    """Print measured values beside the closed form."""
    theory = result["theory"]
    rows = [("", "simulated        closed form")]
    for name in COMPARED:
        cells = [result.get(name), theory[name]]
        texts = [format_value(name, cell) for cell in cells]
        rows.append((label_of(name), f"{texts[0]:<16} {texts[1]}"))
    circle = result.get("circle")
    if circle is not None:
        name = CIRCLES[circle["direction"]]
        rows.append(("ended on", f"the {name} circle"))
    certified = result.get("certified_m")
    if certified is not None:
        text = format_value("certified_m", certified)
        rows.append(("certified distance", f">= {text}"))
    ends = ("captured", "end_time_s", "closest_distance_m")
    print_table([*rows, *table_rows(result, ends)])


NAMED_OF_ROOM = ("width", "depth", "discs", "boxes", "polygons", "doors")


@click.command("room")
@file_argument("file", required=False)
@seed_option()
@takes_settings(NAMED_OF_ROOM, RoomRecipe)
@click.option(
    "--output",
    type=output_file("--output", ".toml", ".json"),
    help="Write the room (.toml or .json).",
)
@figure_option()
@json_option
def room(
    file: Path | None,
    seed: int,
    settings: RoomRecipe,
    output: Path | None,
    figure: Path | None,
    as_json: bool,
) -> None:
    """Generate a random room with initial poses, or inspect a room FILE.

    Prints the numbers of obstacles and doors, and the narrowest gap.
    """
    from ..arena import check_initial_poses, generate_room, load_room
    from ..arena.room_generation import measure_room

    if file is None:
        made = generate_room(settings, seed)
    else:
        refuse_settings(("",), "a random room, got a room file")
        made = load_room(file)
        if made.starts is not None:
            check_initial_poses(made, made.starts)
    result = measure_room(made)
    print_json(result) if as_json else print_table(result_rows(result))
    if output is not None:
        _write_room(made, output)
    if figure is not None:
        from ..report.plan_view import draw_room

        draw_room(made, str(figure))


def _write_room(made: Room, file: Path) -> None:
    """Write a room in the format of the file suffix."""
    import tomli_w

    from ..core.atomic_output import atomic_draft
    from ..core.entries import to_entries

    entries = to_entries(made)
    text = tomli_w.dumps(entries)
    if file.suffix.lower() == ".json":
        text = json.dumps(entries, allow_nan=False) + "\n"
    with atomic_draft(file) as draft:
        draft.write_text(text, encoding="utf-8")
