"""Rows of numbers on disk, written as they come."""

import json
import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from shutil import copyfileobj
from typing import BinaryIO

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Array

FLUSHED = 10  # rows between two times that they reach the disk
HEADER, ROWS = "columns.json", "rows.f64"


class RowWriter:
    """Appends rows, so that what is written survives whatever happens.

    ``columns.json`` names the columns and says how many numbers each has;
    ``rows.f64`` holds the rows, little-endian doubles one after the other.

    Attributes:
        count: Rows so far.
    """

    def __init__(self, folder: Path) -> None:
        """Begin.

        Args:
            folder: Must not exist yet, or be empty.

        Raises:
            ConfigurationError: If it cannot be written.
        """
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if any(folder.iterdir()):
                raise ConfigurationError(f"{folder} must be empty")
            self._file: BinaryIO = (folder / ROWS).open("w+b")
        except OSError as error:
            raise ConfigurationError(
                f"cannot write {folder}: {error}"
            ) from error
        self._folder = folder
        self._columns: dict[str, int] = {}
        self.count = 0

    def add(self, row: Mapping[str, Array | float]) -> None:
        """Append a row; the first one says which columns there are.

        Args:
            row: A number or an array of shape (width,) for each column.

        Raises:
            ValueError: If its columns are not those of the first row.
        """
        parts = {name: np.atleast_1d(value) for name, value in row.items()}
        columns = {name: part.size for name, part in parts.items()}
        if not self._columns:
            self._columns = columns
            text = json.dumps(columns)
            (self._folder / HEADER).write_text(text + "\n", encoding="utf-8")
        if columns != self._columns:
            raise ValueError(f"a row has {self._columns}, got {columns}")
        data = np.concatenate(list(parts.values())).astype("<f8")
        self._file.write(data.tobytes())
        self.count += 1
        if self.count % FLUSHED == 0:
            self._file.flush()

    def copy_to(self, folder: Path) -> None:
        """Write what there is into another folder, too.

        What has a name no more, for somebody removed the folder, can still
        be read here until it is closed.

        Args:
            folder: It exists.

        Raises:
            OSError: If it cannot be written.
        """
        with (
            os.fdopen(os.dup(self._file.fileno()), "rb") as read,
            (folder / ROWS).open("wb") as out,
        ):
            read.seek(0)
            copyfileobj(read, out)
        text = json.dumps(self._columns)
        (folder / HEADER).write_text(text + "\n", encoding="utf-8")
        with suppress(OSError):  # the last rows may have no room anywhere
            self._file.close()

    def close(self) -> None:
        """Write what is left.

        Raises:
            OSError: If it cannot be written, or nobody could find it there;
                it can be copied then.
        """
        self._file.flush()
        (self._folder / ROWS).stat()
        self._file.close()


def read_rows(folder: Path) -> dict[str, Array]:
    """Columns of rows, as far as they were written.

    Args:
        folder: Where they lie.

    Returns:
        Arrays by name of the column. Shapes (rows,) or (rows, width).

    Raises:
        ConfigurationError: If there are none.
    """
    try:
        text = (folder / HEADER).read_text(encoding="utf-8")
        columns: dict[str, int] = json.loads(text)
        data = (folder / ROWS).read_bytes()
    except (OSError, ValueError) as error:
        raise ConfigurationError(f"no rows in {folder}: {error}") from error
    return columns_in(data, columns)


def columns_in(data: bytes, columns: Mapping[str, int]) -> dict[str, Array]:
    """Columns of rows that were read; what is no whole row is left out.

    Args:
        data: Rows.
        columns: How many numbers each column has, in their order.
    """
    width = sum(columns.values())
    whole = len(data) // (8 * width) * 8 * width
    rows = np.frombuffer(data[:whole], "<f8").reshape(-1, width)
    found, at = {}, 0
    for name, size in columns.items():
        part: Array = rows[:, at : at + size]
        found[name] = part[:, 0] if size == 1 else part
        at += size
    return found
