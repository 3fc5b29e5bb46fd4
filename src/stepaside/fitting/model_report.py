"""Report on a derived description, for ``robot init``."""

from typing import Any

import numpy as np

from .derivation import DerivedDescription
from .leg_detection import ALIGNED, JOINT_TYPES
from .model_analysis import ModelAnalysis
from .motor_data import followers_of

GREATEST_HEAD = 0.2  # mass of a head, by that of the robot
MIDDLE = 0.05  # distance from the sagittal plane, by the length of a leg


def head_of(analysis: ModelAnalysis) -> dict[str, Any]:
    """Return the joints of the head and the cameras of a model.

    The head joints are those over the hips in the sagittal plane with a
    vertical axis (yaw) and a lateral axis (pitch) that carry the least mass.

    Joints ``yaw`` and ``pitch``, each None if there is none, and the names of
    all ``cameras`` of the model.
    """
    model, data = analysis.model, analysis.data
    hips = max(leg.hip[2] for leg in analysis.legs)
    carried = model.body_subtreemass[model.jnt_bodyid]
    fits = (
        np.isin(model.jnt_type, JOINT_TYPES)
        & (data.xanchor[:, 2] > hips)
        & (np.abs(data.xanchor[:, 1]) < MIDDLE * analysis.length)
        & (carried < GREATEST_HEAD * analysis.mass)
    )
    found: dict[str, Any] = {}
    for name, axis in (("yaw", 2), ("pitch", 1)):
        joints = np.flatnonzero(fits & (np.abs(data.xaxis[:, axis]) > ALIGNED))
        found[name] = None
        if len(joints):
            lightest = int(joints[carried[joints].argmin()])
            found[name] = model.joint(lightest).name
    cameras = [model.camera(i).name for i in range(model.ncam)]
    return found | {"cameras": cameras}


def report_of(derived: DerivedDescription) -> dict[str, Any]:
    """Return the report as values for JSON."""
    analysis, size = derived.analysis, derived.size
    own = derived.description
    return {
        "name": own.name,
        "model": str(analysis.path),
        "mass_kg": round(analysis.mass, 3),
        "leg_length_m": round(analysis.length, 4),
        "com_height_m": round(size.com_height, 4),
        "com_heights_m": [round(derived.lowest, 4), round(derived.highest, 4)],
        "foot_spacing_m": round(size.foot_spacing, 4),
        "hip_width_m": round(
            float(analysis.legs[0].hip[1] - analysis.legs[1].hip[1]), 4
        ),
        "sole_m": dict(own.sole),
        "legs": [list(leg.joints) for leg in analysis.legs],
        "gait": dict(own.gait),
        "lengths_share": round(derived.lengths, 3),
        "zmp_share": derived.zmp_offset,
        "lean_rad": own.lean,
        "torque_share": round(derived.loads.usual, 3),
        "game": dict(own.game),
        "coupled": sorted(followers_of(analysis.model)),
        "head": head_of(analysis),
        "omitted_meshes": len(analysis.missing),
        "missing_values": {
            "sole": any(leg.is_guessed for leg in analysis.legs),
            "torques": derived.assumed_torques,
            "speed_limits": derived.assumed_speeds,
        },
    }
