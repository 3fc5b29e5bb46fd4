"""Long work is announced before it begins; endless work is refused."""

import re
from pathlib import Path

import click
import pytest
from click.testing import CliRunner, Result

from stepaside.cli.main import main
from stepaside.cli.progress import (
    ANNOUNCED,
    LONGEST,
    announce_effort,
    duration_text,
)
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.recorded_game import run_duel
from stepaside.report.run_folder import write_run

pytestmark = pytest.mark.usefixtures("blank_figures")


class Reached(Exception):
    """Work would begin here."""


@click.command()
@click.argument("seconds", type=float)
@click.argument("workers", type=int)
def work(seconds: float, workers: int) -> None:
    """Announce work of some length."""
    announce_effort("work", seconds, workers)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> str:
    folder = tmp_path_factory.mktemp("effort") / "run"
    write_run(folder, run_duel(DuelSettings(duration=0.2)))
    return str(folder)


def announce(seconds: float, workers: int = 1) -> Result:
    return CliRunner().invoke(work, [str(seconds), str(workers)])


def test_only_long_work_is_announced_and_endless_work_is_refused() -> None:
    assert announce(ANNOUNCED).output == ""
    assert announce(ANNOUNCED + 1).stderr == (
        "stepaside: work, about 1 minutes; press Ctrl-C to stop\n"
    )
    assert announce(LONGEST).exit_code == 0
    refused = announce(LONGEST * 1.01)
    assert refused.exit_code == 2 and "30 days" in refused.stderr


def test_workers_divide_the_time() -> None:
    assert announce(3 * ANNOUNCED, 4).output == ""
    assert "45 minutes" in announce(45 * 60 * 4, 4).stderr


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (61, "1 minutes"),
        (5400, "90 minutes"),
        (7200, "2 hours"),
        (172800, "2 days"),
        (1e9, "1.2e+04 days"),
    ],
)
def test_durations_have_the_largest_fitting_unit(
    seconds: float, text: str
) -> None:
    assert duration_text(seconds) == text


def test_reproduce_announces_its_size(
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
) -> None:
    def begin(*_: object) -> None:
        raise Reached

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("stepaside.core.worker_pool.worker_pool", begin)
    with pytest.raises(Reached):
        main(["reproduce", "--workers", "2"])
    assert "every claim of the paper" in capsys.readouterr().err


@pytest.mark.parametrize(
    "words",
    [
        "map --grid 400 --distances 400 --duration 1e4 --step 1e-4",
        "circle --starts 1000000 --evader-gain 1e6",
        "unicycles --sample-time 1e-9 --duration 1e6 --delay 1e6",
        "unicycles --duration 1e9 --evader-gain 1e3",
        "unicycles --duration 1e9 --evader-strategy look-ahead",
        "show RUN -o film.mp4 --rate 1e9",
        "show RUN -o film.gif --speed 1e-9",
    ],
)
def test_endless_work_is_refused(
    words: str, run: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = CliRunner().invoke(main, words.replace("RUN", run).split())
    assert not list(tmp_path.iterdir())
    assert result.exit_code == 2 and result.output.count("\n") == 1
    refusals = "would take about|must be at most|must lie in"
    assert re.search(refusals, result.output)


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        ("bound --grid 200", "a table of"),
        ("circle --starts 1000000", "1000000 games"),
        ("unicycles --duration 3e5", "a game of 300000 s"),
        ("unicycles --sample-time .01 --duration 3e4", "a game of 30000 s"),
        ("show RUN -o film.mp4 --speed 1e-4", "a video of about"),
    ],
)
def test_long_work_is_announced_before_it_begins(
    words: str, wanted: str, run: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first message ends the command."""

    def end(*_: object, err: bool = False) -> None:
        raise Reached(_[0])

    monkeypatch.setattr("stepaside.cli.progress.echo", end)
    with pytest.raises(Reached, match=wanted):
        main(words.replace("RUN", run).split())
