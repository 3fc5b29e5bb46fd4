"""Test shards, merging and tables of campaigns by their commands."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from stepaside.cli.main import main
from stepaside.strategies.table_cache import pursuit_bound
from stepaside.studies import tournament_record

STUDY = """
game = "tournament"
settings.game.duration = 3.0
[grid]
evader = ["aside", "look-ahead"]
seed = "0:3"
"""


@pytest.fixture(scope="module", autouse=True)
def coarse_table(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """The bound is solved on few cells."""
    patch = pytest.MonkeyPatch()
    patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
    patch.setattr(tournament_record, "CELLS", 16)
    pursuit_bound.cache_clear()
    yield
    patch.undo()
    pursuit_bound.cache_clear()


def call(*words: str | Path) -> Result:
    return CliRunner().invoke(main, [str(word) for word in words])


@pytest.fixture
def study(tmp_path: Path) -> Path:
    file = tmp_path / "study.toml"
    file.write_text(STUDY)
    return file


def rows_of(answer: Result) -> Any:
    assert answer.exit_code == 0, answer.output
    return json.loads(answer.stdout)["rows"]


def test_shards_merged_give_the_table_of_the_whole(
    tmp_path: Path, study: Path
) -> None:
    whole = rows_of(call("study", study, "--workers", "1", "--json"))
    for number in (1, 2, 3):
        shard = ("--shard", f"{number}/3", "--output", tmp_path / f"{number}")
        answer = call("study", study, *shard, "--workers", "1")
        assert answer.exit_code == 0, answer.output
        assert not (tmp_path / f"{number}" / "summary.json").exists()
    parts = [tmp_path / str(number) for number in (1, 2, 3)]
    output = tmp_path / "all"
    merged = call("merge", *parts, "--output", output)
    assert merged.exit_code == 0 and "6 records" in merged.output
    again = call("study", study, "--output", output, "--json")
    assert (
        rows_of(again)
        == json.loads((output / "summary.json").read_text())["rows"]
    )
    for row, wanted in zip(rows_of(again), whole, strict=True):
        assert row["outcomes"] == wanted["outcomes"]
        mean = row["closest_m"]["mean"]
        assert mean == pytest.approx(wanted["closest_m"]["mean"], rel=1e-5)
    assert json.loads(again.stdout)["done"] == 6


@pytest.mark.parametrize("bad", ["0/4", "5/4", "1", "a/b", "1/0", "-1/4"])
def test_an_invalid_shard_is_refused(study: Path, bad: str) -> None:
    answer = call("study", study, f"--shard={bad}")
    assert answer.exit_code == 2 and "I/N" in answer.output


def test_merging_a_folder_without_records_is_refused(tmp_path: Path) -> None:
    answer = call("merge", tmp_path, "--output", tmp_path / "all")
    assert answer.exit_code == 2 and "no records" in answer.output
    assert not (tmp_path / "all").exists()


@pytest.mark.parametrize(
    "bad", ["", "nothing", "processes:3", "dask:", "no.such:module"]
)
def test_an_unknown_executor_is_refused(study: Path, bad: str) -> None:
    answer = call("study", study, f"--executor={bad}")
    assert answer.exit_code == 2 and "executor must be" in answer.output
