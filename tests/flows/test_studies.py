"""A study is the same however it is run, and its numbers are those of games.

Its games are duels; a strategy counts how many are played.
"""

import signal
import sqlite3
from collections.abc import Iterator
from math import sqrt
from pathlib import Path
from statistics import mean, stdev
from typing import Any

import pytest
from scipy.special import stdtrit

import stepaside as sa
from flows import calls
from flows.own_strategies import FILE
from flows.running import until

SEEDS, DURATION, EVADER = range(8), 0.6, f"{FILE}:Counted"
STUDY = f"""
game = "duel"
[settings]
duration = {DURATION}
evader.strategy = "{EVADER}"
[grid]
seed = "0:{len(SEEDS)}"
"""


class Games:
    """The study, and how many games were begun since one asked last."""

    def __init__(self, folder: Path) -> None:
        self.file, self.log = folder / "study.toml", folder / "games.txt"
        self.file.write_text(STUDY)
        self.log.touch()

    def begun(self) -> int:
        """Return that number, and begin to count anew."""
        number = len(self.log.read_text().splitlines())
        self.log.write_text("")
        return number


@pytest.fixture(scope="module")
def games(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Games]:
    made = Games(tmp_path_factory.mktemp("study"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("GAMES_BEGUN", str(made.log))
        yield made


@pytest.fixture(scope="module")
def undisturbed(
    games: Games, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Any]:
    """The study in one go; with the number of begun games."""
    output = tmp_path_factory.mktemp("whole") / "whole"
    games.begun()
    found: dict[str, Any] = calls.study(games.file, output).json
    return found | {"begun": games.begun(), "table": calls.table_in(output)}


@pytest.fixture(scope="module")
def closest(games: Games) -> list[float | None]:
    """Closest approach of each duel, played alone."""
    return [
        sa.run_game(
            sa.duel(seed=seed, duration=DURATION, evader={"strategy": EVADER})
        ).summary.min_distance_m
        for seed in SEEDS
    ]


def test_a_study_tells_what_its_duels_do(
    undisturbed: dict[str, Any], closest: list[float]
) -> None:
    assert undisturbed["planned"] == undisturbed["done"] == len(SEEDS)
    (row,) = undisturbed["rows"]
    assert row["number"] == len(SEEDS)
    assert list(row["outcome"]) == ["completed"]
    assert row["outcome"]["completed"]["count"] == len(SEEDS)
    told = row["min_distance_m"]
    assert told["mean"] == pytest.approx(mean(closest), abs=1e-5)
    assert told["min"] == pytest.approx(min(closest), abs=1e-5)
    assert told["max"] == pytest.approx(max(closest), abs=1e-5)


def test_the_interval_of_a_mean_is_that_of_so_many_cases(
    undisturbed: dict[str, Any], closest: list[float]
) -> None:
    """By Student's t."""
    count = len(SEEDS)
    half = stdtrit(count - 1, 0.975) * stdev(closest) / sqrt(count)
    told = undisturbed["rows"][0]["min_distance_m"]["half"]
    assert told == pytest.approx(half, rel=1e-4)


def test_a_table_has_a_row_for_each_duel(
    undisturbed: dict[str, Any], closest: list[float]
) -> None:
    with sqlite3.connect(undisturbed["table"]) as table:
        rows = table.execute(
            "select seed, outcome, min_distance_m from results"
        ).fetchall()
    assert [row[:2] for row in rows] == [(n, "completed") for n in SEEDS]
    assert [row[2] for row in rows] == pytest.approx(closest)


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGINT])
def test_a_study_that_was_ended_goes_on_where_it_was(
    number: signal.Signals,
    games: Games,
    undisturbed: dict[str, Any],
    tmp_path: Path,
) -> None:
    """When it was killed, and by Ctrl-C."""
    output = tmp_path / "ended"
    process = calls.start_study(games.file, output, GAMES_PAUSE="0.4")
    until(lambda: calls.records_in(output) > 0)
    process.send_signal(number)
    _, said = process.communicate()
    if number == signal.SIGKILL:
        assert process.returncode == -number
    else:
        assert process.returncode == 130
        assert "run the same command to continue" in said
    assert_goes_on(output, games, undisturbed)


def assert_goes_on(
    output: Path, games: Games, undisturbed: dict[str, Any]
) -> None:
    """Run the rest; what was done is not done again."""
    assert 0 < calls.records_in(output) < len(SEEDS)
    games.begun()
    again = calls.study(games.file, output).json
    assert again["rows"] == undisturbed["rows"]
    assert again["done"] == len(SEEDS)
    alone = undisturbed["begun"] / len(SEEDS)
    assert 0 < games.begun() <= undisturbed["begun"] - alone


def test_a_study_goes_on_after_the_disk_was_full(
    games: Games, undisturbed: dict[str, Any], tmp_path: Path
) -> None:
    """Its file of records cannot grow to the last page."""
    size = undisturbed["table"].stat().st_size
    output = tmp_path / "full"
    said = calls.study(
        games.file, output, status=2, largest_file=size - 4096
    ).err
    assert "could not be written" in said
    assert said.count("\n") == 1
    assert "Traceback" not in said
    assert_goes_on(output, games, undisturbed)


def test_shards_joined_are_the_study(
    games: Games, undisturbed: dict[str, Any], tmp_path: Path
) -> None:
    parts = [tmp_path / "first", tmp_path / "second"]
    games.begun()
    for number, part in enumerate(parts, start=1):
        found = calls.study(games.file, part, "--shard", f"{number}/2").json
        assert found["done"] == len(SEEDS) / 2
        assert games.begun() == undisturbed["begun"] / 2
    whole = calls.merge(games.file, tmp_path / "all", *parts).json
    assert whole["rows"] == undisturbed["rows"]
    assert games.begun() == 0  # all of them were there


def test_dask_gives_the_same_study(
    games: Games, undisturbed: dict[str, Any], tmp_path: Path
) -> None:
    pytest.importorskip("distributed")
    games.begun()
    output = tmp_path / "dask"
    found = calls.study(games.file, output, "--executor", "dask").json
    assert found["rows"] == undisturbed["rows"]
    assert games.begun() == undisturbed["begun"]


def test_a_study_in_python_is_a_data_frame(
    games: Games, closest: list[float]
) -> None:
    pytest.importorskip("polars")
    settings = {"duration": DURATION, "evader.strategy": EVADER}
    frame = calls.frame_of_duels(settings, SEEDS)
    assert frame["seed"].to_list() == list(SEEDS)
    assert frame["min_distance_m"].to_list() == pytest.approx(closest)
