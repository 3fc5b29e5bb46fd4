"""Inertias that no body has, as published models carry them."""

import mujoco
import numpy as np

SMALL = 1e-6  # least mass of a link, in [kg]
THIN = 1e-3  # least moment of inertia by the greatest one
POINT = 1e-4  # a link of which all is nearer to its CoM is none, in [m]
ROUND = 0.02  # radius of the ball that it is taken for, in [m]
HEAVY = 1e-4  # a link with less mass turns nothing, in [kg]
VAST = 2.0  # by the longest chain of a robot: no link's mass is so far off
FILLED = 0.4  # of its length: radius of gyration of a link like others


def mend_inertias(spec: mujoco.MjSpec) -> list[str]:
    """Let every link of a model have a mass and an inertia that can be.

    Links without mass get a millionth of a kilogram, and those whose
    inertia is no body's one with the same axes whose moments are positive;
    a model with any of them would not compile. Where a link's inertia is one
    of masses far outside the robot, units are wrong, and all inertias that
    are too large for their links become those of links as long as they are.

    Args:
        spec: The model; it is changed.

    Returns:
        Names of the links whose inertia was none.
    """
    spec.compiler.boundmass = SMALL
    spec.compiler.boundinertia = SMALL * ROUND**2
    spec.compiler.balanceinertia = True
    mended = _shrink(spec)
    for body in spec.bodies:
        full = np.array(body.fullinertia)
        if not body.explicitinertial or np.isnan(full).any():
            continue
        moments, axes = np.linalg.eigh(_matrix(full))
        mass = max(float(body.mass), SMALL)
        if moments[0] > mass * POINT**2:
            continue
        least = THIN * float(moments[2])
        if moments[2] <= mass * POINT**2:
            least = 0.4 * mass * ROUND**2
        whole = axes @ np.diag(np.maximum(moments, least)) @ axes.T
        body.fullinertia[:] = whole[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
        mended.append(body.name)
    return mended


def _shrink(spec: mujoco.MjSpec) -> list[str]:
    """Shrink inertias that are too large, if some are so beyond doubt."""
    lengths = _lengths(spec)
    spreads = {
        body.name: _spread(body)
        for body in spec.bodies
        if body.explicitinertial and body.mass > HEAVY
    }
    whole = max((_reach(body) for body in spec.worldbody.bodies), default=0.0)
    if max(spreads.values(), default=0.0) <= VAST * whole:
        return []
    shrunk = []
    for body in spec.bodies:
        length = lengths.get(body.name, 0.0)
        if spreads.get(body.name, 0.0) > length > 0.0:
            moment = float(body.mass) * (FILLED * length) ** 2
            if np.isnan(body.fullinertia).any():
                body.inertia[:] = moment
            else:
                body.fullinertia[:] = (moment,) * 3 + (0.0,) * 3
            shrunk.append(body.name)
    return shrunk


def _spread(body: mujoco.MjsBody) -> float:
    """Radius of gyration of a link, in [m]."""
    full = np.array(body.fullinertia)
    moments = np.array(body.inertia)
    if not np.isnan(full).any():
        moments = np.linalg.eigvalsh(_matrix(full))
    return float(np.sqrt(max(float(moments.max()), 0.0) / body.mass))


def _lengths(spec: mujoco.MjSpec) -> dict[str, float]:
    """How far each link reaches to those that hang on it, in [m].

    A last link counts as long as the one that it hangs on.
    """
    found: dict[str, float] = {}
    for body in spec.bodies:  # parents come before their children
        below = [float(np.linalg.norm(child.pos)) for child in body.bodies]
        last = found.get(body.parent.name, 0.0) if body.parent else 0.0
        found[body.name] = max(below, default=0.0) or last
    return found


def _reach(body: mujoco.MjsBody) -> float:
    """Length of the longest chain that hangs on a body, in [m]."""
    return max(
        (float(np.linalg.norm(b.pos)) + _reach(b) for b in body.bodies),
        default=0.0,
    )


def _matrix(full: np.ndarray) -> np.ndarray:
    """Inertia from its six numbers xx, yy, zz, xy, xz, yz. Shape (3, 3)."""
    xx, yy, zz, xy, xz, yz = full.tolist()
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
