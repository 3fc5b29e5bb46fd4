"""An interrupted command reports what is saved."""

from pathlib import Path
from typing import Any

import click
import pytest
from click.testing import CliRunner, Result

from stepaside.cli.main import LazyGroup, main
from stepaside.cli.output_files import OutputFile, attempt, writes_files
from stepaside.cli.run_output import SavedRun
from stepaside.cli.terminal import resume_message
from stepaside.core.atomic_output import atomic_draft
from stepaside.games.outcome import Outcome
from stepaside.studies.study import Study, run_study


@click.command()
@click.option("--figure", type=OutputFile(".png"))
@click.option("--map", type=OutputFile(".png"))
@writes_files
def draws(figure: str, map: str) -> None:  # noqa: A002 (an option's name)
    """Write one figure; be interrupted while writing the next."""

    def draw() -> None:
        with atomic_draft(Path(figure)) as draft:
            draft.write_text("whole")

    attempt(draw)
    with atomic_draft(Path(map)) as draft:
        draft.write_text("half")
        raise KeyboardInterrupt


def interrupted(
    arguments: str, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> Result:
    monkeypatch.chdir(folder)
    return CliRunner().invoke(draws, arguments.split())


def test_only_completed_files_exist_and_are_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    arguments = "--figure=a.png --map=b.png"
    result = interrupted(arguments, tmp_path, monkeypatch)
    assert result.exit_code == 130
    assert result.stderr == "stepaside: interrupted; saved: a.png\n"
    assert [file.name for file in tmp_path.iterdir()] == ["a.png"]


def test_file_from_before_is_not_reported_as_saved(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "b.png").write_text("old")
    arguments = "--figure=a.png --map=b.png --overwrite"
    result = interrupted(arguments, tmp_path, monkeypatch)
    assert result.stderr == "stepaside: interrupted; saved: a.png\n"
    assert (tmp_path / "b.png").read_text() == "old"


def exit_after(saved: SavedRun, outcome: Outcome) -> Result:
    command = click.Command(
        "x", callback=lambda: saved.exit_if_interrupted(outcome)
    )
    return CliRunner().invoke(command, [])


def test_interrupted_game_reports_its_run_folder() -> None:
    assert exit_after(SavedRun(Path("a")), Outcome.COMPLETED).exit_code == 0
    result = exit_after(SavedRun(Path("a")), Outcome.INTERRUPTED)
    assert result.exit_code == 130
    assert result.stderr.endswith("the run so far is saved in a\n")
    result = exit_after(SavedRun(), Outcome.INTERRUPTED)
    assert result.stderr.endswith("nothing is saved without --output\n")


def test_interrupted_campaign_reports_how_to_resume() -> None:
    assert resume_message("3 of 9 duels", Path("out")) == (
        "3 of 9 duels are saved in out; run the same command to continue"
    )
    assert "nothing is saved" in resume_message("3 of 9 duels", None)


def test_reproduce_interrupted_while_drawing_reports_saved_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from stepaside.cli import reproduce_figures

    def interrupt(*_: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("stepaside.studies.claims.ONCE", {})
    monkeypatch.setattr("stepaside.studies.claims.SEEDED", {})
    monkeypatch.setattr(reproduce_figures, "draw_figures", interrupt)
    result = CliRunner().invoke(main, ["reproduce", f"--output={tmp_path}"])
    assert result.exit_code == 130
    assert "all runs and completed figures are saved" in result.stderr


def test_interruption_anywhere_else_is_one_line() -> None:
    group = LazyGroup()
    group.get_command = lambda *_: click.Command(  # type: ignore[method-assign]
        "x", callback=lambda: (_ for _ in ()).throw(KeyboardInterrupt)
    )
    result = CliRunner().invoke(group, ["x"])
    assert result.exit_code == 130
    message = result.stderr.strip()  # without the newline after ^C
    assert "partial output discarded" in message and "\n" not in message


@pytest.mark.parametrize("recorded", [False, True])
def test_a_campaign_interrupted_anywhere_names_its_records(
    recorded: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Before its cases are submitted, for example while workers start."""

    def interrupt(*_: Any, **__: Any) -> None:
        raise KeyboardInterrupt

    file = tmp_path / "games.sqlite"
    if recorded:
        study = Study("games", [1], lambda case: {"case": case}, str)
        run_study(study, file)
    monkeypatch.setattr("stepaside.studies.study.run_study", interrupt)
    words = ["study", "duels", "--output", str(file)]
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 130
    kept = f"finished cases are saved in {file}; run the same command"
    assert (kept in result.stderr) == recorded
    assert ("nothing is saved" in result.stderr) != recorded
