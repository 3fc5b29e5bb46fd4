"""Kinematic tree stored beside a description, for use without MuJoCo."""

import json
from hashlib import sha256
from pathlib import Path

from ..core.entries import load_entries, read_entries, to_entries
from ..core.errors import ModelError
from .description import RobotDescription
from .description_types import NO_OVERLAY
from .robot_tree import RobotTree

FILE = "tree.json"
VERSION = 4  # of the file format
CACHE_SIZE = 16  # trees that are cached
_cache: dict[tuple[Path, str], RobotTree] = {}


def load_tree(description: RobotDescription) -> RobotTree:
    """Return the tree of a robot, stored or else compiled.

    The stored tree is used unless it is older than the model. The same
    model gives the same object.
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
    """Compile the tree of a robot and write it beside its description."""
    from .tree_compiler import compile_tree

    path = description.folder / FILE
    marks = {"version": VERSION, "digest": digest_of(description)}
    entries = marks | to_entries(compile_tree(description))
    lines = [f' "{name}": {json.dumps(x)}' for name, x in entries.items()]
    text = ",\n".join(lines).replace("}, ", "},\n  ")  # a link on each line
    path.write_text(f"{{\n{text}\n}}\n", encoding="utf-8")
    return path


def digest_of(description: RobotDescription) -> str:
    """Return a digest of all inputs of the compiled tree but meshes."""
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


def _read_or_compile(description: RobotDescription, digest: str) -> RobotTree:
    path = description.folder / FILE
    reason = "is missing"
    if path.is_file():
        reason = "is older than the model"
        try:
            entries = load_entries(path, ModelError)
            marks = [entries.pop(x, None) for x in ("version", "digest")]
            if marks == [VERSION, digest]:
                return read_entries(RobotTree, entries, error=ModelError)
        except ModelError as error:
            reason = f"cannot be read ({error})"
    try:
        from .tree_compiler import compile_tree
    except ImportError as error:
        raise ModelError(
            f"{path} {reason}, and MuJoCo is not installed to compile the "
            f"model: run `stepaside robot {description.folder} --compile` on "
            "a machine with MuJoCo"
        ) from error
    return compile_tree(description)
