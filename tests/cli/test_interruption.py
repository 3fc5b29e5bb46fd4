"""An interrupted command reports what is saved."""

from pathlib import Path
from signal import SIGINT
from typing import Any

import click
import pytest
from click.testing import CliRunner

from expected.asking import command, own_evader
from stepaside.cli.main import LazyGroup, main
from stepaside.cli.terminal import resume_message


def test_interrupted_campaign_reports_how_to_resume() -> None:
    assert resume_message("3 of 9 duels", Path("out")) == (
        "3 of 9 duels are saved in out; run the same command to continue"
    )
    assert "nothing is saved" in resume_message("3 of 9 duels", None)


def test_reproduce_interrupted_while_drawing_reports_saved_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(*_: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("stepaside.studies.claims.ONCE", {})
    monkeypatch.setattr("stepaside.studies.claims.SEEDED", {})
    monkeypatch.setattr("stepaside.cli.reproduce.draw_figures", interrupt)
    result = CliRunner().invoke(main, ["reproduce", f"--output={tmp_path}"])
    assert result.exit_code == 130
    assert "all runs and completed figures are saved" in result.stderr


@pytest.mark.usefixtures("inline_workers")
def test_an_interrupted_study_draws_no_figure(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    own = own_evader(tmp_path / "own.py", number=SIGINT)
    words = f"study duels --set level=steps --set evader={own} --set seed=0:2 "
    words += "--set duration=2 --output a.sqlite --figure a.png --workers 1"
    done = command(*words.split())
    assert done.exit_code == 130 and not Path("a.png").exists()
    assert "0 of 2 games are saved in a.sqlite; run the same" in done.stderr


def test_interruption_anywhere_else_is_one_line() -> None:
    group = LazyGroup(lazy={})
    group.get_command = lambda *_: click.Command(  # type: ignore[method-assign]
        "x", callback=lambda: (_ for _ in ()).throw(KeyboardInterrupt)
    )
    result = CliRunner().invoke(group, ["x"])
    assert result.exit_code == 130
    message = result.stderr.strip()  # without the newline after ^C
    assert "half-written files are" in message and "\n" not in message
