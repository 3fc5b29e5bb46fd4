"""Test files of results."""

from pathlib import Path

import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.studies.result_files import (
    header,
    read_result,
    write_result,
)
from stepaside.studies.results_version import RESULTS

HEAD = header({"seeds": [1, 3]}, "python x.py")


def test_a_written_result_is_read(tmp_path: Path) -> None:
    file = tmp_path / "deep" / "run.json"
    written = write_result(file, HEAD, rows=[{"a": 1, "b": None}])
    assert read_result(file) == written
    assert written["results"] == RESULTS
    assert [f.name for f in file.parent.iterdir()] == ["run.json"]


@pytest.mark.parametrize("bad", [float("nan"), float("inf")])
def test_nan_and_inf_are_refused_by_name(tmp_path: Path, bad: float) -> None:
    with pytest.raises(ConfigurationError, match="x.json.a.1 must be finite"):
        write_result(tmp_path / "x.json", HEAD, a=[0.0, bad])
    assert list(tmp_path.iterdir()) == []


def test_a_failed_write_leaves_the_old_result(tmp_path: Path) -> None:
    file = tmp_path / "x.json"
    old = write_result(file, HEAD, a=1)
    with pytest.raises(TypeError):
        write_result(file, HEAD, a=object())
    assert read_result(file) == old
    assert [f.name for f in tmp_path.iterdir()] == ["x.json"]


def test_a_file_that_is_not_a_result_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match="no result x.json"):
        read_result(tmp_path / "x.json")
    (tmp_path / "x.json").write_text("{")
    with pytest.raises(ConfigurationError, match="x.json is not a result"):
        read_result(tmp_path / "x.json")
