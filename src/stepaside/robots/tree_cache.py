"""The tree of a robot beside its description, so that MuJoCo can be away."""

import json
from hashlib import sha256
from pathlib import Path

from ..core.errors import ModelError
from .description import RobotDescription
from .description_types import NO_OVERLAY
from .robot_tree import RobotTree, write_tree

FILE = "tree.json"
VERSION = 2  # of the file; rises with what it means
KEPT = 16  # trees that are kept
_KNOWN: dict[tuple[Path, str], RobotTree] = {}


def load_tree(description: RobotDescription) -> RobotTree:
    """Tree of a robot: the stored one, or compiled if that is out of date.

    The same model gives the same object.

    Raises:
        ModelError: If the tree lacks what is described, or has to be
            compiled and MuJoCo is not installed.
    """
    digest = digest_of(description)
    key = (description.folder, digest)
    if key not in _KNOWN:
        if len(_KNOWN) >= KEPT:
            _KNOWN.clear()
        _KNOWN[key] = _stored_or_compiled(description, digest)
    tree = _KNOWN[key]
    description.check(tree.bodies, tree.sites, tree.joints, tree.motors)
    return tree


def store_tree(description: RobotDescription) -> Path:
    """Compile the tree of a robot and write it beside its description.

    Raises:
        ModelError: If the model lacks what is described, or a file of that
            name holds something else.
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
    """Digest of all that a tree is compiled from.

    That is the MJCF files of the folder, with their names, which body is
    the torso, and the overlay with the model that it is put on, wherever
    that lies. Meshes are not looked into.
    """
    digest = sha256(f"{description.model} {description.torso}\n".encode())
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
    """Whether a file is a tree that was stored before."""
    try:
        entries = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return False
    return isinstance(entries, dict) and {"version", "digest"} <= set(entries)


def _stored_or_compiled(
    description: RobotDescription, digest: str
) -> RobotTree:
    path = description.folder / FILE
    why = "is missing"
    if path.is_file():
        try:
            entries = json.loads(path.read_text(encoding="utf-8"))
            if (entries["version"], entries["digest"]) == (VERSION, digest):
                return RobotTree.from_json(entries)
            why = "is older than the model"
        except (KeyError, TypeError, ValueError) as error:
            why = f"cannot be read ({error!r})"
    try:
        from .tree_compiler import compile_tree
    except ImportError as error:
        raise ModelError(
            f"{path} {why}, and MuJoCo is not here to compile the model: "
            f"run `stepaside robot {description.folder} --compile` where it is"
        ) from error
    return compile_tree(description)
