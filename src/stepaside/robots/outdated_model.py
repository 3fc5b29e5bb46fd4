"""Published models that MuJoCo no longer reads as they are."""

import re
from pathlib import Path
from xml.etree import ElementTree

import mujoco

# Neither these elements nor those below describe the robot. MuJoCo drops some
# of their attributes between versions and then rejects files that have them.
SETTINGS = ("compiler", "option", "size", "statistic", "visual")
UNKNOWN_ATTRIBUTE = re.compile(
    r"unrecognized attribute: '(\w+)'\s+Element '(\w+)'", re.DOTALL
)


def read_outdated(path: Path, error: ValueError | None) -> mujoco.MjSpec:
    """Read a file, without the attributes that MuJoCo rejects, one by one.

    The error is that of MuJoCo, if it has tried.
    """
    if error is not None and UNKNOWN_ATTRIBUTE.search(str(error)) is None:
        raise error
    root = _root_of(path)
    tops = [top for kind in SETTINGS for top in root.iter(kind)]
    elements = [element for top in tops for element in top.iter()]
    while True:
        if error is not None:
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
