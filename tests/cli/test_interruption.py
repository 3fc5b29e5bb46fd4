"""A command that is stopped says what is kept."""

from importlib import import_module
from pathlib import Path
from typing import Any

import click
import pytest
from click.testing import CliRunner, Result

from stepaside.cli.interruption import kept_in
from stepaside.cli.main import LazyGroup, all_commands, main
from stepaside.cli.output_files import OutputFile, attempt, writes_files
from stepaside.cli.run_output import SavedRun
from stepaside.core.atomic_output import writing
from stepaside.games.outcome import Outcome
from tools.fuzz import stopping


@click.command()
@click.option("--figure", type=OutputFile(".png"))
@click.option("--map", type=OutputFile(".png"))
@writes_files
def draws(figure: str, map: str) -> None:  # noqa: A002 (an option's name)
    """Draw one figure, and be stopped before the next is whole."""

    def draw() -> None:
        with writing(Path(figure)) as draft:
            draft.write_text("whole")

    attempt(draw)
    with writing(Path(map)) as draft:
        draft.write_text("half")
        raise KeyboardInterrupt


def stopped(words: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.chdir(folder)
    return CliRunner().invoke(draws, words.split())


def test_files_that_are_whole_are_named_and_no_other_is_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    words = "--figure=a.png --map=b.png"
    result = stopped(words, tmp_path, monkeypatch)
    assert result.exit_code == 130
    assert result.stderr == "stepaside: interrupted; kept: a.png\n"
    assert [file.name for file in tmp_path.iterdir()] == ["a.png"]


def test_a_file_that_was_there_before_is_not_said_to_be_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "b.png").write_text("old")
    words = "--figure=a.png --map=b.png --overwrite"
    result = stopped(words, tmp_path, monkeypatch)
    assert result.stderr == "stepaside: interrupted; kept: a.png\n"
    assert (tmp_path / "b.png").read_text() == "old"


def leave(kept: SavedRun, outcome: Outcome) -> Result:
    command = click.Command("x", callback=lambda: kept.leave_if(outcome))
    return CliRunner().invoke(command, [])


def test_a_game_that_was_stopped_says_where_it_lies() -> None:
    assert leave(SavedRun(Path("a")), Outcome.COMPLETED).exit_code == 0
    result = leave(SavedRun(Path("a")), Outcome.INTERRUPTED)
    assert result.exit_code == 130
    assert result.stderr.endswith("what was played is kept in a\n")
    result = leave(SavedRun(), Outcome.INTERRUPTED)
    assert result.stderr.endswith("nothing is kept without --output\n")


def test_a_campaign_says_what_is_done_and_where_it_goes_on() -> None:
    assert kept_in("3 of 9 duels", Path("out")) == (
        "3 of 9 duels are kept in out, and the same command goes on"
    )
    assert "nothing is kept" in kept_in("3 of 9 duels", None)


def test_the_paper_stopped_while_it_is_drawn_keeps_its_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from stepaside.cli import reproduce_figures

    def interrupt(*_: Any) -> None:
        raise KeyboardInterrupt

    module = import_module("stepaside.cli.reproduce")
    monkeypatch.setattr(module, "_measure", lambda *_: [])
    monkeypatch.setattr(reproduce_figures, "draw_figures", interrupt)
    result = CliRunner().invoke(main, ["reproduce", f"--output={tmp_path}"])
    assert result.exit_code == 130
    assert "all runs, and figures that are whole, are kept" in result.stderr


def test_what_is_stopped_anywhere_else_says_so_in_one_line() -> None:
    group = LazyGroup()
    group.get_command = lambda *_: click.Command(  # type: ignore[method-assign]
        "x", callback=lambda: (_ for _ in ()).throw(KeyboardInterrupt)
    )
    result = CliRunner().invoke(group, ["x"])
    assert result.exit_code == 130
    said = result.stderr.strip()  # behind the line that ^C begins
    assert "not whole" in said and "\n" not in said


def test_every_command_is_measured_or_short() -> None:
    """``python -m tools.fuzz.stopping`` stops all that are long."""
    known = {*stopping.LONG, *stopping.SHORT, *stopping.APART}
    assert known == set(all_commands())
