"""Reader of published MJCF and URDF files, including outdated ones."""

import re
from pathlib import Path
from xml.etree import ElementTree

import mujoco

from ..core.errors import ModelError

# Neither these elements nor those below describe the robot. MuJoCo drops some
# of their attributes between versions and then rejects files that have them.
SETTINGS = ("compiler", "option", "size", "statistic", "visual")
SUFFIXES = (".xml", ".urdf")  # that MuJoCo accepts for model files
UNKNOWN_ATTRIBUTE = re.compile(
    r"unrecognized attribute: '(\w+)'\s+Element '(\w+)'", re.DOTALL
)


def read_model(path: Path) -> mujoco.MjSpec:
    """Read an MJCF or URDF file as an editable model.

    Attributes of physics and rendering that MuJoCo lacks are ignored.
    """
    path = path.resolve()  # MuJoCo does not find includes of a relative path
    try:
        try:
            if path.suffix in SUFFIXES:
                return mujoco.MjSpec.from_file(str(path))
            return _read_text(path, _root_of(path))
        except ValueError as error:
            if UNKNOWN_ATTRIBUTE.search(str(error)) is None:
                raise
            return _read_outdated(path, error)
    except ValueError as error:
        raise ModelError(f"{path} is not a MuJoCo model: {error}") from error


def _root_of(path: Path) -> ElementTree.Element:
    """Return the root element with includes expanded."""
    try:
        return _expand_includes(path, path.parent)
    except (ElementTree.ParseError, UnicodeDecodeError) as error:
        raise ValueError(f"not XML: {error}") from error


def _read_text(path: Path, root: ElementTree.Element) -> mujoco.MjSpec:
    """Read a parsed model; relative paths refer to the folder of ``path``."""
    text = ElementTree.tostring(root, encoding="unicode")
    spec = mujoco.MjSpec.from_string(text)
    spec.modelfiledir = str(path.parent)
    return spec


def _read_outdated(path: Path, error: ValueError) -> mujoco.MjSpec:
    """Read a file without the attributes that MuJoCo rejects, one by one."""
    root = _root_of(path)
    tops = [top for kind in SETTINGS for top in root.iter(kind)]
    elements = [element for top in tops for element in top.iter()]
    while True:
        found = UNKNOWN_ATTRIBUTE.search(str(error))
        if found is None or found[2] not in {x.tag for x in elements}:
            raise error
        for element in elements:
            if element.tag == found[2]:
                element.attrib.pop(found[1], None)
        try:
            return _read_text(path, root)
        except ValueError as other:
            if str(other) == str(error):
                raise
            error = other


def _expand_includes(path: Path, folder: Path) -> ElementTree.Element:
    """Return the root element, includes replaced by their content."""
    root = ElementTree.parse(path).getroot()
    for parent in list(root.iter()):
        for i, child in reversed(list(enumerate(parent))):
            if child.tag == "include":
                file = folder / str(child.get("file"))
                other = _expand_includes(file, folder)
                parent[i : i + 1] = list(other)
    return root
