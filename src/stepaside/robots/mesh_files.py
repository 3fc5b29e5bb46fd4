"""Mesh files of a published model, wherever they lie."""

from pathlib import Path

import mujoco

PACKAGE = "package://"
KINDS = (".stl", ".obj", ".msh")  # that MuJoCo reads


def place_meshes(
    spec: mujoco.MjSpec, path: Path, folders: list[Path]
) -> list[str]:
    """Let every mesh of a model name a file that is there.

    A file is taken where the model says, or else where a folder has one of
    that name. Meshes without a file are left out, with what shows them.

    Args:
        spec: The model; it is changed.
        path: File of the model.
        folders: Where files are looked for besides.

    Returns:
        Files that are nowhere, or of a kind that MuJoCo does not read.
    """
    found: dict[str, Path] = {}
    for folder in folders:
        for file in sorted(folder.rglob("*")):
            found.setdefault(file.name, file)
    beside = path.parent / spec.meshdir
    missing, gone = [], set()
    for mesh in list(spec.meshes):
        name = Path(mesh.file)
        places = (
            beside / name,
            path.parent / name,
            *_in_package(path, mesh.file),
            found.get(name.name, beside / name.name),
        )
        taken = next((p for p in places if p.is_file()), None)
        if not mesh.file:
            continue  # it is written out in the model
        if taken is None or not _is_readable(taken):
            missing.append(mesh.file)
            gone.add(mesh.name or name.stem)
            continue
        mesh.file = str(taken.resolve())
    _leave_out(spec, gone)
    _let_thin_meshes_be(spec)
    return missing


def _in_package(path: Path, file: str) -> list[Path]:
    """Where a file of a ROS package may lie, seen from a model in it."""
    if not file.startswith(PACKAGE):
        return []
    package, _, rest = file.removeprefix(PACKAGE).partition("/")
    return [
        place
        for folder in path.resolve().parents
        for place in (folder / package / rest, folder / rest)
    ]


def _let_thin_meshes_be(spec: mujoco.MjSpec) -> None:
    """Take meshes as shells where their volume weighs nothing.

    MuJoCo refuses one that is flat or open otherwise.
    """
    weigh = {
        geom.meshname
        for body in spec.bodies
        if not body.explicitinertial
        for geom in body.geoms
    }
    for mesh in spec.meshes:
        if (mesh.name or Path(mesh.file).stem) not in weigh:
            mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL


def _is_readable(file: Path) -> bool:
    """Whether MuJoCo reads a file: of its kinds, an STL in binary."""
    if file.suffix.lower() not in KINDS:
        return False
    if file.suffix.lower() != ".stl":
        return True
    with file.open("rb") as stream:
        head = stream.read(84)
    faces = int.from_bytes(head[80:84], "little")
    return file.stat().st_size == 84 + 50 * faces


def _leave_out(spec: mujoco.MjSpec, gone: set[str]) -> None:
    """Delete meshes, and the geoms that show them."""
    if not gone:
        return
    for geom in list(spec.geoms):
        if geom.meshname in gone:
            spec.delete(geom)
    for mesh in list(spec.meshes):
        if (mesh.name or Path(mesh.file).stem) in gone:
            spec.delete(mesh)
