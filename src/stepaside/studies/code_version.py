"""Fingerprints of the code and the libraries that a result depends on."""

import ast
import sys
from collections.abc import Iterable
from contextlib import suppress
from functools import cache
from hashlib import sha256
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from ..core.atomic_output import atomic_draft
from ..core.compilation import cache_folder
from ..core.errors import StepAsideError
from .dependencies import dependencies

ROOT = Path(__file__).parents[1]
# Entry modules of results; their imports are found from the source.
PLANNER = ("planning",)
UNICYCLES = ("theory/unicycle",)
PHYSICS = ("games/duel", "games/walk_game")
LIBRARIES = ("mujoco", "numpy")
DIGITS = 12
PYTHON = ".".join(map(str, sys.version_info[:2]))


@cache
def code_version(modules: tuple[str, ...]) -> str:
    """Return a fingerprint of modules and of all that they import.

    Comments, docstrings and layout do not count, so that editing prose does
    not invalidate a result. Imports are followed inside this package, see
    :func:`~stepaside.studies.dependencies.dependencies`.

    Args:
        modules: Modules or folders of the package where the computation of
            the result begins, such as "games/duel".

    Returns:
        Hexadecimal digits.

    Raises:
        FileNotFoundError: If there is no such module or folder.
    """
    # Parsing takes a second: the fingerprint of these very files is kept.
    key = sha256(f"{_all_files()} {modules} {PYTHON}".encode()).hexdigest()
    name = sha256(repr(modules).encode()).hexdigest()[:DIGITS]
    kept = cache_folder() / f"code-{name}.txt"
    with suppress(OSError, ValueError):
        of, found = kept.read_text(encoding="utf-8").split()
        if of == key:
            return found
    digest = sha256()
    for file in sorted(dependencies(ROOT, modules)):
        digest.update(str(file.relative_to(ROOT).as_posix()).encode())
        digest.update(_substance(file))
    found = digest.hexdigest()[:DIGITS]
    with suppress(OSError, StepAsideError), atomic_draft(kept) as draft:
        draft.write_text(f"{key} {found}", encoding="utf-8")
    return found


def library_versions(
    names: Iterable[str] = LIBRARIES,
) -> dict[str, str | None]:
    """Return the installed versions of libraries; None if absent."""
    found: dict[str, str | None] = {}
    for name in names:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = None
    return found


@cache
def installation() -> str:
    """Return what identifies the package and its libraries in a process.

    Unlike :func:`code_version` it covers all files as they are, and takes
    milliseconds.
    """
    libraries = library_versions(("mujoco", "numba", "numpy", "scipy"))
    versions = {"python": PYTHON} | libraries
    words = " ".join(f"{name} {value}" for name, value in versions.items())
    return f"code {_all_files()[:DIGITS]} {words}"


def _all_files() -> str:
    """Return a digest of all files of the package as they are."""
    digest = sha256()
    for file in sorted(ROOT.rglob("*")):
        if file.is_file() and "__pycache__" not in file.parts:
            digest.update(str(file.relative_to(ROOT).as_posix()).encode())
            digest.update(file.read_bytes())
    return digest.hexdigest()


def _substance(file: Path) -> bytes:
    """Return the bytes of a file; of code, its syntax without docstrings."""
    if file.suffix != ".py":
        return file.read_bytes()
    return _syntax(file.read_text(encoding="utf-8"))


@cache  # versions of several results share most of their files
def _syntax(text: str) -> bytes:
    """Return a fingerprint of the syntax of code without docstrings."""
    tree = ast.parse(text)
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if isinstance(body, list) and body and _is_text(body[0]):
            del body[0]
    return sha256(ast.dump(tree).encode()).digest()


def _is_text(node: ast.stmt) -> bool:
    return (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    )
