"""Sessions of ONNX Runtime on one thread."""

from collections.abc import Iterator
from functools import lru_cache
from glob import escape
from pathlib import Path
from typing import Any

from .entries import check_regular
from .errors import PolicyError
from .extras import install_hint


def open_network(path: Path) -> Any:
    """Return the session of an ONNX file: the same until a file changes."""
    return _open(str(path), *marks_of(path))


def marks_of(path: Path) -> Iterator[tuple[int, int]]:
    """Yield time and size of an ONNX file, and of those named like it.

    Its weights may lie in such files.
    """
    for file in sorted(path.parent.glob(f"{escape(path.stem)}*")):
        status = file.stat()
        yield status.st_mtime_ns, status.st_size


@lru_cache(maxsize=8)
def _open(path: str, *marks: tuple[int, int]) -> Any:
    return open_session(path)


def open_session(network: str | bytes) -> Any:
    """Return a session of an ONNX file, by its path or content.

    A file that the runtime cannot read is a :class:`.PolicyError` with its
    own reason.
    """
    try:
        import onnxruntime
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(
            install_hint(error), name=error.name
        ) from error
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    options.log_severity_level = 4  # errors are raised, not printed
    try:
        return onnxruntime.InferenceSession(
            network, options, providers=["CPUExecutionProvider"]
        )
    except Exception as error:  # no common base in ONNX Runtime
        raise PolicyError(" ".join(str(error).split())) from error


def check_readable(path: Path) -> None:
    """Raise :class:`PolicyError` unless a file can be read."""
    try:
        check_regular(path)
        path.open("rb").close()
    except OSError as error:
        raise PolicyError(f"cannot read {path}: {error.strerror}") from error
