"""Count the outcomes of fuzzing by class, and store them by seed."""

import json
from pathlib import Path

import pytest

from tools.fuzz import counts as fuzz_counts
from tools.fuzz.counts import COLUMNS, Counts, keep


def counted(*cases: tuple[str, str]) -> Counts:
    counts = Counts()
    for kind, complaint in cases:
        counts.add(kind, complaint)
    return counts


def test_each_failure_is_counted_in_its_column() -> None:
    counts = counted(
        *(("a", "traceback: KeyError at x"), ("a", "hang"), ("b", "")),
        *(("b", "hang: no word in 3 s"), ("b", "accepted nonsense: 1")),
        *(("a", "leftovers: x"), ("a", "lost: file"), ("a", "status 7: ")),
    )
    total = counts.total()
    assert [total[c] for c in COLUMNS] == [8, 1, 2, 1, 1, 2]
    assert counts.wrong == 7
    assert counts.lines()[-1].split() == ["all", "8", "tried", "7", "wrong"]
    assert counts.lines()[1].split() == ["b", "3", "tried", "2", "wrong"]


def test_counts_of_a_seed_replace_former_ones(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fuzz_counts, "all_modules", lambda: ("core/errors",))
    file = tmp_path / "fuzz.json"
    for seed, cases in (
        (2, [("a", "hang"), ("b", "")]),
        (1, [("a", "")]),
        (2, [("a", ""), ("a", ""), ("c", "")]),
    ):
        keep(file, counted(*cases), seed, ["calls"], 0.5)
    plain = json.loads(file.read_text())
    assert plain["settings"]["seeds"] == [1, 2]
    assert [run["seed"] for run in plain["runs"]] == [1, 2]
    assert {k: row["tried"] for k, row in plain["classes"].items()} == {
        "a": 3,
        "c": 1,
    }
    assert plain["total"] == {c: 4 * (c == "tried") for c in COLUMNS}
