"""Test strategies that are given as Python objects."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from stepaside import (
    DuelSettings,
    Evasion,
    Intent,
    Knowledge,
    StartSettings,
    load_run,
    load_strategy,
    run_duel,
    write_run,
)
from stepaside.cli.main import main
from stepaside.core.errors import ConfigurationError
from stepaside.games.run import Run
from stepaside.games.run_archive import results_of
from stepaside.planning import Direction
from stepaside.strategies import (
    STRATEGIES,
    EvasionMemory,
)

SHORT = DuelSettings(duration=1.2, start=StartSettings(distance=0.7))
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


def played(settings: DuelSettings) -> bytes:
    return digest_of(run_duel(settings))


def refusal(*words: str) -> str:
    """Message of a command that must refuse its input."""
    result = CliRunner().invoke(main, list(words))
    assert result.exit_code == 2, result.output
    assert not isinstance(result.exception, ConfigurationError)
    return " ".join(result.output.split())


@pytest.mark.parametrize("name", STRATEGIES)
def test_an_object_of_the_registry_is_recorded_by_its_name(name: str) -> None:
    evasion = Evasion(angle=1.2)
    for player in ("evader_strategy", "pursuer_strategy"):
        named: dict[str, Any] = {"strategy": evasion, player: name}
        given = named | {player: load_strategy(name, evasion)}
        assert replace(SHORT, **given) == replace(SHORT, **named)


def test_an_evasion_is_recorded_with_its_values() -> None:
    own = Evasion(safety_radius=1.1)
    given = replace(SHORT, evader_strategy=own)
    assert given.resolved() == replace(SHORT, strategy=own).resolved()


def test_an_object_plays_as_it_does_from_a_file(tmp_path: Path) -> None:
    file = tmp_path / "own.py"
    file.write_text(OWN)
    by_name = played(replace(SHORT, evader_strategy=f"{file}:Own"))
    assert played(replace(SHORT, evader_strategy=Own())) == by_name
    assert by_name != played(SHORT)
    loaded = load_strategy(f"{file}:Own")
    assert played(replace(SHORT, evader_strategy=loaded)) == by_name


def test_a_subclass_is_recorded_as_what_it_is_and_not_repeated(
    tmp_path: Path,
) -> None:
    settings = replace(SHORT, strategy=Other(safety_radius=1.1, turned=-0.6))
    run = run_duel(settings)
    assert digest_of(run) != played(
        replace(SHORT, strategy=Evasion(safety_radius=1.1))
    )
    assert run.theory is None
    folder = write_run(tmp_path / "run", run, drawn=False).parent
    text = (folder / "configuration.toml").read_text()
    assert "object " in text and "Other(" in text and "turned=-0.6" in text
    loaded = load_run(folder)
    (note,) = results_of(loaded)["notes"]
    assert "does not repeat" in note and "Other(" in note
    config = str(folder / "configuration.toml")
    target = tmp_path / "again"
    told = refusal("duel", "--config", config, "--output", str(target))
    assert "Python object" in told and "Other(" in told
    assert not target.exists()
