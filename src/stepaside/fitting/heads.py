"""Heads of published models: the joints that turn them, and their cameras."""

from typing import Any

import numpy as np

from .limbs import LEVEL, MOVES
from .survey import Survey

LIGHT = 0.2  # of the mass: whatever carries more is no head
MIDDLE = 0.05  # of a leg's length: from the plane between left and right


def head_of(found: Survey) -> dict[str, Any]:
    """What turns a head aside and nods it, and what looks out of it.

    The head is the lightest part over the hips that hangs on a joint with a
    vertical axis in the plane between left and right.

    Returns:
        Joints ``yaw`` and ``pitch``, each None where there is none, and the
        names of all ``cameras`` of the model.
    """
    model, data = found.model, found.data
    hips = max(leg.hip[2] for leg in found.legs)
    turning: dict[int, str] = {}
    for axis in (2, 1):
        joints = [
            j
            for j in range(model.njnt)
            if model.jnt_type[j] in MOVES
            and abs(data.xaxis[j, axis]) > LEVEL
            and data.xanchor[j, 2] > hips
            and abs(data.xanchor[j, 1]) < MIDDLE * found.length
            and _carries(found, j) < LIGHT * found.mass
        ]
        if joints:
            lightest = joints[
                int(np.argmin([_carries(found, j) for j in joints]))
            ]
            turning[axis] = model.joint(lightest).name
    return {
        "yaw": turning.get(2),
        "pitch": turning.get(1),
        "cameras": [model.camera(i).name for i in range(model.ncam)],
    }


def _carries(found: Survey, joint: int) -> float:
    """Mass that a joint carries, in [kg]."""
    body = int(found.model.jnt_bodyid[joint])
    return float(found.model.body_subtreemass[body])
