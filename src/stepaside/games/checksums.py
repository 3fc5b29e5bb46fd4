"""Checksums of a run folder: whether it is as it was written."""

import hmac
import re
from collections.abc import Collection
from hashlib import sha256
from pathlib import Path

from ..core.errors import ConfigurationError
from .archive_reader import LARGEST, bytes_of, read_text

CHECKSUMS = "checksums.txt"
LINE = re.compile(r"([0-9a-f]{64})  ([\w.-]+)")


def seal(folder: Path) -> None:
    """Write down the checksums of all files of a folder.

    ``sha256sum --check checksums.txt`` reads them, too.

    Args:
        folder: Of a run that is otherwise whole.
    """
    lines = [
        f"{sha256(file.read_bytes()).hexdigest()}  {file.name}\n"
        for file in sorted(folder.iterdir())
        if file.name != CHECKSUMS
    ]
    (folder / CHECKSUMS).write_text("".join(lines), encoding="utf-8")


def check_seal(folder: Path, names: Collection[str]) -> None:
    """Refuse a folder that was altered since it was sealed.

    One without checksums is of an older version, or was altered on purpose,
    and is taken as it is.

    Args:
        folder: Of a run.
        names: Files that are going to be read.

    Raises:
        ConfigurationError: If a file has another checksum, or none.
        ValueError: If a file is no file, or too long.
        OSError: If it cannot be read.
    """
    if not (folder / CHECKSUMS).exists():
        return
    found = dict.fromkeys(names, "")
    for line in read_text(folder / CHECKSUMS).splitlines():
        entry = LINE.fullmatch(line)
        if entry is not None and entry[2] in found:
            found[entry[2]] = entry[1]
    for name, wanted in found.items():
        got = sha256(bytes_of(folder / name, LARGEST)).hexdigest()
        if not hmac.compare_digest(got, wanted):
            raise ConfigurationError(
                f"{name} of run {folder} is not as it was written: its "
                f"checksum differs from that of {CHECKSUMS}; without that "
                "file it is read as it is"
            )
