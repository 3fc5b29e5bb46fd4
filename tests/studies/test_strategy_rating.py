"""Test the rating of strategies."""

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from stepaside.cli.main import main
from stepaside.studies.strategy_rating import (
    OPPONENTS,
    WORLDS,
    rating_rows,
    score_rows,
)

ASIDE = "evasion(safety_radius=100)"


def record(closest: float, **changes: Any) -> dict[str, Any]:
    return {
        "strategy": ASIDE,
        "role": "evader",
        "world": "open floor",
        "opponent": "pursuit",
        "outcome": "survived",
        "closest_m": closest,
        "bound_m": 1.0,
    } | changes


def test_regret_is_the_bound_less_the_closest_approach() -> None:
    touched = record(0.9, outcome="touched")
    (row,) = rating_rows([record(0.5), record(0.7), touched])
    assert row["games"] == 3 and row["survived"] == pytest.approx(2 / 3)
    assert row["mean_closest_m"] == pytest.approx(0.4)
    assert row["mean_regret_m"] == pytest.approx(0.6)
    assert row["mean_ratio"] == pytest.approx(0.4)
    assert row["mean_regret_pm_m"] > 0.0


def test_the_bound_holds_against_the_papers_pursuer_only() -> None:
    (row,) = rating_rows([record(0.5, opponent="sharp")])
    assert row["mean_regret_m"] is None and row["mean_ratio"] is None


def test_scores_put_the_best_of_each_role_first() -> None:
    records = [
        record(0.5),
        record(0.8, strategy="optimal"),
        record(0.6, strategy="lead", role="pursuer", opponent=ASIDE),
        record(0.4, strategy="sharp", role="pursuer", opponent=ASIDE),
    ]
    scores = score_rows(rating_rows(records))
    order = ["optimal", ASIDE, "sharp", "lead"]
    assert [row["strategy"] for row in scores] == order
    assert scores[2]["score_m"] == pytest.approx(-0.4)
    assert scores[2]["mean_regret_m"] is None


def test_the_command_writes_a_card_and_a_figure(tmp_path: Path) -> None:
    card, figure = tmp_path / "card.json", tmp_path / "card.png"
    words = ["rate", ASIDE, "--games", "1", "--duration", "4", "--json"]
    words += ["--output", str(card), "--figure", str(figure)]
    done = CliRunner().invoke(main, words)
    assert done.exit_code == 0, done.stderr
    result = json.loads(card.read_text(encoding="utf-8"))
    assert len(result["rows"]) == len(WORLDS) * len(OPPONENTS["evader"])
    assert result["scores"][0]["strategy"] == ASIDE
    assert result["settings"] == {"games": 1, "duration_s": 4.0}
    assert figure.stat().st_size > 1000
    assert json.loads(done.stdout)["output"] == str(card)
