"""Size-limited reading of run folder files, which strangers may have made."""

import json
import os
from io import BytesIO
from math import isfinite
from pathlib import Path
from stat import S_ISREG
from typing import Any

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Array

MAX_TEXT_BYTES = 2**20  # of a configuration or a summary
MAX_ARRAY_BYTES = 2**30  # of all arrays together; a game of a day has less
MAX_HEADER_BYTES = 512  # of one array


def read_bytes(file: Path, limit: int) -> bytes:
    """Read a regular file of at most ``limit`` bytes; ValueError for others.

    Links are not followed, and opening a pipe does not block.
    """
    flags = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0)
    handle = os.open(file, flags | getattr(os, "O_NONBLOCK", 0))
    with os.fdopen(handle, "rb") as stream:
        status = os.fstat(handle)
        if not S_ISREG(status.st_mode) or status.st_size > limit:
            raise ValueError(f"{file.name} must be a file of <= {limit} bytes")
        return stream.read(limit)


def read_text(file: Path) -> str:
    """Read a text file of at most 1 MiB; see :func:`read_bytes`."""
    return read_bytes(file, MAX_TEXT_BYTES).decode("utf-8")


def read_json(file: Path) -> Any:
    """Read a JSON file whose numbers are all finite; ValueError for others."""
    try:
        return json.loads(
            read_text(file), parse_constant=_finite, parse_float=_finite
        )
    except RecursionError as error:
        raise ValueError("JSON is nested too deep") from error


def check_object(plain: Any, source: str) -> dict[str, Any]:
    """Return a JSON object unchanged; ConfigurationError for others."""
    if not isinstance(plain, dict):
        raise ConfigurationError(
            f"{source} must hold one JSON object, got {type(plain).__name__}"
        )
    return plain


def read_arrays(file: Path) -> dict[str, Array]:
    """Read the arrays of an ``npz`` file by name; all hold real numbers.

    Damaged files raise what numpy and zipfile raise, or ValueError.
    """
    with np.load(
        BytesIO(read_bytes(file, MAX_ARRAY_BYTES)),
        allow_pickle=False,
        max_header_size=MAX_HEADER_BYTES,
    ) as archive:
        size = sum(member.file_size for member in archive.zip.infolist())
        if size > MAX_ARRAY_BYTES:
            raise ValueError(
                f"arrays of {file.name} must have at most {MAX_ARRAY_BYTES} "
                f"bytes, got {size}"
            )
        arrays = {name: np.asarray(archive[name]) for name in archive.files}
    for name, array in arrays.items():
        if array.dtype not in (np.float32, np.float64) or array.ndim > 2:
            raise ValueError(f"{name} must be a table of real numbers")
    return arrays


def _finite(text: str) -> float:
    number = float(text)
    if not isfinite(number):
        raise ValueError(f"numbers must be finite, got {text}")
    return number
