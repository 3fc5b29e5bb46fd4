"""The command ``stepaside robustness``, without a single walk."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from stepaside.cli import main
from stepaside.commands import robustness as command
from stepaside.studies.limits import next_strength, outcomes_of
from stepaside.studies.survival import bound_at


def survive_a_newton_second(
    grid: list[Any], cases: list[Any], *_: Any
) -> tuple[dict[str, bool], bool]:
    """Every push up to 1 N s is survived, and every other disturbance."""
    results = {trial.key: True for trial in grid}
    for case, outcomes in outcomes_of(cases, {}).items():
        while (strength := next_strength(outcomes)) is not None:
            outcomes[strength] = strength <= 1.0
            key = replace(case, strength=strength).key
            results[key] = outcomes[strength]
    return results, False


@pytest.fixture(autouse=True)
def no_walks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(command, "_run", survive_a_newton_second)


def run(*arguments: str) -> str:
    result = CliRunner().invoke(main, ["robustness", *arguments])
    assert result.exit_code == 0, result.output
    return result.stdout


def test_pushes_are_printed_over_their_bound(tmp_path: Path) -> None:
    asked = ("--kind", "push", "--method", "mpc", "--phases", "2")
    printed = run(*asked, "--output", str(tmp_path))
    cells = " ".join(f"1.0/{bound_at('left', x):.1f}" for x in (0.0, 0.5))
    assert f"left      {cells}" in printed
    assert "0 of 8" in printed
    made = json.loads((tmp_path / "pushes.json").read_text())
    assert len(made["rows"]) == 8 and made["summary"]["mpc"]["cases"] == 8
    assert {row["limit_n_s"] for row in made["rows"]} == {1.0}
    for name in ("limits.png", "survival.png"):
        assert (tmp_path / name).read_bytes()[:4] == b"\x89PNG"


def test_other_kinds_are_counted_over_their_seeds() -> None:
    answer = json.loads(
        run(*("--kind", "play", "--method", "mpc", "--seeds", "3", "--json"))
    )
    assert answer["limits"] == [] and answer["push_cases"] == 0
    assert {row["trials"] for row in answer["survival"]} == {3}
    assert answer["trials"] == answer["planned"] == 15
