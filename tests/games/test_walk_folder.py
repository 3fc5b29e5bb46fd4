"""Test walks as runs: stored, drawn, replayed and compared."""

from math import pi
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from stepaside.cli.main import main
from stepaside.games.game_settings import duel as make_duel
from stepaside.games.game_settings import walk
from stepaside.games.outcome import Outcome
from stepaside.games.recorded_game import run_game
from stepaside.games.run import Run
from stepaside.games.run_archive import write_run_files
from stepaside.report.run_folder import write_run
from stepaside.sim.push import Push

PUSHES = (Push(0.5, 1.0, pi / 2), Push(0.4, 1.1, 0.0))


@pytest.fixture(scope="module")
def walked() -> Run:
    settings = walk(duration=1.5, bearing=0.3, pushes=PUSHES)
    run = run_game(settings)
    assert run.outcome is Outcome.COMPLETED
    return run


@pytest.fixture(scope="module")
def folder(walked: Run, tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("walks") / "walk"
    assert write_run(place, walked) == place / "walk.png"
    return place


def test_a_walk_is_compared_with_walks_alone(
    folder: Path, tmp_path: Path
) -> None:
    figure = tmp_path / "c.png"

    def compare(other: Path) -> Result:
        words = ["show", str(folder), str(other), "-o", str(figure)]
        return CliRunner().invoke(main, words)

    duel = tmp_path / "duel"
    duel.mkdir()
    write_run_files(duel, run_game(make_duel(duration=0.04)))
    mixed = compare(duel)
    assert mixed.exit_code == 2 and mixed.output.count("\n") == 1
    assert "must be of the same game, got duel and walk" in mixed.output
    assert not figure.exists()
    assert "speed" in compare(folder).stdout and figure.exists()
