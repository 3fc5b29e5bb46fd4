"""What was found in a model and chosen for it, as a report tells it."""

from typing import Any

import numpy as np

from .derivation import DerivedDescription, coupled_of
from .leg_detection import LEVEL, MOVES
from .model_analysis import ModelAnalysis

LIGHT = 0.2  # of the mass: whatever carries more is no head
MIDDLE = 0.05  # of a leg's length: from the plane between left and right


def head_of(found: ModelAnalysis) -> dict[str, Any]:
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


def _carries(found: ModelAnalysis, joint: int) -> float:
    """Mass that a joint carries, in [kg]."""
    body = int(found.model.jnt_bodyid[joint])
    return float(found.model.body_subtreemass[body])


def facts_of(derived: DerivedDescription) -> dict[str, Any]:
    """What was found and chosen, for a report."""
    found, size = derived.survey, derived.size
    own = derived.description
    untold = [
        name for name in own.overlay.servos if name not in derived.told_torques
    ]
    unlimited = [
        name for name in own.speed_limits if name not in derived.told_speeds
    ]
    return {
        "name": own.name,
        "model": str(found.path),
        "mass_kg": round(found.mass, 3),
        "leg_length_m": round(found.length, 4),
        "com_height_m": round(size.com_height, 4),
        "com_heights_m": [round(derived.lowest, 4), round(derived.highest, 4)],
        "foot_spacing_m": round(size.foot_spacing, 4),
        "hip_width_m": round(
            float(found.legs[0].hip[1] - found.legs[1].hip[1]), 4
        ),
        "sole_m": dict(own.sole),
        "legs": [list(leg.joints) for leg in found.legs],
        "gait": dict(own.gait),
        "lengths_share": round(derived.share, 3),
        "zmp_share": derived.ahead,
        "lean_rad": own.lean,
        "torque_share": round(derived.borne.usual, 3),
        "game": dict(own.game),
        "coupled": sorted(coupled_of(found)),
        "head": head_of(found),
        "left_out_meshes": len(found.missing),
        "asked_for": {
            "sole": any(leg.is_guessed for leg in found.legs),
            "torques": untold,
            "speed_limits": unlimited,
        },
    }
