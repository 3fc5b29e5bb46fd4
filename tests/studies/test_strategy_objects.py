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
    Pursuit,
    StartSettings,
    load_run,
    load_strategy,
    run_duel,
    write_run,
)
from stepaside.cli.main import main
from stepaside.core.errors import ConfigurationError
from stepaside.games.configuration_file import dump_configuration
from stepaside.games.run_archive import results_of
from stepaside.planning import Direction
from stepaside.strategies import (
    STRATEGIES,
    EvasionMemory,
    LookAhead,
    OptimalEvasion,
)
from stepaside.studies.duel_campaign import duel_study
from stepaside.studies.duel_record import digest_of

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


def played(settings: DuelSettings) -> str:
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
        given = named | {player: STRATEGIES[name](evasion)}
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


def test_a_run_of_names_has_no_notes() -> None:
    assert run_duel(SHORT).summary.notes == []
    file = replace(SHORT, evader_strategy="a.py:B")
    assert file.notes == ()


def test_an_object_in_a_configuration_is_text() -> None:
    settings = replace(SHORT, pursuer_strategy=Own())
    text = dump_configuration(settings)
    assert 'pursuer_strategy = "object ' in text and "Own()" in text
    assert settings.pursuer_strategy is not None
    assert "pursuer_strategy" in settings.notes[0]


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"evader_strategy": Own}, r"Own\(\)"),
        ({"pursuer_strategy": Pursuit}, r"Pursuit\(\)"),
        ({"strategy": Evasion}, r"Evasion\(\)"),
        ({"evader_strategy": 3}, "must be text, or a strategy, got 3"),
        ({"pursuer_strategy": None}, "must be text, or a strategy, got None"),
        ({"strategy": "evasion"}, "must be an Evasion, got 'evasion'"),
        (
            {"strategy": Other(), "evader_strategy": "look-ahead"},
            "must be an Evasion with evader_strategy 'look-ahead'",
        ),
        (
            {
                "strategy": Evasion(angle=1.0),
                "evader_strategy": Evasion(angle=2.0),
            },
            "strategy must be omitted",
        ),
        ({"evader_strategy": "Own"}, "got 'Own'"),
    ],
)
def test_what_contradicts_itself_is_refused(
    values: dict[str, object], words: str
) -> None:
    with pytest.raises(ConfigurationError, match=words):
        replace(SHORT, **values)  # type: ignore[arg-type]


def test_an_object_that_does_not_answer_is_refused() -> None:
    class Mute(Own):
        def decide(self, knowledge: Knowledge, memory: None) -> None:  # type: ignore[override]
            """Say nothing."""

    with pytest.raises(ConfigurationError, match="must return"):
        run_duel(replace(SHORT, evader_strategy=Mute()))  # type: ignore[arg-type]


def test_records_are_kept_of_named_strategies_alone() -> None:
    own = replace(SHORT, evader_strategy=Own())
    with pytest.raises(ConfigurationError, match="a Python object, Own"):
        duel_study(own, [1])


@pytest.mark.parametrize("strategy", ["look-ahead", "stand", "own"])
@pytest.mark.parametrize(
    ("option", "value"),
    [("--safety-radius", "1.2"), ("--angle", "70deg"), ("--saturated", None)],
)
def test_options_that_the_strategy_ignores_are_refused(
    tmp_path: Path, strategy: str, option: str, value: str | None
) -> None:
    (tmp_path / "own.py").write_text(OWN)
    name = f"{tmp_path / 'own.py'}:Own" if strategy == "own" else strategy
    given = [option] if value is None else [option, value]
    told = refusal("duel", "--strategy", name, *given, "--print-config")
    assert option in told and name in told.replace(" ", "")


@pytest.mark.parametrize(
    "given",
    [
        ["--angle", "1.2"],
        ["--strategy", "move-back"],
        ["--law", "saturated"],
        ["--side-rule", "latched"],
        ["--side-hysteresis", "0.1"],
    ],
)
def test_unicycles_refuse_options_that_the_strategy_ignores(
    given: list[str],
) -> None:
    words = ["unicycles", "--duration", "1", "--evader-strategy"]
    told = refusal(*words, "stand", *given)
    assert given[0].replace("side-h", "h") in told
    result = CliRunner().invoke(main, [*words, "evasion", *given])
    assert result.exit_code == 0


def test_options_that_the_strategy_uses_are_taken() -> None:
    words = ["duel", "--strategy", "evasion", "--safety-radius", "1.2"]
    result = CliRunner().invoke(main, [*words, "--print-config"])
    assert result.exit_code == 0 and "safety_radius = 1.2" in result.output


@pytest.mark.parametrize(
    "own", [LookAhead(), OptimalEvasion(), "stand", Own()]
)
def test_values_that_the_strategy_ignores_are_reported(own: object) -> None:
    aside = Evasion(safety_radius=1.2, angle=1.0)
    settings = replace(SHORT, strategy=aside, evader_strategy=own)  # type: ignore[arg-type]
    told = settings.notes[-1]
    assert "strategy.angle, strategy.safety_radius" in told
    assert not replace(SHORT, evader_strategy="stand").notes
