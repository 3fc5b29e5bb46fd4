"""Size-limited reading of run folder files, which strangers may have made."""

from io import BytesIO
from pathlib import Path

import numpy as np

from ..core.poses import Array

MAX_BYTES = 2**30  # of a file, and of all its arrays; a game of a day has less
MAX_HEADER_BYTES = 512  # of one array


def read_bytes(file: Path) -> bytes:
    """Read a regular file that is not too large; ValueError for others."""
    if not file.is_file() or file.stat().st_size > MAX_BYTES:
        raise ValueError(f"{file.name} must be a file of <= {MAX_BYTES} bytes")
    return file.read_bytes()


def read_arrays(file: Path) -> dict[str, Array]:
    """Read the arrays of an ``npz`` file by name; all hold real numbers.

    Damaged files raise what numpy and zipfile raise, or ValueError.
    """
    with np.load(
        BytesIO(read_bytes(file)),
        allow_pickle=False,
        max_header_size=MAX_HEADER_BYTES,
    ) as archive:
        size = sum(member.file_size for member in archive.zip.infolist())
        if size > MAX_BYTES:
            raise ValueError(
                f"arrays of {file.name} must have at most {MAX_BYTES} "
                f"bytes, got {size}"
            )
        arrays = {name: np.asarray(archive[name]) for name in archive.files}
    for name, array in arrays.items():
        if array.dtype not in (np.float32, np.float64) or array.ndim > 2:
            raise ValueError(f"{name} must be a table of real numbers")
    return arrays
