"""Files of numeric rows, written while they are produced."""

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

FLUSH_INTERVAL = 10  # rows between two flushes to disk
HEADER, ROWS = "columns.json", "rows.f64"


class RowWriter:
    """Append-only writer of rows; a crash loses at most the last ten.

    ``columns.json`` maps each column's name to its width; ``rows.f64``
    holds the rows as consecutive little-endian doubles.

    Attributes:
        count: Number of rows written.
    """

    def __init__(self, folder: Path) -> None:
        """Create the files.

        Args:
            folder: Folder that does not exist yet, or is empty.

        Raises:
            ConfigurationError: If the folder cannot be written.
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
        """Append a row; the first row defines the columns.

        Args:
            row: A number or an array of shape (width,) for each column.

        Raises:
            ValueError: If the columns differ from those of the first row.
        """
        parts = {name: np.atleast_1d(value) for name, value in row.items()}
        columns = {name: part.size for name, part in parts.items()}
        if not self._columns:
            self._columns = columns
            text = json.dumps(columns)
            (self._folder / HEADER).write_text(text + "\n", encoding="utf-8")
        if columns != self._columns:
            raise ValueError(
                f"columns of a row must be {self._columns}, got {columns}"
            )
        data = np.concatenate(list(parts.values())).astype("<f8")
        self._file.write(data.tobytes())
        self.count += 1
        if self.count % FLUSH_INTERVAL == 0:
            self._file.flush()

    def copy_to(self, folder: Path) -> None:
        """Copy all rows to another folder, and close the original.

        Works even if the original folder was removed: the open file can
        still be read.

        Args:
            folder: Existing folder.

        Raises:
            OSError: If the folder cannot be written.
        """
        with (
            os.fdopen(os.dup(self._file.fileno()), "rb") as read,
            (folder / ROWS).open("wb") as out,
        ):
            read.seek(0)
            copyfileobj(read, out)
        text = json.dumps(self._columns)
        (folder / HEADER).write_text(text + "\n", encoding="utf-8")
        with suppress(OSError):  # the original's disk may be full
            self._file.close()

    def close(self) -> None:
        """Flush and close the file.

        Raises:
            OSError: If the rows cannot be written, or the file has been
                removed; :meth:`copy_to` still works then.
        """
        self._file.flush()
        (self._folder / ROWS).stat()
        self._file.close()


def read_rows(folder: Path) -> dict[str, Array]:
    """Read the complete rows of a folder.

    Args:
        folder: Folder written by :class:`RowWriter`.

    Returns:
        Arrays by column name. Shapes (rows,) or (rows, width).

    Raises:
        ConfigurationError: If the files are missing or invalid.
    """
    try:
        text = (folder / HEADER).read_text(encoding="utf-8")
        columns: dict[str, int] = json.loads(text)
        data = (folder / ROWS).read_bytes()
    except (OSError, ValueError) as error:
        raise ConfigurationError(f"no rows in {folder}: {error}") from error
    return columns_in(data, columns)


def columns_in(data: bytes, columns: Mapping[str, int]) -> dict[str, Array]:
    """Split row data into columns; an incomplete last row is dropped.

    Args:
        data: Contents of ``rows.f64``.
        columns: Width of each column, in order.

    Returns:
        Arrays by column name. Shapes (rows,) or (rows, width).
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
