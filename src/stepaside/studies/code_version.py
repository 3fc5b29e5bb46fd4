"""Versions that change exactly when what a result depends on may change."""

import ast
from collections.abc import Iterable
from functools import cache
from hashlib import sha256
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from .dependencies import dependencies

ROOT = Path(__file__).parents[1]
# Where results begin; what these import is found from their code.
PLANNER = ("planning",)
UNICYCLES = ("theory/unicycle",)
PHYSICS = ("games/duel", "games/walk_game")
LIBRARIES = ("mujoco", "numpy")
DIGITS = 12


@cache
def code_version(rooms: tuple[str, ...]) -> str:
    """Return a fingerprint of modules and of all that they import.

    Comments, docstrings and layout do not count, so that a result is not
    made again because a sentence was mended. Imports are followed inside
    this package, see :func:`~stepaside.studies.dependencies.dependencies`.

    Args:
        rooms: Modules or folders of the package with which the computation
            of the result begins, such as "games/duel".

    Returns:
        Hexadecimal digits.

    Raises:
        FileNotFoundError: If there is no such module or folder.
    """
    digest = sha256()
    for file in sorted(dependencies(ROOT, rooms)):
        digest.update(str(file.relative_to(ROOT).as_posix()).encode())
        digest.update(_substance(file))
    return digest.hexdigest()[:DIGITS]


def library_versions(
    names: Iterable[str] = LIBRARIES,
) -> dict[str, str | None]:
    """Installed versions of what the results stand on; None if absent."""
    found: dict[str, str | None] = {}
    for name in names:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = None
    return found


def _substance(file: Path) -> bytes:
    """Bytes of a file; of code, what is left without its docstrings."""
    if file.suffix != ".py":
        return file.read_bytes()
    tree = ast.parse(file.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if isinstance(body, list) and body and _is_text(body[0]):
            del body[0]
    return ast.dump(tree).encode()


def _is_text(node: ast.stmt) -> bool:
    return (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    )
