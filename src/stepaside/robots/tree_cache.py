"""Kinematic tree stored beside a description, for use without MuJoCo."""

import json
from hashlib import sha256
from pathlib import Path

from ..core.errors import ModelError
from .description import RobotDescription
from .description_types import NO_OVERLAY
from .robot_tree import RobotTree, write_tree

FILE = "tree.json"
VERSION = 3  # of the file format
CACHE_SIZE = 16  # trees that are cached
_cache: dict[tuple[Path, str], RobotTree] = {}


def load_tree(description: RobotDescription) -> RobotTree:
    """Return the tree of a robot, stored or else compiled.

    The stored tree is used unless it is older than the model. The same model
    gives the same object.

    Raises:
        ModelError: If the tree lacks an element of the description, or has
            to be compiled and MuJoCo is not installed.
    """
    digest = digest_of(description)
    key = (description.folder, digest)
    if key not in _cache:
        if len(_cache) >= CACHE_SIZE:
            _cache.clear()
        _cache[key] = _read_or_compile(description, digest)
    tree = _cache[key]
    description.check(tree.bodies, tree.sites, tree.joints, tree.motors)
    return tree


def store_tree(description: RobotDescription) -> Path:
    """Compile the tree of a robot and write it beside its description.

    Raises:
        ModelError: If the model lacks an element of the description, or a
            file of that name is not a compiled tree.
    """
    from .tree_compiler import compile_tree

    path = description.folder / FILE
    if path.exists() and not _is_tree(path):
        raise ModelError(
            f"{path} must be a compiled tree, which is replaced, or absent, "
            "got another file"
        )
    tree = compile_tree(description)
    text = write_tree(tree, digest_of(description), VERSION)
    path.write_text(text, encoding="utf-8")
    return path


def digest_of(description: RobotDescription) -> str:
    """Return a digest of all inputs of the compilation of a tree.

    These are the MJCF files of the folder with their names, the name of the
    torso, the standing posture and the accent, and the overlay with the model
    that it refers to. The content of meshes is not included.
    """
    named = description.model, description.torso, description.accent
    digest = sha256(f"{named} {description.standing}\n".encode())
    for path in sorted(description.folder.rglob("*.xml")):
        name = path.relative_to(description.folder).as_posix()
        digest.update(name.encode())
        digest.update(path.read_bytes())
    if description.overlay != NO_OVERLAY:
        digest.update(description.path.read_bytes())
        overlay, sole = description.overlay, description.sole
        digest.update(f"{overlay} {sole} {description.sensors}".encode())
    return digest.hexdigest()[:16]


def _is_tree(path: Path) -> bool:
    """Return whether a file is a stored tree."""
    try:
        entries = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return False
    return isinstance(entries, dict) and {"version", "digest"} <= set(entries)


def _read_or_compile(description: RobotDescription, digest: str) -> RobotTree:
    path = description.folder / FILE
    reason = "is missing"
    if path.is_file():
        try:
            entries = json.loads(path.read_text(encoding="utf-8"))
            if (entries["version"], entries["digest"]) == (VERSION, digest):
                return RobotTree.from_json(entries)
            reason = "is older than the model"
        except (KeyError, TypeError, ValueError) as error:
            reason = f"cannot be read ({error!r})"
    try:
        from .tree_compiler import compile_tree
    except ImportError as error:
        raise ModelError(
            f"{path} {reason}, and MuJoCo is not installed to compile the "
            f"model: run `stepaside robot {description.folder} --compile` on "
            "a machine with MuJoCo"
        ) from error
    return compile_tree(description)
