"""Refusal of pipes and devices, whose reading may never end."""

import errno
from pathlib import Path


def check_regular(path: Path) -> None:
    """Refuse a pipe, a socket or a device as a file to read.

    Raises:
        OSError: If it is one.
    """
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise OSError(errno.EINVAL, "not a regular file", str(path))
