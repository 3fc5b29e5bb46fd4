"""Fingerprints of the code and the libraries that a result depends on."""

import ast
import sys
from collections.abc import Iterable
from functools import cache
from hashlib import sha256
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from .dependencies import dependencies

ROOT = Path(__file__).parents[1]
# Entry modules of results; their imports are found from the source.
PLANNER = ("planning",)
UNICYCLES = ("theory/unicycle",)
PHYSICS = ("games/duel", "games/walk_game")
LIBRARIES = ("mujoco", "numpy")
DIGITS = 12


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
    digest = sha256()
    for file in sorted(dependencies(ROOT, modules)):
        digest.update(str(file.relative_to(ROOT).as_posix()).encode())
        digest.update(_substance(file))
    return digest.hexdigest()[:DIGITS]


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
    digest = sha256()
    for file in sorted(ROOT.rglob("*")):
        if file.is_file() and "__pycache__" not in file.parts:
            digest.update(str(file.relative_to(ROOT).as_posix()).encode())
            digest.update(file.read_bytes())
    python = ".".join(map(str, sys.version_info[:2]))
    libraries = library_versions(("mujoco", "numba", "numpy", "scipy"))
    versions = {"python": python} | libraries
    words = " ".join(f"{name} {value}" for name, value in versions.items())
    return f"code {digest.hexdigest()[:DIGITS]} {words}"


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
