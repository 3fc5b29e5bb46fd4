"""Model files as vendors publish them, read also where they are dated."""

import re
from pathlib import Path
from xml.etree import ElementTree

import mujoco

# Of a file's words those that say nothing of the robot: MuJoCo forgets some
# of them from version to version, and refuses files that still have them.
ASIDE = ("option", "flag", "size", "visual", "global", "quality", "statistic")
ASIDE_TOO = ("map", "scale", "headlight", "rgba", "compiler")
ENDINGS = (".xml", ".urdf")  # of files that MuJoCo takes for models
UNKNOWN = re.compile(
    r"unrecognized attribute: '(\w+)'\s+Element '(\w+)'", re.DOTALL
)


def read_model(path: Path) -> mujoco.MjSpec:
    """Read an MJCF or URDF file.

    Args:
        path: The file; it is only read.

    Returns:
        The editable model; settings of physics and of pictures that this
        version of MuJoCo does not know any more are passed over.

    Raises:
        ValueError: If it is no model; as MuJoCo says it.
    """
    path = path.resolve()  # MuJoCo loses includes of a relative path
    try:
        if path.suffix in ENDINGS:
            return mujoco.MjSpec.from_file(str(path))
        return _read_text(path, _root_of(path))
    except ValueError as error:
        if UNKNOWN.search(str(error)) is None:
            raise
        return _read_dated(path, error)


def _root_of(path: Path) -> ElementTree.Element:
    """Root of a file with what it includes.

    Raises:
        ValueError: If it is no XML.
    """
    try:
        return _included(path, path.parent)
    except (ElementTree.ParseError, UnicodeDecodeError) as error:
        raise ValueError(f"no XML: {error}") from error


def _read_text(path: Path, root: ElementTree.Element) -> mujoco.MjSpec:
    """Read what lies at a path, whatever its name ends with."""
    text = ElementTree.tostring(root, encoding="unicode")
    spec = mujoco.MjSpec.from_string(text)
    spec.modelfiledir = str(path.parent)
    return spec


def _read_dated(path: Path, error: ValueError) -> mujoco.MjSpec:
    """Read a file without the words that MuJoCo has forgotten."""
    root = _root_of(path)
    while True:
        found = UNKNOWN.search(str(error))
        if found is None or found[2] not in (*ASIDE, *ASIDE_TOO):
            raise error
        for element in root.iter(found[2]):
            element.attrib.pop(found[1], None)
        try:
            return _read_text(path, root)
        except ValueError as other:
            if str(other) == str(error):
                raise
            error = other


def _included(path: Path, folder: Path) -> ElementTree.Element:
    """Root of a file with what it includes from a folder in its place."""
    root = ElementTree.parse(path).getroot()
    for parent in list(root.iter()):
        for i, child in reversed(list(enumerate(parent))):
            if child.tag == "include":
                other = _included(folder / str(child.get("file")), folder)
                parent[i : i + 1] = list(other)
    return root
