"""Test files of results."""

from pathlib import Path

import pytest
from result_files import header, read_result, write_result

from stepaside.core.errors import ConfigurationError

HEAD = header({"seeds": [1, 3]}, "python x.py")


def test_a_written_result_is_read(tmp_path: Path) -> None:
    file = tmp_path / "deep" / "run.json"
    written = write_result(file, HEAD, rows=[{"a": 1, "b": None}])
    assert read_result(file) == written
    assert [f.name for f in file.parent.iterdir()] == ["run.json"]


@pytest.mark.parametrize("bad", [float("nan"), float("inf")])
def test_nan_and_inf_are_refused_by_name(tmp_path: Path, bad: float) -> None:
    with pytest.raises(ConfigurationError, match="x.json.a.1 must be finite"):
        write_result(tmp_path / "x.json", HEAD, a=[0.0, bad])
    assert list(tmp_path.iterdir()) == []
