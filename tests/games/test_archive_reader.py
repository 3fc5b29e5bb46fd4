"""Test reading arrays of run folders."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stepaside.games.archive_reader import read_arrays

KNOWN = frozenset({"rows"})


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("shape", [(), (5,), (4, 3), (1, 7), (0, 3)])
@pytest.mark.parametrize("kind", ["<f4", "<f8"])
@pytest.mark.parametrize("packed", [False, True])
def test_an_array_is_read_as_written(
    shape: tuple[int, ...],
    order: Any,
    kind: str,
    packed: bool,
    tmp_path: Path,
) -> None:
    """In row and column order, compressed or not."""
    rows = np.random.default_rng(1).normal(size=shape).astype(kind)
    file = tmp_path / "arrays.npz"
    save = np.savez_compressed if packed else np.savez
    save(file, rows=np.asarray(rows, order=order))
    found = read_arrays(file, KNOWN)["rows"]
    assert found.dtype == kind
    np.testing.assert_array_equal(found, rows)
