"""Size-limited reading of run folder files.

A run folder may come from an untrusted source. Only regular files are opened,
at most a fixed number of bytes is read, and an array is decoded only if its
header describes an array that a run can contain.
"""

import json
import os
from io import BytesIO
from math import isfinite
from pathlib import Path
from stat import S_ISREG
from typing import IO, Any, NoReturn, TypeVar
from zipfile import ZIP_DEFLATED, ZIP_STORED, ZipFile, ZipInfo

import numpy as np
from numpy.lib import format as npy

from ..core.entries import read_entries
from ..core.errors import ConfigurationError
from ..core.poses import Array

T = TypeVar("T")

MAX_TEXT_BYTES = 2**20  # of a configuration or a summary
MAX_ARRAY_BYTES = 2**30  # of all arrays together; a game of a day has less
MAX_ARRAYS = 1024  # in one file
MAX_HEADER_BYTES = 512  # of one array


def read_text(file: Path) -> str:
    """Read a text file of at most 1 MiB; links are not followed.

    Raises:
        ValueError: If the file is longer, not a regular file or not UTF-8.
        OSError: If it cannot be read.
    """
    return read_bytes(file, MAX_TEXT_BYTES).decode("utf-8")


def read_json(file: Path) -> Any:
    """Read a JSON file whose numbers are all finite.

    Raises:
        ValueError: If it is not JSON, nested too deep, or holds NaN or inf.
        OSError: If it cannot be read.
    """
    try:
        value = json.loads(read_text(file), parse_constant=_reject_constant)
        _check_finite(value)
    except RecursionError as error:
        raise ValueError("JSON is nested too deep") from error
    return value


def check_object(plain: Any, source: str) -> dict[str, Any]:
    """Return a JSON object unchanged; reject any other value.

    Args:
        plain: JSON value.
        source: Origin of the value, for messages.

    Raises:
        ConfigurationError: If the value is not an object.
    """
    if not isinstance(plain, dict):
        raise ConfigurationError(
            f"{source} must hold one JSON object, got {type(plain).__name__}"
        )
    return plain


def parse_object(kind: type[T], plain: Any, source: str) -> T:
    """Parse a JSON object into a dataclass; further entries are ignored.

    Args:
        kind: The dataclass.
        plain: JSON value.
        source: Origin of the value, for messages.

    Raises:
        ConfigurationError: If an entry is missing or of the wrong type;
            names the entry.
    """
    entries = check_object(plain, source)
    return read_entries(kind, entries, source, ignoring=True)


def read_arrays(file: Path, known: frozenset[str]) -> dict[str, Array]:
    """Read the arrays of an ``npz`` file; all hold real numbers.

    Args:
        file: The file.
        known: Names of the arrays that may be present.

    Returns:
        Arrays by name.

    Raises:
        ValueError: If an array is malformed, unknown or too large.
        OSError: If the file cannot be read; zipfile raises other exceptions
            in addition.
    """
    content = BytesIO(read_bytes(file, MAX_ARRAY_BYTES))
    with ZipFile(content) as archive:
        members = archive.infolist()
        names = [member.filename for member in members]
        if len(members) > MAX_ARRAYS or len(set(names)) < len(names):
            raise ValueError(
                f"{file.name} must hold at most {MAX_ARRAYS} arrays with "
                f"unique names, got {len(members)}"
            )
        unknown = {name.removesuffix(".npy") for name in names} - known
        if unknown:
            raise ValueError(
                f"{file.name} holds an unknown array {min(unknown)!r:.40}"
            )
        size = sum(member.file_size for member in members)
        if size > MAX_ARRAY_BYTES:
            raise ValueError(
                f"arrays of {file.name} must have at most {MAX_ARRAY_BYTES} "
                f"bytes, got {size}"
            )
        arrays = {}
        for member in members:
            name = member.filename.removesuffix(".npy")
            arrays[name] = _read_array(archive, member, name)
        return arrays


def read_bytes(file: Path, limit: int) -> bytes:
    """Read a regular file of at most ``limit`` bytes.

    Links are not followed, and opening a pipe does not block.
    """
    flags = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0)
    handle = os.open(file, flags | getattr(os, "O_NONBLOCK", 0))
    with os.fdopen(handle, "rb") as stream:
        status = os.fstat(handle)
        if not S_ISREG(status.st_mode) or status.st_size > limit:
            raise ValueError(f"{file.name} must be a file of <= {limit} bytes")
        content = stream.read(limit + 1)
    if len(content) > limit:
        raise ValueError(f"{file.name} must be a file of <= {limit} bytes")
    return content


def _read_array(archive: ZipFile, member: ZipInfo, name: str) -> Array:
    if member.compress_type not in (ZIP_STORED, ZIP_DEFLATED):
        raise ValueError(f"{name} must be stored or deflated in the archive")
    with archive.open(member) as stream:
        shape, column_major, dtype = _read_header(stream, name)
        if dtype not in (np.dtype("<f4"), np.dtype("<f8")) or len(shape) > 2:
            raise ValueError(f"{name} must be a table of real numbers")
        size = dtype.itemsize * int(np.prod(shape, dtype=object))
        if not 0 <= size <= member.file_size:
            raise ValueError(
                f"{name} is truncated: its header announces {size} bytes, "
                f"got {member.file_size}"
            )
        content = stream.read(size + 1)
    if len(content) != size:
        raise ValueError(f"{name} must have {size} bytes, as its header says")
    array: Array = np.frombuffer(content, dtype)
    if column_major:
        return array.reshape(shape, order="F")
    return array.reshape(shape)


def _read_header(stream: IO[bytes], name: str) -> tuple[Any, bool, Any]:
    """Read shape, whether the order is column-major, and data type."""
    if npy.read_magic(stream) != (1, 0):
        raise ValueError(f"{name} must be an array of npy format 1.0")
    try:
        return npy.read_array_header_1_0(
            stream, max_header_size=MAX_HEADER_BYTES
        )
    except Exception as error:  # numpy parses it as a Python literal
        raise ValueError(f"{name} has no valid npy header") from error


def _reject_constant(text: str) -> NoReturn:
    raise ValueError(f"numbers must be finite, got {text}")


def _check_finite(value: Any) -> None:
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        for item in value:
            _check_finite(item)
    elif isinstance(value, float) and not isfinite(value):
        raise ValueError(f"numbers must be finite, got {value}")
