"""Checksums of a run folder."""

import hmac
import re
from collections.abc import Collection
from hashlib import sha256
from pathlib import Path

from ..core.errors import ConfigurationError
from .archive_reader import MAX_ARRAY_BYTES, read_bytes, read_text

CHECKSUMS = "checksums.txt"
LINE = re.compile(r"([0-9a-f]{64})  ([\w.-]+)")


def write_checksums(folder: Path) -> None:
    """Write the SHA-256 checksums of all files of a folder.

    The file has the format of ``sha256sum --check``.

    Args:
        folder: Run folder whose other files are complete.
    """
    lines = [
        f"{sha256(file.read_bytes()).hexdigest()}  {file.name}\n"
        for file in sorted(folder.iterdir())
        if file.name != CHECKSUMS
    ]
    (folder / CHECKSUMS).write_text("".join(lines), encoding="utf-8")


def check_checksums(folder: Path, names: Collection[str]) -> None:
    """Check the files of a run folder against its checksums.

    A folder without checksums was edited by hand and is not checked.

    Args:
        folder: Run folder.
        names: Names of the files that will be read.

    Raises:
        ConfigurationError: If a file has another checksum, or none.
        ValueError: If a file is not a regular file, or too long.
        OSError: If a file cannot be read.
    """
    if not (folder / CHECKSUMS).exists():
        return
    found = dict.fromkeys(names, "")
    for line in read_text(folder / CHECKSUMS).splitlines():
        entry = LINE.fullmatch(line)
        if entry is not None and entry[2] in found:
            found[entry[2]] = entry[1]
    for name, wanted in found.items():
        content = read_bytes(folder / name, MAX_ARRAY_BYTES)
        got = sha256(content).hexdigest()
        if not hmac.compare_digest(got, wanted):
            raise ConfigurationError(
                f"{name} of run {folder} was modified: its checksum differs "
                f"from that in {CHECKSUMS}; delete {CHECKSUMS} to read the "
                "folder unchecked"
            )
