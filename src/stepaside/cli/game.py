"""``stepaside game``: a game of any number of players, from a file."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .options.common_options import (
    figure_option,
    figure_width,
    folder_option,
    game_time_option,
    json_option,
    seed_option,
)
from .options.parameter_types import NameType
from .output_files import attempt, writes_files
from .progress import SIMULATED, announce_effort, show_progress
from .run_output import save_run
from .tables import print_table
from .terminal import echo, print_json

if TYPE_CHECKING:
    from ..games.game_settings import GameSettings
    from ..games.run import MatchRun


MOST_PAIRS = 15  # that are all printed


def _levels() -> tuple[str, ...]:
    from ..games.game_settings import GAME_LEVELS

    return GAME_LEVELS


level_option = click.option(
    "--level",
    type=NameType(_levels),
    help="Level of the game, instead of that of the file.",
)


@click.command("game")
@click.argument(
    "file", type=click.Path(exists=True, dir_okay=False, path_type=Path)
)
@seed_option()
@game_time_option()
@level_option
@folder_option(
    help="Run folder; a new one in runs/ by default, none with --json."
)
@figure_option(help="Write a copy of the figure (.png, .svg or .pdf).")
@figure_width
@json_option
@writes_files
def game(
    file: Path,
    output: Path | None,
    figure: str | None,
    as_json: bool,
    **changes: Any,
) -> None:
    """Play the game of the players that FILE lists.

    FILE is TOML with a table [[players]] for each player: a robot, its
    template unicycle, a person, or a recorded player. Prints the closest
    approach of each pair, and writes a run folder, which `stepaside show`
    shows.
    """
    from ..games.game_file import load_game
    from ..games.outcome import Outcome
    from ..games.run_archive import results_of
    from ..report.run_folder import check_output, figure_name, free_folder

    given = {k: v for k, v in changes.items() if v is not None}
    settings = load_game(file, **given)
    if output is None and not as_json:
        output = free_folder(Path("runs"), f"game-seed{settings.seed}")
    if output is not None:
        check_output(output)
    seconds = settings.duration
    share = 0.5 * max(len(settings.robots), 1)
    if settings.level == "physics":
        what = f"a game of {len(settings.players)} players and {seconds:g} s"
        announce_effort(what, share * seconds / SIMULATED)
    run = _play(settings)
    saved = save_run(output, run)
    if figure is not None and run.outcome is not Outcome.INTERRUPTED:
        from ..report.run_figure import draw_run

        attempt(lambda: draw_run(run, Path(figure)))
    if as_json:
        print_json(results_of(run) | saved.entries)
    else:
        print_game(run)
        saved.print_paths(figure_name(run))
    saved.raise_failure()
    saved.exit_if_interrupted(run.outcome)


def _play(settings: "GameSettings") -> "MatchRun":
    """Play the game with a progress bar on standard error."""
    from ..games.game import Progress
    from ..games.recorded_game import run_game

    look = "{desc} {bar} {n:.0f}/{total:.0f} s simulated{postfix}"
    total = settings.duration
    with show_progress("game", total, "s simulated", bar_format=look) as bar:

        def report(progress: Progress) -> None:
            bar.n = progress.time
            text = f"{progress.real_time_factor:.1f}x real time"
            if progress.distance is not None:
                text = f"least distance {progress.distance:.2f} m, {text}"
            bar.set_postfix_str(text)

        result = run_game(settings, report)
        bar.n = min(result.duration, settings.duration)
        bar.refresh()
    return result


def print_game(run: "MatchRun") -> None:
    """Print the summary of a game, one line for each player and pair.

    Args:
        run: The game.
    """
    summary = run.summary
    print_table(
        [
            ("outcome", f"{run.outcome.value}: {run.message}"),
            ("level", summary.level),
            ("maneuvers planned", str(summary.replans)),
            (
                "simulation speed",
                f"{summary.real_time_factor:.1f} x real time",
            ),
        ]
    )
    lines = []
    for player in summary.results:
        facts = [f"path {player.path_m:.2f} m"]
        if player.radius_m is not None:
            facts.append(f"radius {player.radius_m:.3f} m")
        if player.goal_at_s is not None:
            facts.append(f"goal at {player.goal_at_s:.1f} s")
        facts += [
            word
            for word, holds in (
                ("fell", player.fell),
                ("touched", player.touched),
            )
            if holds
        ]
        role = f"{player.role}, {player.body}"
        lines.append((player.name, f"{role}: {', '.join(facts)}"))
    echo("")
    print_table(lines)
    echo("")
    # Of many pairs only those of a player that decides; --json has them all.
    deciding = {p.name for p in run.settings.players if p.decides}
    few = len(summary.pairs) <= MOST_PAIRS
    print_table(
        [
            (" - ".join(pair.players), _pair_text(pair))
            for pair in summary.pairs
            if few or deciding.intersection(pair.players)
        ]
    )
    if summary.crowd:
        echo("")
        print_table([(c.name, _crowd_text(c)) for c in summary.crowd])


def _pair_text(pair: Any) -> str:
    """Return the closest approach and the mean distance of a pair."""
    text = (
        f"closest approach {pair.closest_m:.3f} m at {pair.closest_at_s:.1f} "
        f"s, last third {pair.distance_m:.3f} m, {pair.angle_deg:.1f} deg"
    )
    if pair.captured_at_s is not None:
        text += f", captured at {pair.captured_at_s:.1f} s"
    return text


def _crowd_text(crowd: Any) -> str:
    """Return how a robot fared among people."""
    reached = "" if crowd.time_s is None else f" in {crowd.time_s:.1f} s"
    return (
        f"{'success' if crowd.success else 'no success'}{reached} among "
        f"{crowd.people} people, {crowd.collisions} collisions, "
        f"{crowd.below_0_45_m_s:.1f} s below 0.45 m, "
        f"{crowd.below_1_2_m_s:.1f} s below 1.2 m"
    )
