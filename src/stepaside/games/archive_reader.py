"""Files of a run folder, bounded before they are read.

A run folder may come from anywhere. A file is opened only if it is one, read
only as far as it may be long, and an array only if its header says what an
array of a run can be.
"""

import json
import os
from io import BytesIO
from math import isfinite
from pathlib import Path
from stat import S_ISREG
from typing import IO, Any, NoReturn
from zipfile import ZIP_DEFLATED, ZIP_STORED, ZipFile, ZipInfo

import numpy as np
from numpy.lib import format as npy

from ..core.poses import Array

LONGEST_TEXT = 2**20  # of a configuration or a summary, in [bytes]
LARGEST = 2**30  # of all arrays together, in [bytes]; a day has less
MOST = 128  # arrays in a file
HEADER = 512  # of an array, in [bytes]


def read_text(file: Path) -> str:
    """Text of a file that is short and no link.

    Raises:
        ValueError: If it is longer, no file or no text.
        OSError: If it cannot be read.
    """
    return bytes_of(file, LONGEST_TEXT).decode("utf-8")


def read_json(file: Path) -> Any:
    """Value of a JSON file; its numbers are finite.

    Raises:
        ValueError: If it is none, or nested too deep to be one of ours.
        OSError: If it cannot be read.
    """
    try:
        value = json.loads(read_text(file), parse_constant=_refuse)
        _check_numbers(value)
    except RecursionError as error:
        raise ValueError("it is nested too deep") from error
    return value


def read_arrays(file: Path, known: frozenset[str]) -> dict[str, Array]:
    """Arrays of an ``npz`` file, real numbers all.

    Args:
        file: The file.
        known: Names of the arrays that may be there.

    Raises:
        ValueError: If an array is none, or larger than it may be.
        OSError: If it cannot be read; zipfile raises others, too.
    """
    content = BytesIO(bytes_of(file, LARGEST))
    with ZipFile(content) as archive:
        members = archive.infolist()
        names = [member.filename for member in members]
        if len(members) > MOST or len(set(names)) < len(names):
            raise ValueError(f"it must hold at most {MOST} arrays, once each")
        strange = {name.removesuffix(".npy") for name in names} - known
        if strange:
            raise ValueError(f"it holds {min(strange)!r:.40}, as no run does")
        if sum(member.file_size for member in members) > LARGEST:
            raise ValueError(f"its arrays must have at most {LARGEST} bytes")
        return {
            (name := member.filename.removesuffix(".npy")): _array(
                archive, member, name
            )
            for member in members
        }


def bytes_of(file: Path, most: int) -> bytes:
    """All of a file; it is not followed elsewhere, nor waited for."""
    flags = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0)
    handle = os.open(file, flags | getattr(os, "O_NONBLOCK", 0))
    with os.fdopen(handle, "rb") as stream:
        about = os.fstat(handle)
        if not S_ISREG(about.st_mode) or about.st_size > most:
            raise ValueError(f"{file.name} must be a file of <= {most} bytes")
        content = stream.read(most + 1)
    if len(content) > most:
        raise ValueError(f"{file.name} must be a file of <= {most} bytes")
    return content


def _array(archive: ZipFile, member: ZipInfo, name: str) -> Array:
    if member.compress_type not in (ZIP_STORED, ZIP_DEFLATED):
        raise ValueError(f"{name} is packed in a way of its own")
    with archive.open(member) as stream:
        shape, by_columns, dtype = _header(stream, name)
        if dtype not in (np.dtype("<f4"), np.dtype("<f8")) or len(shape) > 2:
            raise ValueError(f"{name} must be a table of real numbers")
        size = dtype.itemsize * int(np.prod(shape, dtype=object))
        if not 0 <= size <= member.file_size:
            raise ValueError(f"{name} claims more numbers than it has")
        content = stream.read(size + 1)
    if len(content) != size:
        raise ValueError(f"{name} has other numbers than it claims")
    found: Array = np.frombuffer(content, dtype)
    if by_columns:
        return found.reshape(shape, order="F")
    return found.reshape(shape)


def _header(stream: IO[bytes], name: str) -> tuple[Any, bool, Any]:
    """Shape, whether columns come first, and kind of number."""
    if npy.read_magic(stream) != (1, 0):
        raise ValueError(f"{name} is an array of another format")
    try:
        told = npy.read_array_header_1_0(stream, max_header_size=HEADER)
    except Exception as error:  # it is a literal of Python, read as such
        raise ValueError(f"{name} has no header of an array") from error
    return told


def _refuse(word: str) -> NoReturn:
    raise ValueError(f"{word} is no number")


def _check_numbers(value: Any) -> None:
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        for each in value:
            _check_numbers(each)
    elif isinstance(value, float) and not isfinite(value):
        raise ValueError("a number must be finite")
