"""Test the study of claims: verdicts, stored readings, command, page."""

import json
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from math import degrees, pi, sqrt
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from click.testing import CliRunner

from stepaside.cli.main import main
from stepaside.core import worker_pool as workers
from stepaside.games.player_settings import LEGS_GAIT
from stepaside.studies import claims as studied
from stepaside.studies import game_claims
from stepaside.studies.claims import (
    LEGS,
    ONCE,
    SEEDED,
    Claim,
    Readings,
    claim_rows,
    claim_study,
    load_claims,
)
from stepaside.studies.results_version import RESULTS
from stepaside.studies.study import run_study

COMMAND = "stepaside.cli.reproduce"
NAN, INF = float("nan"), float("inf")
IT = Claim("it is one", "I", "paper", 1.0, "m", 0.1)


@pytest.mark.parametrize(
    ("relation", "values", "holds"),
    [
        ("=", (1.05,), True),
        ("=", (1.15,), False),
        ("=", (0.85,), False),
        ("=", (-5.0,), False),
        ("=", (1.15, 0.95), True),  # the mean is within the tolerance
        ("=", (1.25, 0.75), False),  # single runs are too far off
        ("=", (0.75, 1.19), False),
        ("=", (1.12, 1.12), False),
        ("<", (0.9, 0.99), True),
        ("<", (0.5, 1.01), False),
        ("<", (1.0,), False),
        (">", (1.1, 9.0), True),
        (">", (9.0, 0.99), False),
        ("=", (1.0, NAN), False),
        ("<", (0.0, -INF), False),
        ("=", (), False),
    ],
)
def test_verdict(
    relation: Any, values: tuple[float, ...], holds: bool
) -> None:
    claim = replace(IT, relation=relation)
    assert claim.holds(values) is holds
    row = claim.row("a.it", values)
    assert row["verdict"] == ("holds" if holds else "fails")


# --- the table --------------------------------------------------------------

SPEED, GAIN, STRIDE = 0.1, 0.2, 0.04  # of Sec. IV, in [m/s], [1/s], [m]
STEP = 0.425 + 0.122  # of the supports, in [s]
RADIUS = 4.0 * SPEED / (pi * GAIN)
LEGS_RADIUS = 4.0 * LEGS_GAIT["speed"] / (pi * LEGS_GAIT["gain"])
EXPECTED = {
    "circle.pursuer_radius": 4.0 / (pi * 0.5),
    "circle.evader_radius": 4.0 / (pi * 0.5),
    "circle.distance": sqrt(2.0) * 4.0 / (pi * 0.5),
    "circle.orientation": pi / 2,
    "saturated.radius": 1.0 / 0.5,
    "saturated.namely": pi - 2.0,
    "strategies.unbounded": 2.0 / 0.5,
    "sampled.radius": RADIUS,
    "sampled.distance": sqrt(2.0) * RADIUS,
    "path.way": SPEED / GAIN,
    "footsteps.stepsize": STRIDE,
    "com.reached": degrees(0.9),
    "humanoids.pursuer_radius": RADIUS,
    "humanoids.evader_radius": RADIUS,
    "humanoids.distance": sqrt(2.0) * RADIUS,
    "humanoids.landings": STEP,
    "humanoids.at_its_end": 0.5 * 0.122,
    "durations.distance": STRIDE / STEP * (30.0 - 0.8),
    "durations.speed": STRIDE / STEP,
    "learned-legs.pursuer_radius": LEGS_RADIUS,
    "learned-legs.evader_radius": LEGS_RADIUS,
    "learned-legs.distance": sqrt(2.0) * LEGS_RADIUS,
}


@pytest.mark.parametrize("name", EXPECTED)
def test_expected_values_follow_from_the_numbers_of_the_paper(
    name: str,
) -> None:
    job, key = name.split(".")
    claim = load_claims()[job][key]
    assert claim.expected == pytest.approx(EXPECTED[name], rel=1e-12)


def test_every_job_has_its_claims() -> None:
    claims = load_claims()
    assert [*ONCE, *SEEDED, "learned-legs"] == list(claims)
    assert sum(len(claims[job]) for job in (*ONCE, *SEEDED)) == 61


# --- stored readings ---------------------------------------------------------


class Bench:
    """Two jobs that record their measurements."""

    def __init__(self) -> None:
        self.measured: list[tuple[str, int]] = []
        self.stop_at: int | None = None
        self.value = 1.0

    def once(self) -> Readings:
        """Measure the job without a seed."""
        return self.seeded(0, "once")

    def seeded(self, seed: int, name: str = "seeded") -> Readings:
        """Note a measurement."""
        if seed == self.stop_at:
            raise KeyboardInterrupt
        self.measured.append((name, seed))
        return {"it": self.value + 0.01 * seed}


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Bench:
    bench = Bench()
    monkeypatch.setattr(studied, "ONCE", {"once": bench.once})
    monkeypatch.setattr(studied, "SEEDED", {"seeded": bench.seeded})
    table = {"once": {"it": IT}, "seeded": {"it": IT}}
    monkeypatch.setattr(studied, "load_claims", lambda: table)
    return bench


@pytest.fixture
def only_paths(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(studied, "ONCE", {"path": ONCE["path"]})
    monkeypatch.setattr(studied, "SEEDED", {})


def rows_of(file: Path | None, *seeds: int) -> list[Any]:
    return claim_rows(run_study(claim_study(seeds), file))


def again(bench: Bench, folder: Path, *seeds: int) -> list[tuple[str, int]]:
    """Run the study on a folder; return what it measured."""
    bench.measured.clear()
    run_study(claim_study(seeds), folder / "kept.sqlite")
    return sorted(bench.measured)


def test_interrupted_study_keeps_finished_readings(
    bench: Bench, tmp_path: Path
) -> None:
    bench.stop_at = 2
    assert again(bench, tmp_path, 1, 2, 3) == [("once", 0), ("seeded", 1)]
    bench.stop_at = None
    assert again(bench, tmp_path, 1, 2, 3) == [("seeded", 2), ("seeded", 3)]


def test_missing_reading_stays_missing_and_fails(
    bench: Bench, tmp_path: Path
) -> None:
    bench.value = NAN
    for _ in range(2):
        (row,) = rows_of(tmp_path / "kept.sqlite")
        assert (row["verdict"], row["measured"]) == ("fails", None)


# --- page and command -----------------------------------------------------

Call = Callable[..., Any]


@pytest.fixture
def reproduce(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Call:
    monkeypatch.setattr(workers, "worker_pool", ThreadPoolExecutor)
    monkeypatch.setattr(f"{COMMAND}.draw_figures", lambda *_: [])

    def call(*words: str) -> Any:
        line = ["reproduce", "--workers", "1", "--output", str(tmp_path)]
        return CliRunner().invoke(main, [*line, *words])

    return call


@pytest.mark.usefixtures("only_paths")
def test_command_prints_rows_and_writes_the_page(
    tmp_path: Path, reproduce: Call
) -> None:
    result = reproduce("--json")
    assert result.exit_code == 0, result.stderr
    rows = json.loads(result.stdout)["rows"]
    assert len(rows) == len(load_claims()["path"])
    for row in rows:
        assert row["measured"] is not None
        assert (row["runs"], row["spread"]) == (1, 0.0)
        assert row["verdict"] == "holds"
    stored = json.loads((tmp_path / "claims.json").read_text())
    assert stored["rows"] == rows
    assert (stored["seed"], stored["runs"]) == (1, 10)
    assert stored["results"] == RESULTS
    page = (tmp_path / "claims.md").read_text()
    lines = page.split("\n\n## ")[0].splitlines()
    table = [line for line in lines if line.startswith("|")]
    assert len(table) == len(rows) + 2
    assert {line.replace("\\|", "").count("|") for line in table} == {7}
    assert "\\|theta\\*\\|" in page
    assert f"{len(rows)} of {len(rows)} hold" in reproduce().stdout


@pytest.mark.parametrize(
    ("value", "status"), [(1.0, 0), (NAN, 1)], ids=["holds", "fails"]
)
def test_exit_status_is_0_if_every_claim_holds_else_1(
    bench: Bench, tmp_path: Path, reproduce: Call, value: float, status: int
) -> None:
    bench.value = value
    result = reproduce("--runs", "1")
    assert result.exit_code == status, result.output
    assert f"{2 - 2 * status} of 2 hold" in result.stdout
    assert (tmp_path / "claims.md").exists()


def test_without_runs_only_what_needs_one_is_measured(
    bench: Bench, reproduce: Call
) -> None:
    said = reproduce("--runs", "0").stdout
    for words in ("1 of 1 hold", "skipped the claims", "skipped the paper's"):
        assert words in said
    assert bench.measured == [("once", 0)]


def test_interrupt_ends_with_status_130(
    bench: Bench, tmp_path: Path, reproduce: Call
) -> None:
    bench.stop_at = 1
    done = reproduce()
    assert done.exit_code == 130 and "1 of 11 runs are saved" in done.stderr
    assert not (tmp_path / "claims.json").exists()


def test_only_the_trial_of_legs_has_their_robot(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    network = tmp_path / "walk.onnx"
    network.write_bytes(b"network")
    legs = SimpleNamespace(network=str(network))
    settings = SimpleNamespace(evader=SimpleNamespace(legs=legs))
    monkeypatch.setattr(game_claims, "legs_settings", lambda *_: settings)
    study = claim_study([3], "robot")
    trials = study.cases
    keys = {study.key_of(trial) for trial in trials}
    network.write_bytes(b"another")
    again = claim_study([3], "robot")
    assert len(keys - {again.key_of(trial) for trial in trials}) == 1
    assert [trial.job for trial in trials if trial.legs] == [LEGS]
