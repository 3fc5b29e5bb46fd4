"""Test that measuring commands know first where their results go."""

import os
from argparse import ArgumentParser
from pathlib import Path

import benchmark_options
import pytest
from benchmark_options import ask


def asked(*words: str, name: str = "walls.json") -> Path:
    output: Path = ask("Measure walls.", name).parse_args(words).output
    return output


def kinds() -> ArgumentParser:
    parser = ask("Measure kinds.", lambda given: f"wall-{given.kind}.json")
    parser.add_argument("kind")
    return parser


def refused(
    capsys: pytest.CaptureFixture[str], *words: str | os.PathLike[str]
) -> str:
    with pytest.raises(SystemExit) as ended:
        asked(*map(str, words))
    assert ended.value.code == 2
    return capsys.readouterr().err


def test_results_go_among_the_others_by_default(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(benchmark_options, "RESULTS", tmp_path)
    assert asked() == tmp_path / "walls.json"
    assert kinds().parse_args(["low"]).output == tmp_path / "wall-low.json"


def test_a_folder_means_the_usual_name_in_it(tmp_path: Path) -> None:
    assert asked("--output", str(tmp_path)) == tmp_path / "walls.json"
    given = kinds().parse_args(["low", "--output", f"{tmp_path}/"])
    assert given.output == tmp_path / "wall-low.json"


def test_a_file_is_that_file(tmp_path: Path) -> None:
    """Also in a folder that is made later, and where another one lies."""
    file = tmp_path / "new" / "mine.json"
    assert asked("--output", str(file)) == file
    file.parent.mkdir()
    file.write_text("{}")
    assert asked("--output", str(file)) == file
    assert file.read_text() == "{}"


def test_what_is_no_place_for_results_is_told_before_work(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "file"
    file.write_text("")
    (tmp_path / "walls.json").mkdir()
    below = file / "walls.json"
    assert "not a directory" in refused(capsys, "--output", below)
    assert "must be a regular file" in refused(capsys, "--output", tmp_path)
    assert "must end in .json" in refused(capsys, "--output", file)
    assert "no/where" in refused(capsys, "--output", "no/where")
    assert sorted(os.listdir(tmp_path)) == ["file", "walls.json"]
