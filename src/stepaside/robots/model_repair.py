"""Repair of a published model: mesh files and impossible inertias."""

from pathlib import Path

import mujoco
import numpy as np

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


LEAST_MASS = 1e-6  # of a link, in [kg]
LEAST_RATIO = 1e-3  # of the least to the greatest moment of inertia
LEAST_GYRATION = 1e-4  # smaller radii of gyration are replaced, in [m]
DEFAULT_RADIUS = 0.02  # of the ball that replaces them, in [m]
NEGLIGIBLE_MASS = 1e-4  # links below have no effect, in [kg]
# Radius of gyration beyond which units must be wrong, by the length of the
# longest chain of the robot.
GREATEST_GYRATION = 2.0
TYPICAL_GYRATION = 0.4  # radius of gyration of a link by its length


def repair_inertias(spec: mujoco.MjSpec) -> list[str]:
    """Give every link a valid mass and inertia; return the repaired ones.

    Links without mass get a millionth of a kilogram. Inertias that are not
    positive definite keep their axes and get positive moments. If the radius
    of gyration of a link exceeds the size of the robot, units are wrong, and
    all inertias that are too large become typical ones for their links.
    """
    spec.compiler.boundmass = LEAST_MASS
    spec.compiler.boundinertia = LEAST_MASS * DEFAULT_RADIUS**2
    spec.compiler.balanceinertia = True
    repaired = _shrink_inertias(spec)
    for body in spec.bodies:
        full = np.array(body.fullinertia)
        if not body.explicitinertial or np.isnan(full).any():
            continue
        moments, axes = np.linalg.eigh(_matrix(full))
        mass = max(float(body.mass), LEAST_MASS)
        if moments[0] > mass * LEAST_GYRATION**2:
            continue
        least = LEAST_RATIO * float(moments[2])
        if moments[2] <= mass * LEAST_GYRATION**2:
            least = 0.4 * mass * DEFAULT_RADIUS**2
        inertia = axes @ np.diag(np.maximum(moments, least)) @ axes.T
        body.fullinertia[:] = inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
        repaired.append(body.name)
    return repaired


def _shrink_inertias(spec: mujoco.MjSpec) -> list[str]:
    """Shrink too large inertias of a model whose units must be wrong."""
    lengths = _link_lengths(spec)
    gyrations = {
        body.name: _radius_of_gyration(body)
        for body in spec.bodies
        if body.explicitinertial and body.mass > NEGLIGIBLE_MASS
    }
    longest = max(
        (_chain_length(body) for body in spec.worldbody.bodies), default=0.0
    )
    if max(gyrations.values(), default=0.0) <= GREATEST_GYRATION * longest:
        return []
    shrunk = []
    for body in spec.bodies:
        length = lengths.get(body.name, 0.0)
        if gyrations.get(body.name, 0.0) > length > 0.0:
            moment = float(body.mass) * (TYPICAL_GYRATION * length) ** 2
            if np.isnan(body.fullinertia).any():
                body.inertia[:] = moment
            else:
                body.fullinertia[:] = (moment,) * 3 + (0.0,) * 3
            shrunk.append(body.name)
    return shrunk


def _radius_of_gyration(body: mujoco.MjsBody) -> float:
    """Return the greatest radius of gyration of a link, in [m]."""
    full = np.array(body.fullinertia)
    moments = np.array(body.inertia)
    if not np.isnan(full).any():
        moments = np.linalg.eigvalsh(_matrix(full))
    return float(np.sqrt(max(float(moments.max()), 0.0) / body.mass))


def _link_lengths(spec: mujoco.MjSpec) -> dict[str, float]:
    """Return the distance [m] of each link to its farthest child."""
    found: dict[str, float] = {}
    for body in spec.bodies:  # parents come before their children
        below = [float(np.linalg.norm(child.pos)) for child in body.bodies]
        last = found.get(body.parent.name, 0.0) if body.parent else 0.0
        found[body.name] = max(below, default=0.0) or last
    return found


def _chain_length(body: mujoco.MjsBody) -> float:
    """Return the length of the longest chain below a body, in [m]."""
    return max(
        (
            float(np.linalg.norm(child.pos)) + _chain_length(child)
            for child in body.bodies
        ),
        default=0.0,
    )


def _matrix(full: np.ndarray) -> np.ndarray:
    """Return the inertia matrix of (xx, yy, zz, xy, xz, yz). Shape (3, 3)."""
    xx, yy, zz, xy, xz, yz = full.tolist()
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
