"""Versions that change exactly when what a result depends on may change."""

import ast
from collections.abc import Iterable
from functools import cache
from hashlib import sha256
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

ROOT = Path(__file__).parents[1]
GROUND = ("errors", "poses")
PLANNER = (*GROUND, "planning")
UNICYCLES = (*GROUND, "unicycle")
# What moves a robot, and what measures how it moved.
PHYSICS = (
    *PLANNER,
    *("unicycle", "robots", "sensing", "perception", "strategies"),
    *("control", "world", "games", "randomness", "rooms", "steps"),
)
LIBRARIES = ("mujoco", "numpy")
DIGITS = 12


@cache
def code_version(rooms: tuple[str, ...]) -> str:
    """Fingerprint of the code and data of some rooms of this package.

    Comments, docstrings and layout do not count, so that a result is not
    made again because a sentence was mended.

    Args:
        rooms: Names of modules or folders in the package.

    Returns:
        Hexadecimal digits.
    """
    digest = sha256()
    for file in sorted(_files(rooms)):
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


def _files(rooms: Iterable[str]) -> Iterable[Path]:
    for room in rooms:
        folder, module = ROOT / room, ROOT / f"{room}.py"
        found = [module] if module.is_file() else []
        if folder.is_dir():
            found += [
                file
                for file in folder.rglob("*")
                if file.is_file() and "__pycache__" not in file.parts
            ]
        if not found:
            raise FileNotFoundError(f"no module or folder {room!r} in {ROOT}")
        yield from found


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
