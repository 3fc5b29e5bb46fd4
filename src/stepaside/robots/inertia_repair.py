"""Repair of link inertias that are not physically possible."""

import mujoco
import numpy as np

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
