"""Test strategies that are given as Python objects."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from stepaside import (
    Evasion,
    GameSettings,
    Intent,
    Knowledge,
    StartSettings,
    duel,
    load_run,
    load_strategy,
    run_game,
    write_run,
)
from stepaside.cli.main import main
from stepaside.core.errors import ConfigurationError
from stepaside.games.run import Run
from stepaside.planning import Direction
from stepaside.strategies import EvasionMemory

SHORT = duel(duration=1.2, start=StartSettings(distance=0.7))
OWN = """
from stepaside import Direction, Intent
class Own:
    direction = Direction.BACKWARD
    saturated = False
    def begin(self):
        return None
    def decide(self, knowledge, memory):
        return Intent(0.4), None
"""


@dataclass(frozen=True)
class Other(Evasion):
    """An evader of the paper that walks another way."""

    turned: float = 0.7

    def decide(
        self, knowledge: Knowledge, memory: EvasionMemory
    ) -> tuple[Intent, EvasionMemory]:
        """Walk to where nothing is."""
        return Intent(self.turned), memory


class Own:
    """Strategy as a user writes it."""

    direction = Direction.BACKWARD
    saturated = False

    def begin(self) -> None:
        """Nothing to remember."""

    def decide(
        self, knowledge: Knowledge, memory: None
    ) -> tuple[Intent, None]:
        """Walk on a circle."""
        return Intent(0.4), None


def digest_of(run: Run) -> bytes:
    return b"".join(array.tobytes() for array in run.arrays().values())


def played(settings: GameSettings, **strategies: Any) -> bytes:
    return digest_of(run_game(settings, strategies=strategies))


def refusal(*words: str) -> str:
    """Message of a command that must refuse its input."""
    result = CliRunner().invoke(main, list(words))
    assert result.exit_code == 2, result.output
    assert not isinstance(result.exception, ConfigurationError)
    return " ".join(result.output.split())


def test_an_object_plays_as_it_does_from_a_file(tmp_path: Path) -> None:
    file = tmp_path / "own.py"
    file.write_text(OWN)
    by_name = played(SHORT.changed(evader={"strategy": f"{file}:Own"}))
    assert played(SHORT, evader=Own()) == by_name
    assert by_name != played(SHORT)
    loaded = load_strategy(f"{file}:Own")
    assert played(SHORT, evader=loaded) == by_name


def test_a_subclass_is_recorded_as_what_it_is_and_not_repeated(
    tmp_path: Path,
) -> None:
    own = Other(safety_radius=1.1, turned=-0.6)
    run = run_game(SHORT, strategies={"evader": own})
    assert digest_of(run) != played(SHORT)
    assert run.theory is None
    folder = write_run(tmp_path / "run", run, drawn=False).parent
    config = folder / "configuration.toml"
    assert 'strategy = "object Other"' in config.read_text()
    assert load_run(folder).settings == run.settings
    target = tmp_path / "again"
    told = refusal("duel", "--config", str(config), "--output", str(target))
    assert "Python object" in told and "object Other" in told
    assert not target.exists()


@pytest.mark.parametrize("given", [3, Own])
def test_what_is_no_strategy_object_is_refused(given: Any) -> None:
    with pytest.raises(ConfigurationError, match="strategy"):
        run_game(SHORT, strategies={"evader": given})
