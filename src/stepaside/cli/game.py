"""``stepaside run FILE``: a game of any number of players."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .options import file_argument, folder_option, json_option
from .run_output import finish_run, play_with_bar, run_folder
from .settings import changes_of, lists_option, set_option, set_pair
from .settings_text import commented
from .tables import print_table
from .terminal import echo, write_result

if TYPE_CHECKING:
    from ..games.run import MatchRun

MOST_PAIRS = 15  # that are all printed


@click.command("game")
@file_argument("file")
@click.option("--seed", metavar="NUMBER", help="Random seed.")
@click.option("--duration", metavar="NUMBER", help="Simulated time [s].")
@click.option("--level", metavar="TEXT", help="Level of simulation.")
@lists_option
@set_option
@folder_option()
@json_option
def game(
    file: Path,
    sets: tuple[str, ...],
    lists: bool,
    output: Path | None,
    as_json: bool,
    **named: str | None,
) -> None:
    """Play the game of the players that FILE lists.

    FILE is TOML with a table [[players]] for each player: a robot, its
    template unicycle, a person, or a recorded player (docs/games.md). Prints
    the closest approach of each pair, and writes a run folder, which
    `stepaside show` shows.
    """
    from ..core.setting import entries_of
    from ..games.game_file import load_game
    from ..games.game_settings import GameSettings
    from ..games.recorded_game import run_game

    texts = [(name, text) for name, text in named.items() if text]
    texts += map(set_pair, sets)
    changes = changes_of(texts, entries_of(GameSettings), GameSettings)
    settings = load_game(file, **changes)
    if lists:
        write_result(commented(settings))
        return
    folder = run_folder(output, as_json, f"game-seed{settings.seed}")
    run = play_with_bar(settings, run_game)
    finish_run(run, folder, as_json, lambda: print_game(run))


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
