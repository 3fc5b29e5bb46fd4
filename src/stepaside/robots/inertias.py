"""Inertias that no body has, as published models carry them."""

import mujoco
import numpy as np

SMALL = 1e-6  # least mass of a link, in [kg]
THIN = 1e-3  # least moment of inertia by the greatest one
POINT = 1e-4  # a link of which all is nearer to its CoM is none, in [m]
ROUND = 0.02  # radius of the ball that it is taken for, in [m]


def mend_inertias(spec: mujoco.MjSpec) -> list[str]:
    """Let every link of a model have a mass and an inertia that can be.

    Links without mass get a millionth of a kilogram, and those whose
    inertia is no body's one with the same axes whose moments are positive;
    a model with any of them would not compile.

    Args:
        spec: The model; it is changed.

    Returns:
        Names of the links whose inertia was none.
    """
    spec.compiler.boundmass = SMALL
    spec.compiler.boundinertia = SMALL * ROUND**2
    spec.compiler.balanceinertia = True
    mended = []
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


def _matrix(full: np.ndarray) -> np.ndarray:
    """Inertia from its six numbers xx, yy, zz, xy, xz, yz. Shape (3, 3)."""
    xx, yy, zz, xy, xz, yz = full.tolist()
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
