"""Mesh files of a published model: lookup and checks."""

from pathlib import Path

import mujoco

PACKAGE = "package://"
SUFFIXES = (".stl", ".obj", ".msh")  # of formats that MuJoCo reads


def resolve_meshes(
    spec: mujoco.MjSpec, path: Path, folders: list[Path]
) -> list[str]:
    """Replace the mesh files of a model by absolute paths.

    A file is looked up as the model names it, then by name in the folders.
    Meshes that are missing or unreadable are returned and deleted.
    """
    by_name: dict[str, Path] = {}
    for folder in folders:
        for file in sorted(folder.rglob("*")):
            by_name.setdefault(file.name, file)
    mesh_folder = path.parent / spec.meshdir
    missing: list[str] = []
    unusable: set[str] = set()
    for mesh in list(spec.meshes):
        if not mesh.file:
            continue  # vertices are in the model itself
        name = Path(mesh.file)
        candidates = (
            mesh_folder / name,
            path.parent / name,
            *_in_ros_package(path, mesh.file),
            by_name.get(name.name, mesh_folder / name.name),
        )
        found = next((p for p in candidates if p.is_file()), None)
        if found is None or not _is_readable(found):
            missing.append(mesh.file)
            unusable.add(mesh.name or name.stem)
            continue
        mesh.file = str(found.resolve())
    _delete_meshes(spec, unusable)
    _treat_massless_meshes_as_shells(spec)
    return missing


def _in_ros_package(path: Path, file: str) -> list[Path]:
    """Return the candidates of a ``package://`` file around a model."""
    if not file.startswith(PACKAGE):
        return []
    package, _, rest = file.removeprefix(PACKAGE).partition("/")
    return [
        candidate
        for folder in path.resolve().parents
        for candidate in (folder / package / rest, folder / rest)
    ]


def _treat_massless_meshes_as_shells(spec: mujoco.MjSpec) -> None:
    """Treat massless meshes as shells: MuJoCo refuses flat or open solids."""
    weighed = {
        geom.meshname
        for body in spec.bodies
        if not body.explicitinertial
        for geom in body.geoms
    }
    for mesh in spec.meshes:
        if (mesh.name or Path(mesh.file).stem) not in weighed:
            mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL


def _is_readable(file: Path) -> bool:
    """Return whether MuJoCo reads a file; STL only if it is binary."""
    if file.suffix.lower() not in SUFFIXES:
        return False
    if file.suffix.lower() != ".stl":
        return True
    with file.open("rb") as stream:
        head = stream.read(84)
    faces = int.from_bytes(head[80:84], "little")
    return file.stat().st_size == 84 + 50 * faces


def _delete_meshes(spec: mujoco.MjSpec, names: set[str]) -> None:
    """Delete meshes and the geoms that show them."""
    if not names:
        return
    for geom in list(spec.geoms):
        if geom.meshname in names:
            spec.delete(geom)
    for mesh in list(spec.meshes):
        if (mesh.name or Path(mesh.file).stem) in names:
            spec.delete(mesh)
