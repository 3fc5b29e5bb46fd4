"""Results of generators of code, kept in the cache folder.

Formulas of a robot and their object code take longer to make than the first
second of its walk takes to compute, and are the same for every process.
"""

from collections.abc import Callable
from contextlib import suppress
from hashlib import sha256
from pathlib import Path

from .atomic_output import atomic_draft
from .compilation import cache_folder
from .errors import StepAsideError

MOST = 500  # files of a kind; older ones are removed


def kept(kind: str, inputs: object, make: Callable[[], bytes]) -> bytes:
    """Return a result, made once on this machine.

    Args:
        kind: Begin of the names of the files.
        inputs: All that the result depends on, the code that makes it
            included; equal inputs have equal representations.
        make: Makes the result.
    """
    digest = sha256(repr(inputs).encode()).hexdigest()[:32]
    file = cache_folder() / f"{kind}-{digest}"
    with suppress(OSError):
        return file.read_bytes()
    result = make()
    # They only save time, so a full disk is no failure.
    with suppress(OSError, StepAsideError):
        with atomic_draft(file) as draft:
            draft.write_bytes(result)
        files = list(file.parent.glob(f"{kind}-*"))
        if len(files) > MOST:
            min(files, key=lambda old: old.stat().st_mtime).unlink()
    return result


def files_digest(*files: Path) -> str:
    """Return a digest of the content of files."""
    digest = sha256()
    for file in files:
        digest.update(file.read_bytes())
    return digest.hexdigest()
