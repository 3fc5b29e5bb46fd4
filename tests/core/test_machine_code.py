"""Test kernels: their arguments, and that they can be turned off."""

from contextlib import nullcontext
from pathlib import Path

import numpy as np
import pytest

from stepaside.core.machine_code import (
    Kernel,
    bound_loop,
    chained,
    kernel_of,
    plain_python,
)

SOURCE = """
def add(rows, columns, amount):
    for i in range(rows.shape[0]):
        rows[i, 0] += columns[i] * amount
"""


@pytest.fixture
def kernel() -> Kernel:
    pytest.importorskip("llvmlite")
    made = kernel_of("add", SOURCE, "2i0")
    assert made is not None
    return made


def test_a_bound_kernel_works_on_its_arrays(kernel: Kernel) -> None:
    rows, columns = np.zeros((2, 1)), np.array([3, 5])
    add = kernel.bind(rows, columns, 0.5)
    for _ in range(2):
        assert add() == 0
    columns[0] = 1
    add()
    assert rows.ravel().tolist() == [3.5, 7.5]


def test_object_code_is_kept_by_source(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And read again; a cache that cannot be written changes nothing."""
    pytest.importorskip("llvmlite")
    file = tmp_path / "file"
    file.touch()
    for folder in (tmp_path, tmp_path, file):
        monkeypatch.setenv("XDG_CACHE_HOME", str(folder))
        for number in (2.0, 3.0):
            source = f"def fill(values):\n    values[0] = {number}\n"
            values = np.zeros(1)
            Kernel("fill", source, "1")(values)  # not one of this process
            assert values[0] == number
        assert len(list((tmp_path / "stepaside").iterdir())) == 2


def test_a_chain_runs_its_loops_in_order() -> None:
    """As machine code and as Python."""
    double = "def double(values):\n    values[0] += values[0]\n"
    increase = "def increase(values):\n    values[0] += 1.0\n"
    found = []
    for context in (nullcontext(), plain_python()):
        values = np.array([3.0])
        with context:
            one = bound_loop("double", double, "1", values)
            other = bound_loop("increase", increase, "1", values)
        chain = chained(one, other, one)
        for _ in range(2):
            chain()
        found.append(values.tolist())
    assert found == [[58.0]] * 2


@pytest.mark.parametrize(
    "rows",
    [
        np.zeros(2),
        np.zeros((2, 1), dtype=np.float32),
        np.zeros((2, 4))[:, ::2],
        1.0,
    ],
)
def test_an_array_of_another_kind_is_refused(
    kernel: Kernel, rows: np.ndarray
) -> None:
    with pytest.raises(TypeError, match="add takes contiguous arrays"):
        kernel(rows, np.array([1, 1]), 0.5)
